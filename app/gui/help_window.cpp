#include "app/gui/help_window.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QShortcut>
#include <QSignalBlocker>
#include <QSplitter>
#include <QStackedWidget>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>
#include <QUrl>
#include <QVBoxLayout>

#include "app/gui/help_pages.h"

namespace atomesh::gui {

namespace {

constexpr int address_role = Qt::UserRole;

QUrl address_of(const HelpPage& page, const QString& anchor) {
  QUrl url(QStringLiteral("help:") + page.id);
  if (!anchor.isEmpty()) url.setFragment(anchor);
  return url;
}

}  // namespace

// Pages by their address, help:controls.
class HelpBrowser : public QTextBrowser {
 public:
  explicit HelpBrowser(QWidget* parent) : QTextBrowser(parent) {
    setObjectName(QStringLiteral("help_browser"));
    setOpenExternalLinks(false);
    set_style();
  }

 protected:
  QVariant loadResource(int type, const QUrl& name) override {
    if (type != QTextDocument::HtmlResource || name.scheme() != QLatin1String("help")) return {};
    const auto place = help_place(name.path());
    return place ? place->page->html : tr("<h1>There is no such page</h1>");
  }

  void changeEvent(QEvent* event) override {
    QTextBrowser::changeEvent(event);
    if (event->type() != QEvent::PaletteChange || !source().isValid()) return;
    set_style();
    reload();
  }

