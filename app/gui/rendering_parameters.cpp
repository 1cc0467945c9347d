#include "app/gui/rendering_parameters.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QScrollArea>
#include <QStackedWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/gui/parameter_files.h"
#include "app/gui/parameter_form.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/species_table.h"
#include "app/gui/theme.h"
#include "app/gui/wheel_guard.h"
#include "app/gui/workspace.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr std::array modes{Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};
// Rows of a search; more are read faster with another word.
constexpr std::size_t most_found = 30;

QScrollArea* scrolled(QWidget* content) {
  auto* scroll = new QScrollArea;
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  return scroll;
}

}  // namespace

RenderingParameters::RenderingParameters(Workspace& workspace, QWidget* parent)
    : QWidget(parent), workspace_(workspace), view_mode_(workspace.parameters().mode) {
  setObjectName(QStringLiteral("rendering_parameters"));
  auto* layout = new QVBoxLayout(this);
  search_ = new QLineEdit(this);
  search_->setObjectName(QStringLiteral("parameter_search"));
  search_->setPlaceholderText(tr("Search all parameters"));
  search_->setToolTip(tr("Words of a parameter's name, key or help; what fits can be changed right there."));
  search_->setAccessibleName(search_->placeholderText());
  search_->setClearButtonEnabled(true);
  layout->addWidget(search_);
  search_or_pages_ = new QStackedWidget(this);
  search_or_pages_->addWidget(make_pages());
  search_or_pages_->addWidget(make_search_page());
  layout->addWidget(search_or_pages_, 1);
  layout->addWidget(make_file_box());
  connect(search_, &QLineEdit::textChanged, this, &RenderingParameters::search);
  connect(&workspace_, &Workspace::parameters_changed, this, &RenderingParameters::follow_mode);
  connect(&workspace_, &Workspace::apply_changed, this, &RenderingParameters::follow_apply);
  show_page(view_mode_);
  follow_apply();
}

QWidget* RenderingParameters::make_pages() {
  auto* all = new QWidget(this);
  auto* layout = new QVBoxLayout(all);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* line = new QHBoxLayout;
  mode_ = new QComboBox(all);
  mode_->setObjectName(QStringLiteral("mode_page"));
  mode_->setToolTip(tr("The mode whose parameters are below; the view stays in its own."));
  mode_->setAccessibleName(tr("Parameters of mode"));
  guard_wheel(mode_);
  pages_ = new QStackedWidget(all);
  for (const Mode mode : modes) {
    mode_->addItem(QString::fromStdString(group_of_mode(mode)));
    pages_->addWidget(make_page(mode));
  }
  line->addWidget(mode_, 1);
  const auto add = [&](const QString& text, const QString& tip, const char* name) {
    auto* button = new QToolButton(all);
    button->setObjectName(QLatin1String(name));
    button->setText(text);
    button->setToolTip(tip);
    button->setAccessibleName(tip);
    button->setAutoRaise(true);
    line->addWidget(button);
    return button;
  };
  connect(add(QStringLiteral("↺"), tr("This mode's parameters back to the defaults"), "reset_page"),
          &QToolButton::clicked, this, &RenderingParameters::reset_page);
  connect(add(QStringLiteral("?"), tr("Help on this mode"), "help_page"), &QToolButton::clicked, this,
          [this] { emit help_requested(QString::fromStdString(group_of_mode(page()))); });
  layout->addLayout(line);

  not_shown_ = new QLabel(all);
  not_shown_->setObjectName(QStringLiteral("not_shown"));
  not_shown_->setWordWrap(true);
  not_shown_->setTextFormat(Qt::RichText);
  layout->addWidget(not_shown_);
  connect(not_shown_, &QLabel::linkActivated, this, [this] { workspace_.set("mode", std::string(mode_name(page()))); });
  layout->addWidget(pages_, 1);
  connect(mode_, &QComboBox::currentIndexChanged, this,
          [this](int index) { show_page(modes.at(static_cast<std::size_t>(index))); });
  return all;
}

ParameterForm* RenderingParameters::make_form(QWidget* parent) {
  auto* form = new ParameterForm(workspace_, parent);
  connect(form, &ParameterForm::edit_color_map_requested, this, &RenderingParameters::edit_color_map_requested);
  connect(form, &ParameterForm::help_requested, this, &RenderingParameters::help_requested);
  return form;
}

