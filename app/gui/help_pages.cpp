#include "app/gui/help_pages.h"

#include <QFile>
#include <QRegularExpression>
#include <QStringList>
#include <algorithm>
#include <stdexcept>

#include "app/gui/parameter_hints.h"
#include "core/error.h"
#include "core/parameters.h"

namespace atomesh::gui {

namespace {

// A page: its file in help/, and the groups of the parameter table whose entries stand below.
struct Source {
  const char* id;
  std::vector<std::string> groups;
};

const std::vector<Source>& sources() {
  static const std::vector<Source> list{{"start", {}},
                                        {"files", {}},
                                        {"preprocessing", {}},
                                        {"controls", {}},
                                        {"volume-surface", {"Volume and surface"}},
                                        {"volume", {"Volume"}},
                                        {"surface", {"Surface"}},
                                        {"xray", {"X-ray"}},
                                        {"atoms", {"Atom balls"}},
                                        {"display", {"Display", "View", "Quality"}},
                                        {"cut-planes", {"Cut planes", "Lights"}},
                                        {"defects", {}},
                                        {"color-map", {}},
                                        {"parameters", {}},
                                        {"pictures", {}}};
  return list;
}

// "light.3.color" and its like have one entry for all eight.
QString entry_key(const std::string& key) {
  static const QRegularExpression numbered(QStringLiteral("^(light|cut_plane)\\.[1-8]\\."));
  QString name = QString::fromStdString(parameter_row(key).key);
  return name.replace(numbered, QStringLiteral("\\1.N."));
}

// A key as a place in a page: without what addresses write otherwise.
QString entry_anchor(QString key) {
  return key.replace(QLatin1String("<species>"), QLatin1String("SPECIES"));
}

// The value that all eight have, or the first's and the others'.
QString default_of(const ParameterRow& row, const QString& entry) {
  if (!entry.contains(QLatin1String(".N."))) return QString::fromStdString(default_text(row.key));
  QStringList values;
  for (int n = 1; n <= max_lights; ++n) {
    QString key = entry;
    values << QString::fromStdString(
        default_text(key.replace(QLatin1String(".N."), QStringLiteral(".%1.").arg(n)).toStdString()));
  }
  const QString rest = values.last();
  QStringList own;
  for (int n = 0; n < values.size(); ++n) {
    if (values[n] != rest) own << QStringLiteral("%1 (number %2)").arg(values[n]).arg(n + 1);
  }
  own << (own.isEmpty() ? rest : rest + QStringLiteral(" (the others)"));
  return own.join(QStringLiteral(", "));
}

void add_entries(HelpPage& page, const std::string& group) {
  const QString heading = QStringLiteral("Parameters: %1").arg(QString::fromStdString(group));
  page.html += QStringLiteral("<h2><a name=\"%1\"></a>%2</h2>\n").arg(anchor_of(heading), heading.toHtmlEscaped());
  page.sections.push_back({anchor_of(heading), heading, {}});
  QStringList done;
  for (const ParameterRow& row : parameter_table()) {
    const QString key = entry_key(row.key);
    if (row.group != group || done.contains(key)) continue;
    done << key;
    QString label = QString::fromStdString(row.label);
    if (key != QString::fromStdString(row.key)) label.replace(QLatin1Char('1'), QLatin1Char('N'));
    const QString help = QString::fromStdString(row.help);
    const QString accepted = QString::fromStdString(expected_value(row));
    const QString usual = default_of(row, key);
    const auto html = [](const QString& text) { return text.toHtmlEscaped(); };
    page.html += QStringLiteral(
                     "<h3><a name=\"%1\"></a>%2</h3>\n<p>%3</p>\n<p>Value: %4. Default: <code>%5</code>. "
                     "Key: <code>%6</code></p>\n")
                     .arg(entry_anchor(key), html(label), html(help), html(accepted), html(usual), html(key));
    page.sections.push_back(
        {entry_anchor(key), label, QStringList{help, accepted, usual, key}.join(QStringLiteral(" · "))});
  }
}

HelpPage read_page(const Source& source) {
  HelpPage page;
  page.id = QLatin1String(source.id);
  QFile file(QStringLiteral(":/help/%1.md").arg(page.id));
  if (!file.open(QIODevice::ReadOnly)) throw std::logic_error("no help page " + page.id.toStdString());
  HelpMarkup markup = read_markup(QString::fromUtf8(file.readAll()));
  page.html = std::move(markup.html);
  page.sections = std::move(markup.sections);
  page.title = page.sections.front().title;
  for (const std::string& group : source.groups) add_entries(page, group);
  return page;
}

const HelpPage* page_of(const QString& id) {
  for (const HelpPage& page : help_pages()) {
    if (page.id == id) return &page;
  }
  return nullptr;
}

const HelpPage* page_of_group(const std::string& group) {
  for (const Source& source : sources()) {
    if (std::find(source.groups.begin(), source.groups.end(), group) != source.groups.end()) {
      return page_of(QLatin1String(source.id));
    }
  }
  return nullptr;
}

// What a word counts in a text: nothing where it is not in it, more at the beginning of a word, most as a whole one.
int score_of(const QString& text, const QString& word) {
  int best = 0;
  for (qsizetype at = text.indexOf(word, 0, Qt::CaseInsensitive); at >= 0;
       at = text.indexOf(word, at + 1, Qt::CaseInsensitive)) {
    const bool begins = at == 0 || !text[at - 1].isLetterOrNumber();
    const qsizetype end = at + word.size();
    const bool ends = end == text.size() || !text[end].isLetterOrNumber();
    best = std::max(best, begins && ends ? 3 : begins ? 2 : 1);
  }
  return best;
}

QString excerpt_of(const QString& text, const QString& word) {
  constexpr qsizetype before = 40;
  constexpr qsizetype length = 140;
  const qsizetype at = std::max<qsizetype>(0, text.indexOf(word, 0, Qt::CaseInsensitive));
  qsizetype from = at <= before ? 0 : text.indexOf(QLatin1Char(' '), at - before) + 1;
  if (from > at) from = at;
  QString excerpt = text.mid(from, length);
  if (from > 0) excerpt.prepend(QStringLiteral("… "));
  if (from + length < text.size()) excerpt += QStringLiteral(" …");
  return excerpt;
}

}  // namespace

const std::vector<HelpPage>& help_pages() {
  static const std::vector<HelpPage> pages = [] {
    std::vector<HelpPage> list;
    for (const Source& source : sources()) list.push_back(read_page(source));
    return list;
  }();
  return pages;
}

std::optional<HelpPlace> help_place(const QString& topic) {
  const qsizetype hash = topic.indexOf(QLatin1Char('#'));
  if (const HelpPage* page = page_of(topic.left(hash))) {
    return HelpPlace{page, hash < 0 ? QString() : topic.mid(hash + 1)};
  }
  if (const HelpPage* page = page_of_group(topic.toStdString())) {
    // A mode's page begins with what the mode is; of the others the group's own heading is wanted.
    const bool mode = mode_of_group(topic.toStdString()).has_value();
    return HelpPlace{page, mode ? QString() : anchor_of(QStringLiteral("Parameters: ") + topic)};
  }
  try {
    const std::string key = topic.toStdString();
    return HelpPlace{page_of_group(parameter_row(key).group), entry_anchor(entry_key(key))};
  } catch (const UsageError&) {
    return {};
  }
}

std::vector<HelpHit> search_help(const QString& query) {
  const QStringList words = query.simplified().split(QLatin1Char(' '), Qt::SkipEmptyParts);
  if (words.isEmpty()) return {};
  struct Scored {
    HelpHit hit;
    int score;
  };
  std::vector<Scored> hits;
  const auto key_place = words.size() == 1 ? help_place(words.front()) : std::nullopt;
  for (const HelpPage& page : help_pages()) {
    for (const HelpSection& section : page.sections) {
      int score = 0;
      bool all = true;
      for (const QString& word : words) {
        const int in_page = score_of(page.title, word);
        const int here = 8 * score_of(section.title, word) + score_of(section.text, word);
        // A word of the page's title may stand for all its sections, but some word must be in the section itself.
        all = all && (here > 0 || in_page > 0);
        score += here > 0 ? here + 2 * in_page : 0;
      }
      const bool by_key =
          key_place && key_place->page == &page && !key_place->anchor.isEmpty() && key_place->anchor == section.anchor;
      if (by_key) score += 1000;
      if (!by_key && (!all || score == 0)) continue;
      hits.push_back({{&page, &section, excerpt_of(section.text, words.front())}, score});
    }
  }
  std::stable_sort(hits.begin(), hits.end(), [](const Scored& a, const Scored& b) { return a.score > b.score; });
  std::vector<HelpHit> found;
  for (Scored& scored : hits) found.push_back(std::move(scored.hit));
  return found;
}

}  // namespace atomesh::gui
