#include "app/gui/pipeline_form.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>

#include "core/error.h"

namespace atomesh::gui {

namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

QString field_text(const QWidget* field) {
  const auto* choice = qobject_cast<const QComboBox*>(field);
  return choice != nullptr ? choice->currentText() : qobject_cast<const QLineEdit*>(field)->text();
}

void set_field_text(QWidget* field, const QString& value) {
  if (auto* choice = qobject_cast<QComboBox*>(field)) {
    choice->setCurrentText(value);
  } else {
    qobject_cast<QLineEdit*>(field)->setText(value);
  }
}

}  // namespace

PipelineForm::PipelineForm(QWidget* parent) : QWidget(parent) {
  opener_ = new QToolButton(this);
  opener_->setObjectName("settings_opener");
  opener_->setText(tr("&Settings of preprocessing"));
  opener_->setToolTip(tr("The options that atomesh preprocess has too; the defaults suit most samples"));
  opener_->setCheckable(true);
  opener_->setAutoRaise(true);
  opener_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  table_ = make_table();
  message_ = new QLabel(this);
  message_->setObjectName("settings_message");
  message_->setWordWrap(true);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(opener_);
  layout->addWidget(table_, 1);
  layout->addWidget(message_);
  connect(opener_, &QToolButton::toggled, this, &PipelineForm::open);
  connect(this, &PipelineForm::changed, this, &PipelineForm::show_state);
  open(false);
}

QWidget* PipelineForm::make_table() {
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  QFormLayout* form = nullptr;
  std::string group;
  for (const PipelineSetting& setting : pipeline_settings()) {
    if (form == nullptr || setting.group != group) {
      group = setting.group;
      auto* box = new QGroupBox(tr(group.c_str()), content);
      form = new QFormLayout(box);
      form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
      column->addWidget(box);
    }
    QWidget* field = make_field(setting);
    auto* label = new QLabel(tr(setting.label.c_str()));
    label->setToolTip(field->toolTip());
    label->setBuddy(fields_.at(setting.name));
    form->addRow(label, field);
  }
  column->addStretch(1);
  auto* scroll = new QScrollArea(this);
  scroll->setObjectName("settings_table");
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setMinimumHeight(fontMetrics().height() * 12);
  return scroll;
}

QWidget* PipelineForm::make_field(const PipelineSetting& setting) {
  QWidget* field = nullptr;
  if (setting.choices.empty()) {
    auto* line = new QLineEdit(text(setting.initial));
    line->setPlaceholderText(text(setting.type));
    connect(line, &QLineEdit::textChanged, this, &PipelineForm::changed);
    field = line;
  } else {
    auto* choice = new QComboBox;
    for (const std::string& word : setting.choices) choice->addItem(text(word));
    choice->setEditable(setting.open);
    choice->setInsertPolicy(QComboBox::NoInsert);
    choice->setCurrentText(text(setting.initial));
    connect(choice, &QComboBox::currentTextChanged, this, &PipelineForm::changed);
    field = choice;
  }
  field->setObjectName("setting_" + text(setting.name));
  // As rich text, which is wrapped.
  const QString tip =
      "<p>" + text(setting.help).toHtmlEscaped() + "</p><p>" +
      tr("Takes %1. The same as --%2 of atomesh preprocess.")
          .arg(text(setting.type.empty() ? "a number" : setting.type).toHtmlEscaped(), text(setting.name)) +
      "</p>";
  field->setToolTip(tip);
  field->setAccessibleName(text(setting.label));
  fields_[setting.name] = field;
  if (!setting.file) return field;
  auto* browse = new QPushButton(tr("Browse…"));
  browse->setObjectName("browse_" + text(setting.name));
  browse->setToolTip(tr("Choose a file"));
  connect(browse, &QPushButton::clicked, this, [this, field, label = setting.label] {
    const QString path = QFileDialog::getOpenFileName(this, tr(label.c_str()));
    if (!path.isEmpty()) set_field_text(field, path);
  });
  auto* both = new QWidget;
  auto* row = new QHBoxLayout(both);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(field, 1);
  row->addWidget(browse);
  both->setToolTip(tip);
  return both;
}

PipelineValues PipelineForm::values() const {
  PipelineValues values;
  for (const PipelineSetting& setting : pipeline_settings()) {
    const std::string value = field_text(fields_.at(setting.name)).trimmed().toStdString();
    if (!value.empty() && value != setting.initial) values[setting.name] = value;
  }
  return values;
}

void PipelineForm::set_values(const PipelineValues& values) {
  for (const PipelineSetting& setting : pipeline_settings()) {
    const auto found = values.find(setting.name);
    set_field_text(fields_.at(setting.name), text(found == values.end() ? setting.initial : found->second));
  }
}

QString PipelineForm::problem() const {
  try {
    options();
    return {};
  } catch (const UsageError& error) {
    return QString::fromUtf8(error.what());
  }
}

void PipelineForm::open(bool opened) {
  opener_->setChecked(opened);
  opener_->setArrowType(opened ? Qt::DownArrow : Qt::RightArrow);
  table_->setVisible(opened);
  show_state();
}

void PipelineForm::show_state() {
  QString message = problem();
  if (message.isEmpty() && !opener_->isChecked()) {
    QStringList changed;
    for (const auto& [name, value] : values()) changed << text(name) + " " + text(value);
    if (!changed.isEmpty()) message = tr("Changed: %1").arg(changed.join(", "));
  }
  message_->setText(message);
  message_->setVisible(!message.isEmpty());
}

}  // namespace atomesh::gui
