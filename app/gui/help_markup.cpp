#include "app/gui/help_markup.h"

#include <QRegularExpression>
#include <QStringList>

namespace atomesh::gui {

namespace {

QString inline_html(const QString& text) {
  // What stands in `code` is no markup: taken out first, put back last.
  QStringList codes;
  QString rest;
  static const QRegularExpression code(QStringLiteral("`([^`]+)`"));
  qsizetype at = 0;
  for (auto hits = code.globalMatch(text); hits.hasNext();) {
    const QRegularExpressionMatch hit = hits.next();
    rest += text.mid(at, hit.capturedStart() - at) + QChar(1);
    codes << hit.captured(1).toHtmlEscaped();
    at = hit.capturedEnd();
  }
  rest = (rest + text.mid(at)).toHtmlEscaped();
  static const QRegularExpression bold(QStringLiteral("\\*\\*([^*]+)\\*\\*"));
  static const QRegularExpression slanted(QStringLiteral("\\*([^*]+)\\*"));
  static const QRegularExpression link(QStringLiteral("\\[([^\\]]+)\\]\\(([^)]+)\\)"));
  rest.replace(bold, QStringLiteral("<b>\\1</b>"));
  rest.replace(slanted, QStringLiteral("<i>\\1</i>"));
  rest.replace(link, QStringLiteral("<a href=\"\\2\">\\1</a>"));
  for (const QString& word : codes) {
    rest.replace(rest.indexOf(QChar(1)), 1, QStringLiteral("<code>%1</code>").arg(word));
  }
  return rest;
}

QString inline_text(QString text) {
  static const QRegularExpression link(QStringLiteral("\\[([^\\]]+)\\]\\(([^)]+)\\)"));
  static const QRegularExpression marks(QStringLiteral("\\*\\*?([^*]+)\\*\\*?"));
  text.replace(link, QStringLiteral("\\1"));
  text.replace(marks, QStringLiteral("\\1"));
  return text.remove(QLatin1Char('`'));
}

class Reader {
 public:
  HelpMarkup read(const QString& markdown) {
    result_.sections.push_back({});
    for (const QString& line : markdown.split(QLatin1Char('\n'))) take(line);
    end_block();
    if (result_.sections.front().text.isEmpty()) result_.sections.erase(result_.sections.begin());
    return std::move(result_);
  }

 private:
  enum class Block { none, paragraph, list, table, code };

  void take(const QString& line) {
    static const QRegularExpression heading(QStringLiteral("^(#{1,3}) (.+)$"));
    static const QRegularExpression rule(QStringLiteral("^[|\\- ]+$"));
    const QString trimmed = line.trimmed();
    if (line.startsWith(QLatin1String("    ")) && (block_ == Block::none || block_ == Block::code)) {
      begin(Block::code);
      lines_ << line.mid(4);
    } else if (trimmed.isEmpty()) {
      end_block();
    } else if (const auto hit = heading.match(line); hit.hasMatch()) {
      end_block();
      const auto level = hit.capturedLength(1);
      const QString title = hit.captured(2);
      const QString anchor = anchor_of(title);
      result_.sections.push_back({anchor, title, {}});
      result_.html += QStringLiteral("<h%1><a name=\"%2\"></a>%3</h%1>\n").arg(level).arg(anchor, inline_html(title));
    } else if (trimmed.startsWith(QLatin1String("- "))) {
      begin(Block::list);
      lines_ << trimmed.mid(2);
    } else if (trimmed.startsWith(QLatin1Char('|'))) {
      begin(Block::table);
      if (!rule.match(trimmed).hasMatch()) lines_ << trimmed.mid(1, trimmed.size() - 2);
    } else if (block_ == Block::list && line.startsWith(QLatin1String("  "))) {
      lines_.last() += QLatin1Char(' ') + trimmed;
    } else {
      begin(Block::paragraph);
      lines_ << trimmed;
    }
  }

  void begin(Block block) {
    if (block == block_) return;
    end_block();
    block_ = block;
  }

  void end_block() {
    QString& html = result_.html;
    QString& text = result_.sections.back().text;
    switch (block_) {
      case Block::none:
        break;
      case Block::paragraph:
        html += QStringLiteral("<p>%1</p>\n").arg(inline_html(lines_.join(QLatin1Char(' '))));
        break;
      case Block::list:
        html += QStringLiteral("<ul>");
        for (const QString& line : lines_) html += QStringLiteral("<li>%1</li>").arg(inline_html(line));
        html += QStringLiteral("</ul>\n");
        break;
      case Block::table:
        html += QStringLiteral(
            "<table border=\"1\" cellspacing=\"0\" cellpadding=\"4\" style=\"border-collapse: collapse\">");
        for (qsizetype row = 0; row < lines_.size(); ++row) {
          const char* const tag = row == 0 ? "th" : "td";
          html += QStringLiteral("<tr>");
          for (const QString& cell : lines_[row].split(QLatin1Char('|'))) {
            html += QStringLiteral("<%1 align=\"left\">%2</%1>").arg(QLatin1String(tag), inline_html(cell.trimmed()));
          }
          html += QStringLiteral("</tr>");
        }
        html += QStringLiteral("</table>\n");
        break;
      case Block::code:
        html += QStringLiteral("<pre>%1</pre>\n").arg(lines_.join(QLatin1Char('\n')).toHtmlEscaped());
        break;
    }
    for (const QString& line : lines_) {
      if (!text.isEmpty()) text += QLatin1Char(' ');
      text += block_ == Block::code ? line : inline_text(line).replace(QLatin1Char('|'), QLatin1Char(' ')).simplified();
    }
    lines_.clear();
    block_ = Block::none;
  }

  HelpMarkup result_;
  Block block_ = Block::none;
  QStringList lines_;
};

}  // namespace

QString anchor_of(const QString& heading) {
  static const QRegularExpression others(QStringLiteral("[^a-z0-9.]+"));
  QString anchor = heading.toLower().replace(others, QStringLiteral("-"));
  while (anchor.startsWith(QLatin1Char('-'))) anchor.remove(0, 1);
  while (anchor.endsWith(QLatin1Char('-'))) anchor.chop(1);
  return anchor;
}

HelpMarkup read_markup(const QString& markdown) {
  return Reader().read(markdown);
}

}  // namespace atomesh::gui