QWidget* RenderingParameters::make_page(Mode mode) {
  const QString name = QString::fromUtf8(mode_name(mode).data());
  auto* page = new QWidget(this);
  page->setObjectName(QStringLiteral("page_") + name);
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* content = new QWidget(page);
  auto* lines = new QVBoxLayout(content);
  lines->setContentsMargins(0, 0, 0, 0);
  ParameterForm* form = make_form(content);
  form->set_keys(keys_of_group(group_of_mode(mode)));
  lines->addWidget(form);
  if (mode == Mode::atoms) {
    auto* table = new SpeciesTable(workspace_, content);
    connect(table, &SpeciesTable::help_requested, this, &RenderingParameters::help_requested);
    lines->addWidget(table);
  }
  if (mode == Mode::volume) {
    auto* histogram = new QPushButton(tr("Create Scalar &Histogram…"), content);
    histogram->setObjectName(QStringLiteral("create_histogram"));
    histogram->setToolTip(tr("Writes histogram.csv: how many atoms have which scalar"));
    lines->addWidget(histogram);
    connect(histogram, &QPushButton::clicked, this, &RenderingParameters::create_histogram_requested);
  }
  lines->addStretch();
  layout->addWidget(scrolled(content), 1);

  Page& parts = page_[static_cast<std::size_t>(mode)];
  auto* line = new QHBoxLayout;
  parts.auto_apply = new QCheckBox(tr("&Auto apply"), page);
  parts.auto_apply->setObjectName(QStringLiteral("auto_apply_") + name);
  parts.auto_apply->setToolTip(
      tr("Draws with new values at once. Off: the picture stays until Apply, which saves time with large samples."));
  parts.apply = new QPushButton(tr("App&ly"), page);
  parts.apply->setObjectName(QStringLiteral("apply_") + name);
  parts.apply->setToolTip(tr("Draws with the values above"));
  line->addWidget(parts.auto_apply);
  line->addStretch();
  line->addWidget(parts.apply);
  layout->addLayout(line);
  connect(parts.auto_apply, &QCheckBox::clicked, this, [this, mode](bool on) { workspace_.set_auto_apply(mode, on); });
  connect(parts.apply, &QPushButton::clicked, this, [this, mode] { workspace_.apply(mode); });
  return page;
}

QWidget* RenderingParameters::make_search_page() {
  auto* content = new QWidget(this);
  content->setObjectName(QStringLiteral("search_page"));
  auto* layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  found_text_ = new QLabel(content);
  found_text_->setObjectName(QStringLiteral("search_text"));
  found_text_->setWordWrap(true);
  layout->addWidget(found_text_);
  found_ = make_form(content);
  layout->addWidget(found_);
  layout->addStretch();
  return scrolled(content);
}

QWidget* RenderingParameters::make_file_box() {
  auto* box = new QWidget(this);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* line = new QHBoxLayout;
  auto* label = new QLabel(tr("Parameter &file"), box);
  file_ = new QLineEdit(QStringLiteral("default"), box);
  file_->setObjectName(QStringLiteral("parameter_file"));
  file_->setToolTip(tr("“default” is the name of the data set with .crf; a name without folder lies beside it."));
  label->setBuddy(file_);
  line->addWidget(label);
  line->addWidget(file_, 1);
  auto* browse = new QToolButton(box);
  browse->setObjectName(QStringLiteral("parameter_file_browse"));
  browse->setText(QStringLiteral("…"));
  browse->setToolTip(tr("Choose a file"));
  browse->setAccessibleName(browse->toolTip());
  line->addWidget(browse);
  layout->addLayout(line);

  auto* buttons = new QHBoxLayout;
  auto* save = new QPushButton(tr("&Save"), box);
  save->setObjectName(QStringLiteral("parameter_file_save"));
  save->setToolTip(tr("Saves all parameters, those of the display options too. Comments in the file are kept."));
  auto* load_button = new QPushButton(tr("L&oad"), box);
  load_button->setObjectName(QStringLiteral("parameter_file_load"));
  load_button->setToolTip(tr("All parameters become those of the file; Undo brings back what was."));
  auto* last = new QToolButton(box);
  last->setObjectName(QStringLiteral("parameter_file_recent"));
  last->setText(tr("Recent"));
  last->setPopupMode(QToolButton::InstantPopup);
  last->setToolTip(tr("Parameter files that were used last"));
  recent_ = new QMenu(last);
  last->setMenu(recent_);
  auto* reset = new QPushButton(tr("Reset all"), box);
  reset->setObjectName(QStringLiteral("reset_all"));
  reset->setToolTip(tr("All parameters back to the defaults, those of the display options too"));
  buttons->addWidget(save);
  buttons->addWidget(load_button);
  buttons->addWidget(last);
  buttons->addStretch();
  buttons->addWidget(reset);
  layout->addLayout(buttons);
  file_message_ = new QLabel(box);
  file_message_->setObjectName(QStringLiteral("parameter_file_message"));
  file_message_->setWordWrap(true);
  file_message_->setTextFormat(Qt::PlainText);
  file_message_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  file_message_->hide();
  layout->addWidget(file_message_);

  connect(save, &QPushButton::clicked, this, &RenderingParameters::save_typed);
  connect(load_button, &QPushButton::clicked, this, &RenderingParameters::load_typed);
  connect(recent_, &QMenu::aboutToShow, this, &RenderingParameters::fill_recent);
  connect(reset, &QPushButton::clicked, this, [this] { workspace_.change({}, tr("Reset all parameters")); });
  connect(browse, &QToolButton::clicked, this, [this] {
    QString start;
    try {
      start = QString::fromStdString(parameter_file_path(file_->text(), workspace_.document()));
    } catch (const Error&) {
      // Without a data set the dialog starts where it likes.
    }
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Parameter file"), start, tr("Parameter files (*.crf);;All files (*)"),
                                     nullptr, QFileDialog::DontConfirmOverwrite);
    if (!path.isEmpty()) file_->setText(path);
  });
  return box;
}

