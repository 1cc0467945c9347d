// A colour map drawn over its histogram: entries as handles in x (scalar) and y (opacity), the colours in a strip
// below.
#pragma once

#include <QPointF>
#include <QRectF>
#include <QWidget>
#include <memory>
#include <optional>
#include <string>

#include "app/gui/scalar_histogram.h"
#include "core/color_map.h"

namespace atomesh::gui {

// Knows no workspace: what the user does is emitted, and set_color_map() shows what came of it.
//   drag a handle                scalar and opacity; Shift keeps to one of them, Ctrl snaps to twentieths, Esc takes
//   back double click, Insert         an entry there; between the selected one and the next right click, Delete a menu;
//   removes the selected entry arrows                       move by 0.01, with Shift 0.1, with Ctrl 0.001 Page Up and
//   Down, Home, End  select double click on one, Enter   asks for its colour
class ColorMapCanvas : public QWidget {
  Q_OBJECT

 public:
  explicit ColorMapCanvas(QWidget* parent = nullptr);

  void set_color_map(const ColorMap& map);
  const ColorMap& color_map() const { return map_; }
  // Null where there is none; `note` is shown in its place, or beside it while another is counted.
  void set_histogram(std::shared_ptr<const ScalarHistogram> histogram, const QString& note);
  void set_logarithmic(bool logarithmic);
  bool logarithmic() const { return logarithmic_; }

  std::optional<std::size_t> selected() const { return selected_; }
  void select(std::optional<std::size_t> index);

  // Where they are drawn, in the widget's pixels.
  QPointF handle_position(std::size_t index) const;
  QRectF plot_area() const;
  QRectF strip_area() const;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 public slots:
  void insert_after_selected();
  void remove_selected();

 signals:
  // `name` for the Undo menu; consecutive edits of one `gesture` (not "") are one step.
  void edited(const atomesh::ColorMap& map, const QString& name, const std::string& gesture);
  void gesture_ended();
  void selection_changed();
  void color_wanted(std::size_t index);
  void refused(const QString& why);  // what cannot be done, a sentence; "" once something was

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void leaveEvent(QEvent* event) override;
  bool event(QEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  struct Drag {
    std::size_t index;
    QPointF grip;   // from the pointer to the handle
    QPointF start;  // of the handle
    ColorMap before;
    std::string gesture;
  };
  std::optional<std::size_t> handle_under(const QPointF& position) const;
  double scalar_at(const QPointF& position) const;
  float opacity_at(const QPointF& position) const;
  // Does it to a copy of the map, and emits what became of it; a UsageError is refused().
  template <class Edit>
  void edit(const QString& name, const std::string& gesture, const Edit& change);
  void insert_at(double scalar, std::optional<float> opacity);
  void move_selected(double right, double up);
  void show_menu(const QPoint& at, const QPointF& where);
  QString tip_at(const QPointF& position) const;

  ColorMap map_;
  std::shared_ptr<const ScalarHistogram> histogram_;
  QString note_;
  bool logarithmic_ = true;
  std::optional<std::size_t> selected_;
  std::optional<std::size_t> hovered_;
  std::optional<Drag> drag_;
  int gestures_ = 0;  // so far; each has a name of its own
};

}  // namespace atomesh::gui
