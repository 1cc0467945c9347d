#include "app/gui/parameter_form.h"

#include <QGridLayout>
#include <QLabel>
#include <QMenu>
#include <QToolButton>
#include <algorithm>

#include "app/gui/parameter_field.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/theme.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

ParameterForm::ParameterForm(Workspace& workspace, QWidget* parent)
    : QWidget(parent), workspace_(workspace), grid_(new QGridLayout(this)) {
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setColumnStretch(0, 2);
  grid_->setColumnStretch(1, 3);
  connect(&workspace_, &Workspace::parameters_changed, this, [this] {
    for (const Row& row : rows_) {
      row.field->refresh();
      // A slider over the sample turns with the plane's normal.
      if (row.key.ends_with(".distance")) row.field->refresh_context();
    }
  });
  const auto context = [this] {
    for (const Row& row : rows_) row.field->refresh_context();
  };
  connect(&workspace_, &Workspace::document_changed, this, context);
  connect(&workspace_, &Workspace::parts_changed, this, context);
}

void ParameterForm::set_keys(const std::vector<std::string>& keys, Labels labels) {
  for (const Row& row : rows_) {
    for (QWidget* part : {static_cast<QWidget*>(row.label), static_cast<QWidget*>(row.field),
                          static_cast<QWidget*>(row.reset), static_cast<QWidget*>(row.message)}) {
      grid_->removeWidget(part);
      part->hide();
    }
  }
  keys_ = keys;
  int line = 0;
  QWidget* last = nullptr;
  for (const std::string& key : keys) {
    const Row& row = row_of(key, labels);
    grid_->addWidget(row.label, line, 0);
    grid_->addWidget(row.field, line, 1);
    grid_->addWidget(row.reset, line, 2);
    grid_->addWidget(row.message, line + 1, 0, 1, 3);
    row.label->show();
    row.field->show();
    update_row(row);
    // Part by part: a field as a whole has no place of its own in the order.
    QList<QWidget*> stops = row.field->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly);
    stops << row.reset;
    for (QWidget* stop : stops) {
      if ((stop->focusPolicy() & Qt::TabFocus) == 0) continue;
      if (last != nullptr) setTabOrder(last, stop);
      last = stop;
    }
    line += 2;
  }
}

ParameterForm::Row& ParameterForm::row_of(const std::string& key, Labels labels) {
  const auto there = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.key == key; });
  if (there != rows_.end()) return *there;
  Row row;
  row.key = key;
  row.field = make_parameter_field(workspace_, key, this);
  const QString label =
      labels == Labels::heading
          ? short_parameter_label(key)
          : parameter_label(key) + QStringLiteral("\n(%1)").arg(QString::fromStdString(parameter_row(key).group));
  row.label = new QLabel(label, this);
  row.label->setTextFormat(Qt::PlainText);
  row.label->setWordWrap(true);
  row.label->setBuddy(row.field);
  row.label->setToolTip(row.field->toolTip());
  row.label->setContextMenuPolicy(Qt::CustomContextMenu);
  row.reset = new QToolButton(this);
  row.reset->setObjectName(QString::fromStdString(key) + QStringLiteral("/reset"));
  row.reset->setText(QStringLiteral("↺"));
  row.reset->setAutoRaise(true);
  row.reset->setToolTip(tr("Back to the default, %1").arg(QString::fromStdString(default_text(key))));
  row.reset->setAccessibleName(tr("Reset %1").arg(parameter_label(key)));
  QSizePolicy keep = row.reset->sizePolicy();
  keep.setRetainSizeWhenHidden(true);  // or the editors would jump
  row.reset->setSizePolicy(keep);
  row.message = new QLabel(this);
  row.message->setObjectName(QString::fromStdString(key) + QStringLiteral("/message"));
  row.message->setWordWrap(true);
  row.message->setTextFormat(Qt::PlainText);
  row.message->hide();

  connect(row.reset, &QToolButton::clicked, row.field, [field = row.field] { field->reset(); });
  connect(row.field, &ParameterField::edit_color_map_requested, this, &ParameterForm::edit_color_map_requested);
  connect(row.field, &ParameterField::state_changed, this, [this, row] { update_row(row); });
  connect(row.label, &QWidget::customContextMenuRequested, this,
          [this, row](const QPoint& place) { show_menu(row, row.label->mapToGlobal(place)); });
  rows_.push_back(row);
  return rows_.back();
}

void ParameterForm::update_row(const Row& row) const {
  const bool shown = std::find(keys_.begin(), keys_.end(), row.key) != keys_.end();
  const bool modified = row.field->modified();
  QFont font = row.label->font();
  if (font.bold() != modified) {
    font.setBold(modified);
    row.label->setFont(font);
  }
  row.reset->setVisible(shown && modified);
  const QString error = row.field->error();
  row.message->setVisible(shown && !error.isEmpty());
  QPalette colors = row.label->palette();
  colors.setColor(QPalette::WindowText, error_color(colors));
  row.message->setPalette(colors);
  row.message->setText(error.isEmpty() ? QString() : QStringLiteral("⚠ ") + error);
}

void ParameterForm::show_menu(const Row& row, const QPoint& place) {
  auto* menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  QAction* reset = menu->addAction(tr("&Reset to default"), row.field, [field = row.field] { field->reset(); });
  reset->setEnabled(row.field->modified());
  menu->addAction(tr("&Copy value"), row.field, [field = row.field] { field->copy(); });
  menu->addAction(tr("&Paste value"), row.field, [field = row.field] { field->paste(); });
  menu->addSeparator();
  menu->addAction(tr("&Help"), this, [this, key = row.key] { emit help_requested(QString::fromStdString(key)); });
  menu->popup(place);
}

ParameterField* ParameterForm::field(const std::string& key) const {
  for (const Row& row : rows_) {
    if (row.key == key) return row.field;
  }
  return nullptr;
}

std::vector<std::string> ParameterForm::modified_keys() const {
  std::vector<std::string> keys;
  for (const std::string& key : keys_) {
    if (field(key)->modified()) keys.push_back(key);
  }
  return keys;
}

void reset_parameters(Workspace& workspace, const std::vector<std::string>& keys, const QString& name) {
  Parameters parameters = workspace.parameters();
  for (const std::string& key : keys) set_parameter(parameters, key, default_text(key));
  workspace.change(parameters, name);
}

}  // namespace atomesh::gui