Mode RenderingParameters::page() const {
  return modes.at(static_cast<std::size_t>(pages_->currentIndex()));
}

void RenderingParameters::show_page(Mode mode) {
  pages_->setCurrentIndex(static_cast<int>(mode));
  mode_->setCurrentIndex(static_cast<int>(mode));
  not_shown_->setVisible(mode != view_mode_);
  not_shown_->setText(tr("The view is in mode %1. <a href=\"show\">Show this mode</a>")
                          .arg(QString::fromStdString(group_of_mode(view_mode_)).toHtmlEscaped()));
}

void RenderingParameters::follow_mode() {
  const Mode mode = workspace_.parameters().mode;
  if (mode == view_mode_) return;
  view_mode_ = mode;
  show_page(mode);
}

void RenderingParameters::follow_apply() {
  for (const Mode mode : modes) {
    const Page& page = page_[static_cast<std::size_t>(mode)];
    page.auto_apply->setChecked(workspace_.auto_apply(mode));
    page.apply->setEnabled(workspace_.apply_pending(mode));
  }
}

void RenderingParameters::reset_page() {
  const std::string group = group_of_mode(page());
  // Of all species that were given anything, not only those of the open file.
  Parameters parameters = workspace_.parameters();
  const Parameters defaults;
  for (const std::string& key : keys_of_group(group)) set_parameter(parameters, key, default_text(key));
  if (page() == Mode::atoms) parameters.atoms = defaults.atoms;
  workspace_.change(parameters, tr("Reset %1").arg(QString::fromStdString(group)));
}

void RenderingParameters::start_search() {
  search_->setFocus();
  search_->selectAll();
}

void RenderingParameters::search() {
  const QString query = search_->text().simplified();
  search_or_pages_->setCurrentIndex(query.isEmpty() ? 0 : 1);
  if (query.isEmpty()) return;
  std::vector<std::string> species;
  if (workspace_.document()) species = workspace_.document()->species();
  std::vector<std::string> keys = find_parameters(query, species);
  const std::size_t all = keys.size();
  if (keys.empty()) {
    found_text_->setText(tr("No parameter has “%1” in its name, key or help.").arg(query.toHtmlEscaped()));
  } else if (all > most_found) {
    keys.resize(most_found);
    found_text_->setText(tr("The best %1 of %2; another word leaves fewer.").arg(most_found).arg(all));
  } else {
    found_text_->setText(all == 1 ? tr("1 parameter") : tr("%1 parameters").arg(all));
  }
  found_->set_keys(keys, ParameterForm::Labels::place);
}

void RenderingParameters::load(const QString& path) {
  try {
    load_parameter_file(workspace_, path.toStdString());
    file_message_->hide();
  } catch (const Error& error) {
    QPalette colors = palette();
    colors.setColor(QPalette::WindowText, error_color(colors));
    file_message_->setPalette(colors);
    file_message_->setText(QStringLiteral("⚠ ") + QString::fromStdString(error.what()));
    file_message_->show();
  }
}

void RenderingParameters::load_typed() {
  try {
    load(QString::fromStdString(parameter_file_path(file_->text(), workspace_.document())));
  } catch (const Error& error) {
    workspace_.complain(QString::fromStdString(error.what()));
  }
}

void RenderingParameters::save_typed() {
  try {
    const std::string path = parameter_file_path(file_->text(), workspace_.document());
    save_parameter_file(workspace_, path);
    file_message_->setPalette(palette());
    file_message_->setText(tr("Saved: %1").arg(QString::fromStdString(path)));
    file_message_->show();
  } catch (const Error& error) {
    workspace_.complain(QString::fromStdString(error.what()));
  }
}

void RenderingParameters::fill_recent() {
  recent_->clear();
  for (const QString& path : recent_parameter_files()) {
    QAction* action = recent_->addAction(QFileInfo(path).fileName(), this, [this, path] {
      file_->setText(path);
      load(path);
    });
    action->setToolTip(path);
    action->setStatusTip(path);
  }
  if (recent_->isEmpty()) recent_->addAction(tr("None yet"))->setEnabled(false);
}

}  // namespace atomesh::gui
