// Mouse, wheel and keys of the view: what they do to the workspace.
#pragma once

#include <QObject>
#include <QPointF>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>

#include "app/gui/cut_handle.h"
#include "app/gui/latest_job.h"
#include "app/gui/render_worker.h"
#include "app/gui/workspace.h"

class QKeyEvent;
class QMouseEvent;
class QWheelEvent;

namespace atomesh::gui {

// The manual's controls (B.6.1) and, where it has none, OVITO's. Distances are those of the widget, which must be the
// whole view (Workspace::width() × height() device pixels).
//
//   left drag             turns about the rotation centre      (with a cut plane's handle under it: moves the plane;
//                                                                with Ctrl or Alt: tilts it)
//   Ctrl + left drag      turns the picture about that centre
//   right or middle drag  moves the sample; Alt + left drag too
//   Shift + left up/down  zooms about where the drag began
//   wheel                 zooms about the mouse
//   click                 picks what is there, or nothing;  with Shift or Ctrl a second thing, to measure
//   double click          makes what is there the rotation centre, or where nothing is, the middle again
//   arrows                turn;  with Shift move, with Ctrl turn the picture (left, right) or zoom (up, down)
//   + -, page up, down    zoom
//   Escape                gives up a drag: all is as it was before;  else forgets the picks
//
// A drag, and turns of the wheel or keys that follow one another at once, are one step of the history. Picking is done
// beside the window's thread.
class ViewInput : public QObject {
  Q_OBJECT

 public:
  // Watches the events of `view`, and switches its mouse tracking on. Both must outlive it.
  ViewInput(Workspace& workspace, QWidget& view);
  ~ViewInput() override;

  // Where the scene comes from that the view shows: what is picked is looked up in it, if it is still that of the
  // workspace; else one is made for the look-up.
  void set_scene_source(std::function<std::shared_ptr<const WorkerPicture>()> source) { scene_ = std::move(source); }

  // The cut plane (index) whose handle is under the mouse or dragged.
  std::optional<std::size_t> hot_plane() const { return hot_plane_; }

 signals:
  void hot_plane_changed();
  void looked_up();  // a click's look-up has ended, and the workspace knows what came of it

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  enum class Drag { none, turn, roll, pan, zoom, move_plane, tilt_plane };
  enum class Purpose { first, second, center };

  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool double_click(const QMouseEvent& event);
  bool wheel(const QWheelEvent& event);
  bool key(const QKeyEvent& event);

  Drag drag_of(const QMouseEvent& event);
  void drag_view(const QPointF& to);
  void drag_plane(const QPointF& to);
  void give_up_drag();
  void end_drag();
  void begin_interaction();
  void end_interaction();
  // Of wheel and keys, which nobody releases: ends a while after the last.
  void change_in_passing(const Parameters& to, const QString& name);
  void follow_mouse(const QPointF& at);
  void set_hot_plane(std::optional<std::size_t> plane);
  void show_cursor();
  void look_up(const QPointF& at, Purpose purpose);
  void take(const std::optional<Pick>& found, Purpose purpose);
  void add_defects_to_picks();

  // Canvas coordinates: device pixels, the centre of the first at (0.5, 0.5).
  QPointF on_canvas(const QPointF& position) const;
  double shorter_side() const;

  Workspace& workspace_;
  QWidget& view_;
  std::function<std::shared_ptr<const WorkerPicture>()> scene_;
  LatestJob job_;
  QTimer rest_{this};  // after wheel and keys

  Drag drag_ = Drag::none;
  Qt::MouseButton button_ = Qt::NoButton;
  bool second_ = false;   // pressed with Shift or Ctrl
  bool dragged_ = false;  // further than a hand shakes
  bool after_double_click_ = false;
  QPointF pressed_at_;  // on the canvas
  QPointF last_at_;
  Parameters before_;  // as they were when the drag began
  std::optional<CutHandle> handle_;
  Camera handle_camera_;
  std::optional<std::size_t> hot_plane_;
  bool moving_ = false;
};

}  // namespace atomesh::gui
