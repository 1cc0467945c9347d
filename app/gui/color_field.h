// Editors of colors: a button that opens the color dialog, with the opacity beside it; and a preview of a color map.
#pragma once

#include <QAbstractButton>

#include "app/gui/parameter_field.h"
#include "core/color_map.h"

class QColorDialog;
class QComboBox;
class QPushButton;

namespace atomesh::gui {

class NumberBox;

class ColorField : public ParameterField {
  Q_OBJECT

 public:
  ColorField(Workspace& workspace, const std::string& key, QWidget* parent);
  void refresh_context() override { show_text(text()); }  // a species' own color depends on its place among all

 protected:
  void show_text(const std::string& text) override;

 private:
  Vec4f color_of(const std::string& text) const;
  void open_dialog();

  QPushButton* button_;
  NumberBox* alpha_ = nullptr;
  QColorDialog* dialog_ = nullptr;
};

// A strip of the map's colors: above as they are, below with their opacity over a checkerboard.
class ColorMapPreview : public QAbstractButton {
  Q_OBJECT

 public:
  explicit ColorMapPreview(QWidget* parent);
  void set_map(const ColorMap& map);
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  ColorMap map_;
};

class ColorMapField : public ParameterField {
  Q_OBJECT

 public:
  ColorMapField(Workspace& workspace, const std::string& key, QWidget* parent);

 protected:
  void show_text(const std::string& text) override;

 private:
  ColorMapPreview* preview_;
  QComboBox* presets_;
};

}  // namespace atomesh::gui