 private:
  void set_style() {
    const QString faint = palette().color(QPalette::AlternateBase).name();
    document()->setDefaultStyleSheet(
        QStringLiteral("code, pre { background-color: %1; }"
                       "h1 { margin-top: 12px; } h2 { margin-top: 18px; }"
                       "h3 { margin-top: 14px; margin-bottom: 2px; }"
                       "p { margin-top: 4px; margin-bottom: 8px; }"
                       "a { color: %2; } table { border-style: solid; border-color: %3; }")
            .arg(faint, palette().color(QPalette::Link).name(), palette().color(QPalette::Mid).name()));
  }
};

HelpWindow::HelpWindow(QWidget* parent)
    : QWidget(parent, Qt::Window),
      search_(new QLineEdit(this)),
      contents_or_hits_(new QStackedWidget(this)),
      contents_(new QTreeWidget(this)),
      hits_(new QListWidget(this)),
      nothing_(new QLabel(this)),
      browser_(new HelpBrowser(this)) {
  setObjectName(QStringLiteral("help_window"));
  setWindowTitle(tr("Help – atomesh"));
  search_->setObjectName(QStringLiteral("help_search"));
  search_->setPlaceholderText(tr("Search the help"));
  search_->setAccessibleName(search_->placeholderText());
  search_->setClearButtonEnabled(true);
  contents_->setObjectName(QStringLiteral("help_contents"));
  contents_->setHeaderHidden(true);
  hits_->setObjectName(QStringLiteral("help_hits"));
  hits_->setWordWrap(true);
  hits_->setAlternatingRowColors(true);
  hits_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  nothing_->setObjectName(QStringLiteral("help_nothing"));
  nothing_->setWordWrap(true);
  nothing_->setAlignment(Qt::AlignTop);
  nothing_->setTextFormat(Qt::PlainText);
  contents_or_hits_->addWidget(contents_);
  contents_or_hits_->addWidget(hits_);
  contents_or_hits_->addWidget(nothing_);

  auto* left = new QWidget(this);
  auto* left_lines = new QVBoxLayout(left);
  left_lines->setContentsMargins(0, 0, 0, 0);
  left_lines->addWidget(search_);
  left_lines->addWidget(contents_or_hits_, 1);

  auto* right = new QWidget(this);
  auto* right_lines = new QVBoxLayout(right);
  right_lines->setContentsMargins(0, 0, 0, 0);
  auto* buttons = new QHBoxLayout;
  const auto add = [&](const QString& text, const QString& tip, const char* name, const QKeySequence& key) {
    auto* button = new QToolButton(right);
    button->setObjectName(QLatin1String(name));
    button->setText(text);
    button->setToolTip(tip + QStringLiteral(" (%1)").arg(key.toString(QKeySequence::NativeText)));
    button->setAccessibleName(tip);
    button->setAutoRaise(true);
    button->setShortcut(key);
    buttons->addWidget(button);
    return button;
  };
  QToolButton* back = add(QStringLiteral("←"), tr("Back"), "help_back", QKeySequence(Qt::ALT | Qt::Key_Left));
  QToolButton* forward = add(QStringLiteral("→"), tr("Forward"), "help_forward", QKeySequence(Qt::ALT | Qt::Key_Right));
  QToolButton* home = add(tr("Contents"), tr("The first page"), "help_home", QKeySequence(Qt::ALT | Qt::Key_Home));
  buttons->addStretch();
  back->setEnabled(false);
  forward->setEnabled(false);
  right_lines->addLayout(buttons);
  right_lines->addWidget(browser_, 1);

  auto* splitter = new QSplitter(this);
  splitter->addWidget(left);
  splitter->addWidget(right);
  splitter->setStretchFactor(1, 1);
  const int letter = fontMetrics().averageCharWidth();
  splitter->setSizes({letter * 44, letter * 100});
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(splitter);
  resize(letter * 148, fontMetrics().height() * 40);

  connect(back, &QToolButton::clicked, browser_, &QTextBrowser::backward);
  connect(forward, &QToolButton::clicked, browser_, &QTextBrowser::forward);
  connect(home, &QToolButton::clicked, this, [this] { show_topic(); });
  connect(browser_, &QTextBrowser::backwardAvailable, back, &QWidget::setEnabled);
  connect(browser_, &QTextBrowser::forwardAvailable, forward, &QWidget::setEnabled);
  connect(browser_, &QTextBrowser::sourceChanged, this, &HelpWindow::follow_page);
  connect(search_, &QLineEdit::textChanged, this, &HelpWindow::fill_hits);
  connect(search_, &QLineEdit::returnPressed, this, [this] {
    if (hits_->count() == 0) return;
    hits_->setCurrentRow(0);
    hits_->setFocus();
  });
  connect(hits_, &QListWidget::currentItemChanged, this, [this](const QListWidgetItem* item) {
    if (item != nullptr) browser_->setSource(item->data(address_role).toUrl());
  });
  connect(contents_, &QTreeWidget::currentItemChanged, this, [this](const QTreeWidgetItem* item) {
    if (item != nullptr) browser_->setSource(item->data(0, address_role).toUrl());
  });
  connect(new QShortcut(QKeySequence::Find, this), &QShortcut::activated, this, [this] {
    search_->setFocus();
    search_->selectAll();
  });
  fill_contents();
  browser_->setSource(address_of(help_pages().front(), {}));
}

void HelpWindow::fill_contents() {
  for (const HelpPage& page : help_pages()) {
    auto* item = new QTreeWidgetItem(contents_, {page.title});
    item->setData(0, address_role, address_of(page, {}));
    for (std::size_t i = 1; i < page.sections.size(); ++i) {
      const HelpSection& section = page.sections[i];
      auto* below = new QTreeWidgetItem(item, {section.title});
      below->setData(0, address_role, address_of(page, section.anchor));
    }
  }
}

void HelpWindow::fill_hits(const QString& query) {
  hits_->clear();
  if (query.trimmed().isEmpty()) {
    contents_or_hits_->setCurrentWidget(contents_);
    return;
  }
  for (const HelpHit& hit : search_help(query)) {
    const QString place = hit.section->title == hit.page->title
                              ? hit.page->title
                              : QStringLiteral("%1 › %2").arg(hit.page->title, hit.section->title);
    auto* item = new QListWidgetItem(place + QLatin1Char('\n') + hit.excerpt, hits_);
    item->setData(address_role, address_of(*hit.page, hit.section->anchor));
  }
  nothing_->setText(tr("Nothing has “%1”. Fewer or other words may find it.").arg(query.simplified()));
  contents_or_hits_->setCurrentWidget(hits_->count() > 0 ? static_cast<QWidget*>(hits_) : nothing_);
}

void HelpWindow::show_topic(const QString& topic) {
  const auto place = help_place(topic);
  browser_->setSource(place ? address_of(*place->page, place->anchor) : address_of(help_pages().front(), {}));
  show();
  raise();
  activateWindow();
}

void HelpWindow::search(const QString& query) {
  search_->setText(query);
}

QString HelpWindow::page() const {
  return browser_->source().path();
}

void HelpWindow::follow_page(const QUrl& address) {
  const QString shown = address.path();
  const QSignalBlocker blocker(contents_);
  for (int i = 0; i < contents_->topLevelItemCount(); ++i) {
    QTreeWidgetItem* item = contents_->topLevelItem(i);
    if (item->data(0, address_role).toUrl().path() != shown) continue;
    const QTreeWidgetItem* current = contents_->currentItem();
    if (current == item || (current != nullptr && current->parent() == item)) return;
    contents_->setCurrentItem(item);
    contents_->scrollToItem(item);
  }
}

void HelpWindow::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) {
    if (search_->text().isEmpty()) {
      close();
    } else {
      search_->clear();
    }
    return;
  }
  QWidget::keyPressEvent(event);
}

}  // namespace atomesh::gui
