#include "app/gui/species_table.h"

#include <QGridLayout>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "app/gui/parameter_field.h"
#include "app/gui/parameter_form.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/theme.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

namespace {

// "atoms.color.", "atoms.visible.", …: what the table has for each species, in its order.
std::vector<std::string> species_prefixes() {
  std::vector<std::string> prefixes;
  constexpr std::string_view mark = "<species>";
  for (const ParameterRow& row : parameter_table()) {
    if (row.key.ends_with(mark)) prefixes.push_back(row.key.substr(0, row.key.size() - mark.size()));
  }
  return prefixes;
}

}  // namespace

SpeciesTable::SpeciesTable(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName(QStringLiteral("species_table"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  connect(&workspace_, &Workspace::document_changed, this, &SpeciesTable::fill);
  connect(&workspace_, &Workspace::parts_changed, this, &SpeciesTable::fill);
  connect(&workspace_, &Workspace::parameters_changed, this, [this] {
    for (const Line& line : lines_) {
      for (ParameterField* field : line.fields) field->refresh();
    }
  });
  fill();
}

void SpeciesTable::fill() {
  std::vector<std::string> species;
  if (workspace_.document()) species = workspace_.document()->species();
  const bool same = content_ != nullptr && species.size() == lines_.size() &&
                    std::equal(species.begin(), species.end(), lines_.begin(),
                               [](const std::string& name, const Line& line) { return name == line.species; });
  if (same) return;
  for (const Line& line : lines_) {
    for (ParameterField* field : line.fields) delete field;  // before the labels that they speak to
  }
  lines_.clear();
  keys_.clear();
  delete content_;
  content_ = new QWidget(this);
  layout()->addWidget(content_);
  auto* grid = new QGridLayout(content_);
  grid->setContentsMargins(0, 0, 0, 0);
  if (species.empty()) {
    auto* none = new QLabel(
        workspace_.document() ? tr("The open file has no atoms.") : tr("Species are listed here when a file is open."),
        content_);
    none->setWordWrap(true);
    grid->addWidget(none, 0, 0);
    return;
  }
  const std::vector<std::string> prefixes = species_prefixes();
  for (std::size_t column = 0; column < prefixes.size(); ++column) {
    const std::string key = prefixes[column] + species.front();
    auto* heading = new QLabel(short_parameter_label(key), content_);
    heading->setToolTip(QString::fromStdString(parameter_row(key).help));
    grid->addWidget(heading, 0, static_cast<int>(column) + 1);
  }
  grid->setColumnStretch(static_cast<int>(prefixes.size()) + 1, 1);
  for (const std::string& name : species) {
    const int row = grid->rowCount();
    Line line;
    line.species = name;
    line.name = new QLabel(QString::fromStdString(name), content_);
    line.name->setTextFormat(Qt::PlainText);
    line.name->setContextMenuPolicy(Qt::CustomContextMenu);
    grid->addWidget(line.name, row, 0);
    line.message = new QLabel(content_);
    line.message->setWordWrap(true);
    line.message->setTextFormat(Qt::PlainText);
    line.message->setObjectName(QStringLiteral("species ") + line.name->text() + QStringLiteral("/message"));
    for (std::size_t column = 0; column < prefixes.size(); ++column) {
      keys_.push_back(prefixes[column] + name);
      ParameterField* field = make_parameter_field(workspace_, keys_.back(), content_);
      field->make_compact();
      field->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Preferred);
      grid->addWidget(field, row, static_cast<int>(column) + 1);
      line.fields.push_back(field);
    }
    grid->addWidget(line.message, row + 1, 0, 1, static_cast<int>(prefixes.size()) + 2);
    lines_.push_back(line);
    const std::size_t number = lines_.size() - 1;
    for (ParameterField* field : line.fields) {
      connect(field, &ParameterField::state_changed, this, [this, number] { update_line(number); });
    }
    connect(line.name, &QWidget::customContextMenuRequested, this, [this, number](const QPoint& place) {
      const Line& of = lines_[number];
      std::vector<std::string> keys;
      for (const ParameterField* field : of.fields) keys.push_back(field->key());
      auto* menu = new QMenu(this);
      menu->setAttribute(Qt::WA_DeleteOnClose);
      menu->addAction(tr("&Reset to default"), this, [this, keys, name = of.name->text()] {
        reset_parameters(workspace_, keys, tr("Reset %1").arg(name));
      });
      menu->addAction(tr("&Help"), this,
                      [this, key = keys.front()] { emit help_requested(QString::fromStdString(key)); });
      menu->popup(of.name->mapToGlobal(place));
    });
    update_line(number);
  }
  const int row = grid->rowCount();
  const auto add = [&](const QString& text, const char* object_name, bool visible, int column) {
    auto* button = new QPushButton(text, content_);
    button->setObjectName(QLatin1String(object_name));
    grid->addWidget(button, row, column, 1, column == 0 ? 2 : 3);
    connect(button, &QPushButton::clicked, this, [this, visible] { show_all(visible); });
  };
  add(tr("Show a&ll"), "show_all_species", true, 0);
  add(tr("Hide all"), "hide_all_species", false, 2);
}

void SpeciesTable::show_all(bool visible) {
  Parameters parameters = workspace_.parameters();
  for (const Line& line : lines_)
    set_parameter(parameters, "atoms.visible." + line.species, visible ? "true" : "false");
  workspace_.change(parameters, visible ? tr("Show all species") : tr("Hide all species"));
}

void SpeciesTable::update_line(std::size_t number) {
  const Line& line = lines_[number];
  bool modified = false;
  QString error;
  for (const ParameterField* field : line.fields) {
    modified = modified || field->modified();
    if (error.isEmpty()) error = field->error();
  }
  QFont font = line.name->font();
  font.setBold(modified);
  line.name->setFont(font);
  QPalette colors = line.name->palette();
  colors.setColor(QPalette::WindowText, error_color(colors));
  line.message->setPalette(colors);
  line.message->setVisible(!error.isEmpty());
  line.message->setText(error.isEmpty() ? QString() : QStringLiteral("⚠ ") + error);
}

}  // namespace atomesh::gui
