#include "app/gui/number_field.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>

#include "app/gui/number_box.h"
#include "app/gui/workspace.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

NumberField::NumberField(Workspace& workspace, const std::string& key, QWidget* parent)
    : ParameterField(workspace, key, parent), box_(new NumberBox(this)), slider_(new QSlider(Qt::Horizontal, this)) {
  box_->set_range(row_.min, row_.max);
  add_part(box_, "box");
  if (!row_.unit.empty()) {
    auto* unit = new QLabel(QString::fromStdString(row_.unit == "degrees" ? "°" : row_.unit), this);
    unit->setToolTip(toolTip());
    layout()->addWidget(unit);
  }
  slider_->setRange(0, SliderScale::positions);
  slider_->setSingleStep(SliderScale::positions / 100);
  slider_->setPageStep(SliderScale::positions / 10);
  slider_->setMinimumWidth(fontMetrics().averageCharWidth() * 6);
  add_part(slider_, "slider");
  static_cast<QHBoxLayout*>(layout())->setStretchFactor(slider_, 1);
  static_cast<QHBoxLayout*>(layout())->addStretch();

  connect(box_, &NumberBox::entered, this, [this](const QString& text) { commit_once(text.toStdString()); });
  connect(box_, &NumberBox::stepped, this, [this](const QString& text) { commit(text.toStdString()); });
  connect(box_, &NumberBox::steps_ended, this, [this] { end_edit(); });
  connect(box_, &NumberBox::given_up, this, [this] { clear_error(); });
  connect(slider_, &QSlider::valueChanged, this, [this](int position) {
    if (scale_) commit(real_text(scale_->value(position)));
  });
  connect(slider_, &QSlider::sliderReleased, this, [this] {
    end_edit();
    show_text(text());
  });
  refresh_context();
}

void NumberField::refresh_context() {
  scale_ = slider_scale(key(), workspace_.parameters(), workspace_.bounds());
  box_->set_scale(scale_ ? *scale_ : step_scale(key()));
  slider_->setVisible(scale_ && !compact_);
  if (!text().empty() && error().isEmpty() && !box_->being_edited()) show_text(text());
}

void NumberField::make_compact() {
  compact_ = true;
  slider_->hide();
}

void NumberField::show_text(const std::string& text) {
  box_->show_text(QString::fromStdString(text));
  // While it is dragged the slider is where the hand is; and where it means this very value it stays, so that small
  // steps add up between whole numbers.
  if (!scale_ || slider_->isSliderDown() || real_text(scale_->value(slider_->value())) == text) return;
  const QSignalBlocker blocker(slider_);
  slider_->setValue(scale_->position(read_real(text).value_or(scale_->low)));
}

VectorField::VectorField(Workspace& workspace, const std::string& key, QWidget* parent)
    : ParameterField(workspace, key, parent), boxes_{} {
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto* box = boxes_[axis] = new NumberBox(this);
    box->set_range(row_.min, row_.max);
    box->set_scale(step_scale(key));
    add_part(box, names[axis]);
    box->setAccessibleName(parameter_label(key) + QLatin1Char(' ') + QLatin1String(names[axis]));
    connect(box, &NumberBox::entered, this, [this, axis](const QString& text) { commit_once(with(axis, text)); });
    connect(box, &NumberBox::stepped, this, [this, axis](const QString& text) { commit(with(axis, text)); });
    connect(box, &NumberBox::steps_ended, this, [this] { end_edit(); });
    connect(box, &NumberBox::given_up, this, [this] { clear_error(); });
  }
}

void VectorField::show_text(const std::string& text) {
  const QStringList parts = QString::fromStdString(text).split(QLatin1Char(','));
  for (int axis = 0; axis < 3; ++axis) boxes_[static_cast<std::size_t>(axis)]->show_text(parts.value(axis));
}

std::string VectorField::with(std::size_t axis, const QString& text) const {
  // A whole vector can be typed or pasted into any of the three.
  if (read_vector(text.toStdString())) return text.toStdString();
  std::string joined;
  for (std::size_t i = 0; i < 3; ++i) {
    joined += (i > 0 ? "," : "") + (i == axis ? text : boxes_[i]->text()).toStdString();
  }
  return joined;
}

}  // namespace atomesh::gui
