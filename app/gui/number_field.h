// Editors of numbers: one with a slider, and three for a vector.
#pragma once

#include <array>

#include "app/gui/parameter_field.h"
#include "app/gui/parameter_hints.h"

class QLabel;
class QSlider;

namespace atomesh::gui {

class NumberBox;

class NumberField : public ParameterField {
  Q_OBJECT

 public:
  NumberField(Workspace& workspace, const std::string& key, QWidget* parent);
  void refresh_context() override;
  void make_compact() override;

 protected:
  void show_text(const std::string& text) override;

 private:
  NumberBox* box_;
  QSlider* slider_;
  std::optional<SliderScale> scale_;
  bool compact_ = false;
};

class VectorField : public ParameterField {
  Q_OBJECT

 public:
  VectorField(Workspace& workspace, const std::string& key, QWidget* parent);

 protected:
  void show_text(const std::string& text) override;

 private:
  // The value with what one box says.
  std::string with(std::size_t axis, const QString& text) const;

  std::array<NumberBox*, 3> boxes_;
};

}  // namespace atomesh::gui
