#include "app/gui/parameter_field.h"

#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QLineEdit>

#include "app/gui/color_field.h"
#include "app/gui/number_field.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/wheel_guard.h"
#include "app/gui/workspace.h"
#include "core/error.h"

namespace atomesh::gui {

ParameterField::ParameterField(Workspace& workspace, std::string key, QWidget* parent)
    : QWidget(parent),
      workspace_(workspace),
      row_(parameter_row(key)),
      key_(std::move(key)),
      default_text_(gui::default_text(key_)) {
  setObjectName(QString::fromStdString(key_));
  setToolTip(parameter_tool_tip(key_));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
}

ParameterField::~ParameterField() {
  // Parts that lose the focus as they go have nothing more to say: neither this nor the workspace may still be there.
  for (QObject* part : findChildren<QObject*>()) part->blockSignals(true);
}

void ParameterField::refresh() {
  std::string now = get_parameter(workspace_.parameters(), key_);
  if (now == text_) return;
  text_ = std::move(now);
  error_.clear();
  show_text(text_);
  emit state_changed();
}

void ParameterField::reset() {
  clear_error();
  workspace_.reset(key_);
  refresh();
}

bool ParameterField::commit(const std::string& text) {
  try {
    workspace_.set(key_, text);
  } catch (const UsageError& error) {
    set_error(field_message(error.what()));
    return false;
  }
  text_.clear();  // the editor may show the same value in other words
  refresh();
  clear_error();
  return true;
}

bool ParameterField::commit_once(const std::string& text) {
  workspace_.end_gesture();
  const bool done = commit(text);
  workspace_.end_gesture();
  return done;
}

void ParameterField::end_edit() {
  workspace_.end_gesture();
}

void ParameterField::set_error(const QString& error) {
  if (error == error_) return;
  error_ = error;
  emit state_changed();
}

void ParameterField::clear_error() {
  if (error_.isEmpty()) return;
  error_.clear();
  show_text(text_);
  emit state_changed();
}

void ParameterField::copy() const {
  QGuiApplication::clipboard()->setText(QString::fromStdString(get_parameter(workspace_.parameters(), key_)));
}

void ParameterField::paste() {
  commit_once(QGuiApplication::clipboard()->text().trimmed().toStdString());
}

void ParameterField::add_part(QWidget* part, const char* name) {
  part->setObjectName(objectName() + QLatin1Char('/') + QLatin1String(name));
  part->setToolTip(toolTip());
  part->setAccessibleName(parameter_label(key_));
  guard_wheel(part);
  layout()->addWidget(part);
  if (focusProxy() == nullptr) setFocusProxy(part);
}

namespace {

class BooleanField : public ParameterField {
 public:
  BooleanField(Workspace& workspace, const std::string& key, QWidget* parent)
      : ParameterField(workspace, key, parent), box_(new QCheckBox(this)) {
    add_part(box_, "check");
    connect(box_, &QCheckBox::clicked, this, [this](bool on) { commit_once(on ? "true" : "false"); });
  }

 protected:
  void show_text(const std::string& text) override { box_->setChecked(text == "true"); }

 private:
  QCheckBox* box_;
};

class ChoiceField : public ParameterField {
 public:
  ChoiceField(Workspace& workspace, const std::string& key, QWidget* parent)
      : ParameterField(workspace, key, parent), combo_(new QComboBox(this)) {
    for (const std::string& choice : row_.choices) {
      combo_->addItem(choice_label(row_, choice), QString::fromStdString(choice));
    }
    combo_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    combo_->setMinimumContentsLength(8);
    add_part(combo_, "combo");
    connect(combo_, &QComboBox::activated, this,
            [this](int index) { commit_once(combo_->itemData(index).toString().toStdString()); });
  }

 protected:
  void show_text(const std::string& text) override {
    combo_->setCurrentIndex(combo_->findData(QString::fromStdString(text)));
  }

 private:
  QComboBox* combo_;
};

// A name, or "auto"; with the fields of the document to choose from.
class NameField : public ParameterField {
 public:
  NameField(Workspace& workspace, const std::string& key, QWidget* parent)
      : ParameterField(workspace, key, parent), combo_(new QComboBox(this)) {
    combo_->setEditable(true);
    combo_->setInsertPolicy(QComboBox::NoInsert);
    combo_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    combo_->setMinimumContentsLength(8);
    add_part(combo_, "text");
    fill();
    const auto enter = [this] {
      if (combo_->currentText().toStdString() != text()) commit_once(combo_->currentText().trimmed().toStdString());
    };
    connect(combo_, &QComboBox::activated, this, enter);
    connect(combo_->lineEdit(), &QLineEdit::editingFinished, this, enter);
  }

  void refresh_context() override { fill(); }

 protected:
  void show_text(const std::string& text) override { combo_->setEditText(QString::fromStdString(text)); }

 private:
  void fill() {
    const QString typed = combo_->currentText();
    combo_->clear();
    combo_->addItem(QStringLiteral("auto"));
    if (workspace_.document()) {
      const Material& material = *workspace_.document()->material;
      if (material.atoms.size() > 0) combo_->addItem(QStringLiteral("defects"));
      for (const VertexField& field : material.fields) combo_->addItem(QString::fromStdString(field.name));
    }
    combo_->setEditText(typed);
  }

  QComboBox* combo_;
};

}  // namespace

ParameterField* make_parameter_field(Workspace& workspace, const std::string& key, QWidget* parent) {
  ParameterField* field = nullptr;
  switch (parameter_row(key).type) {
    case ParameterType::boolean:
      field = new BooleanField(workspace, key, parent);
      break;
    case ParameterType::integer:
    case ParameterType::real:
      field = new NumberField(workspace, key, parent);
      break;
    case ParameterType::choice:
      field = new ChoiceField(workspace, key, parent);
      break;
    case ParameterType::text:
      field = new NameField(workspace, key, parent);
      break;
    case ParameterType::rgb:
    case ParameterType::rgba:
      field = new ColorField(workspace, key, parent);
      break;
    case ParameterType::vector:
      field = new VectorField(workspace, key, parent);
      break;
    case ParameterType::color_map:
      field = new ColorMapField(workspace, key, parent);
      break;
  }
  field->refresh();
  return field;
}

}  // namespace atomesh::gui
