#include "app/gui/view_input.h"

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "app/gui/navigation.h"
#include "app/gui/overlay.h"

namespace atomesh::gui {

namespace {

constexpr double side_zoom = 16.0;     // by a drag over the shorter side
constexpr double notch_zoom = 1.2;     // by a notch of the wheel, or a key
constexpr double notch = 120.0;        // of QWheelEvent::angleDelta()
constexpr double key_turn = 1 / 36.0;  // sides: 5 degrees
constexpr double key_roll = 5.0;       // degrees
constexpr double key_pan = 0.05;       // sides
constexpr int rest_ms = 300;           // without wheel and keys until it was one step

std::string view_gesture() {
  return "view";
}

}  // namespace

ViewInput::ViewInput(Workspace& workspace, QWidget& view) : QObject(&view), workspace_(workspace), view_(view) {
  view_.installEventFilter(this);
  view_.setMouseTracking(true);
  rest_.setSingleShot(true);
  rest_.setInterval(rest_ms);
  connect(&rest_, &QTimer::timeout, this, &ViewInput::end_interaction);
  connect(&workspace_, &Workspace::document_changed, this, [this] {
    job_.cancel();
    end_drag();
    set_hot_plane(std::nullopt);
  });
  connect(&workspace_, &Workspace::parts_changed, this, &ViewInput::add_defects_to_picks);
}

ViewInput::~ViewInput() = default;

bool ViewInput::eventFilter(QObject* object, QEvent* event) {
  if (object != &view_) return false;
  if (event->type() == QEvent::Leave && drag_ == Drag::none) set_hot_plane(std::nullopt);
  if (!workspace_.document() || workspace_.bounds().empty()) return false;
  switch (event->type()) {
    case QEvent::MouseButtonPress:
      return press(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseMove:
      return move(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonRelease:
      return release(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonDblClick:
      return double_click(*static_cast<QMouseEvent*>(event));
    case QEvent::Wheel:
      return wheel(*static_cast<QWheelEvent*>(event));
    case QEvent::KeyPress:
      return key(*static_cast<QKeyEvent*>(event));
    default:
      return false;
  }
}

QPointF ViewInput::on_canvas(const QPointF& position) const {
  return {position.x() * workspace_.width() / std::max(1, view_.width()),
          position.y() * workspace_.height() / std::max(1, view_.height())};
}

double ViewInput::shorter_side() const {
  return std::max(1, std::min(workspace_.width(), workspace_.height()));
}

ViewInput::Drag ViewInput::drag_of(const QMouseEvent& event) {
  const Qt::KeyboardModifiers keys = event.modifiers();
  if (event.button() == Qt::RightButton || event.button() == Qt::MiddleButton) return Drag::pan;
  if (event.button() != Qt::LeftButton) return Drag::none;
  follow_mouse(on_canvas(event.position()));
  if (hot_plane_) return (keys & (Qt::ControlModifier | Qt::AltModifier)) != 0 ? Drag::tilt_plane : Drag::move_plane;
  if ((keys & Qt::ControlModifier) != 0) return Drag::roll;
  if ((keys & Qt::ShiftModifier) != 0) return Drag::zoom;
  if ((keys & Qt::AltModifier) != 0) return Drag::pan;
  return Drag::turn;
}

bool ViewInput::press(const QMouseEvent& event) {
  if (drag_ != Drag::none) return true;  // a second button changes nothing
  drag_ = drag_of(event);
  if (drag_ == Drag::none) return false;
  end_interaction();
  workspace_.end_gesture();
  button_ = event.button();
  second_ = (event.modifiers() & (Qt::ShiftModifier | Qt::ControlModifier)) != 0;
  dragged_ = false;
  after_double_click_ = false;
  pressed_at_ = last_at_ = on_canvas(event.position());
  before_ = workspace_.parameters();
  handle_.reset();
  if (drag_ == Drag::move_plane || drag_ == Drag::tilt_plane) {
    handle_camera_ = workspace_.camera();
    for (CutHandle& handle : cut_handles(workspace_.shown(), workspace_.bounds(), handle_camera_)) {
      if (handle.plane == hot_plane_) handle_ = std::move(handle);
    }
  }
  view_.setFocus(Qt::MouseFocusReason);
  return true;
}

bool ViewInput::move(const QMouseEvent& event) {
  const QPointF at = on_canvas(event.position());
  if (drag_ == Drag::none) {
    if (event.buttons() == Qt::NoButton) follow_mouse(at);
    return false;
  }
  const QPointF way = at - pressed_at_;
  const double ratio = workspace_.width() / static_cast<double>(std::max(1, view_.width()));
  // As far as a desktop's drag has to go is far for turning a view.
  const double shake = 0.5 * QApplication::startDragDistance() * ratio;
  if (!dragged_ && std::hypot(way.x(), way.y()) < shake) return true;
  if (!dragged_) {
    dragged_ = true;
    begin_interaction();
    show_cursor();
  }
  if (handle_) {
    drag_plane(at);
  } else {
    drag_view(at);
  }
  last_at_ = at;
  return true;
}

void ViewInput::drag_view(const QPointF& to) {
  const QPointF way = to - last_at_;
  const Vec3& pivot = workspace_.rotation_center();
  const Bounds& bounds = workspace_.bounds();
  const int width = workspace_.width();
  const int height = workspace_.height();
  const double side = shorter_side();
  Parameters parameters = workspace_.parameters();
  QString name;
  switch (drag_) {
    case Drag::turn:
      rotate_view(parameters, bounds, pivot, way.x() / side, way.y() / side, workspace_.view_options().upright);
      name = tr("Turn the view");
      break;
    case Drag::roll: {
      // Round the pivot, as one turns a sheet of paper.
      const auto middle = canvas_point(make_camera(parameters, bounds, width, height), pivot);
      const QPointF center = middle ? QPointF(middle->x, middle->y) : QPointF(0.5 * width, 0.5 * height);
      const QPointF a = last_at_ - center;
      const QPointF b = to - center;
      if (std::hypot(a.x(), a.y()) < 4.0 || std::hypot(b.x(), b.y()) < 4.0) return;
      const double turn = std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x());  // rows go down
      roll_view(parameters, bounds, pivot, std::remainder(turn, 2.0 * std::numbers::pi) * 180.0 / std::numbers::pi);
      name = tr("Turn the picture");
      break;
    }
    case Drag::pan:
      pan_view(parameters, bounds, pivot, way.x(), way.y(), width, height);
      name = tr("Move the view");
      break;
    case Drag::zoom:
      zoom_view(parameters, bounds, pivot, std::pow(side_zoom, -way.y() / side), pressed_at_.x() - 0.5,
                pressed_at_.y() - 0.5, width, height);
      name = tr("Zoom");
      break;
    default:
      return;
  }
  workspace_.change(parameters, name, view_gesture());
}

void ViewInput::drag_plane(const QPointF& to) {
  const CutPlane& plane = before_.cut_planes[handle_->plane];
  const glm::dvec2 from(pressed_at_.x(), pressed_at_.y());
  const glm::dvec2 at(to.x(), to.y());
  Parameters parameters = workspace_.parameters();
  parameters.cut_planes[handle_->plane] =
      drag_ == Drag::tilt_plane ? tilted_plane(plane, *handle_, workspace_.bounds(), handle_camera_, from, at)
                                : moved_plane(plane, *handle_, workspace_.bounds(), handle_camera_, from, at);
  const QString name = drag_ == Drag::tilt_plane ? tr("Tilt cut plane %1") : tr("Move cut plane %1");
  workspace_.change(parameters, name.arg(handle_->plane + 1), "cut handle");
}

bool ViewInput::release(const QMouseEvent& event) {
  if (event.button() != button_ || drag_ == Drag::none) return drag_ != Drag::none;
  const bool click = !dragged_ && button_ == Qt::LeftButton && !after_double_click_;
  end_drag();
  if (click) look_up(on_canvas(event.position()), second_ ? Purpose::second : Purpose::first);
  follow_mouse(on_canvas(event.position()));
  return true;
}

bool ViewInput::double_click(const QMouseEvent& event) {
  if (event.button() != Qt::LeftButton) return press(event);
  // Its second press can begin a drag as any other; its release is no click.
  press(event);
  after_double_click_ = true;
  look_up(on_canvas(event.position()), Purpose::center);
  return true;
}

void ViewInput::end_drag() {
  drag_ = Drag::none;
  button_ = Qt::NoButton;
  handle_.reset();
  if (!dragged_) return;
  dragged_ = false;
  show_cursor();
  end_interaction();
}

void ViewInput::give_up_drag() {
  // All of it is the last step.
  if (!(workspace_.parameters() == before_)) workspace_.undo();
  end_drag();
}

void ViewInput::begin_interaction() {
  rest_.stop();
  moving_ = true;
}

void ViewInput::end_interaction() {
  rest_.stop();
  if (!moving_) return;
  moving_ = false;
  workspace_.end_gesture();
}

void ViewInput::change_in_passing(const Parameters& to, const QString& name) {
  begin_interaction();
  workspace_.change(to, name, view_gesture());
  rest_.start();
}

bool ViewInput::wheel(const QWheelEvent& event) {
  // With Alt the wheel goes sideways.
  const double turned = event.angleDelta().y() != 0 ? event.angleDelta().y() : event.angleDelta().x();
  if (turned == 0.0 || drag_ != Drag::none) return true;
  const QPointF at = on_canvas(event.position());
  Parameters parameters = workspace_.parameters();
  zoom_view(parameters, workspace_.bounds(), workspace_.rotation_center(), std::pow(notch_zoom, turned / notch),
            at.x() - 0.5, at.y() - 0.5, workspace_.width(), workspace_.height());
  change_in_passing(parameters, tr("Zoom"));
  return true;
}

bool ViewInput::key(const QKeyEvent& event) {
  if (event.key() == Qt::Key_Escape) {
    if (drag_ != Drag::none && dragged_) {
      give_up_drag();
      return true;
    }
    if (workspace_.picks().empty()) return false;  // somebody else's
    job_.cancel();
    workspace_.clear_picks();
    return true;
  }
  if (drag_ != Drag::none) return false;
  const Vec3& pivot = workspace_.rotation_center();
  const Bounds& bounds = workspace_.bounds();
  const int width = workspace_.width();
  const int height = workspace_.height();
  const bool shift = (event.modifiers() & Qt::ShiftModifier) != 0;
  const bool control = (event.modifiers() & Qt::ControlModifier) != 0;
  if ((event.modifiers() & (Qt::AltModifier | Qt::MetaModifier)) != 0) return false;
  Parameters parameters = workspace_.parameters();
  const auto zoom = [&](double factor) {
    zoom_view(parameters, bounds, pivot, factor, 0.5 * width - 0.5, 0.5 * height - 0.5, width, height);
    change_in_passing(parameters, tr("Zoom"));
    return true;
  };
  // To the right and down, of the viewer's own move.
  double right = 0.0;
  double down = 0.0;
  switch (event.key()) {
    case Qt::Key_PageUp:
      return zoom(notch_zoom);
    case Qt::Key_PageDown:
      return zoom(1.0 / notch_zoom);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      return !control && zoom(notch_zoom);
    case Qt::Key_Minus:
      return !control && zoom(1.0 / notch_zoom);
    case Qt::Key_Left:
      right = -1.0;
      break;
    case Qt::Key_Right:
      right = 1.0;
      break;
    case Qt::Key_Up:
      down = -1.0;
      break;
    case Qt::Key_Down:
      down = 1.0;
      break;
    default:
      return false;
  }
  if (control && down != 0.0) return zoom(down < 0.0 ? notch_zoom : 1.0 / notch_zoom);
  if (control) {
    roll_view(parameters, bounds, pivot, -right * key_roll);
    change_in_passing(parameters, tr("Turn the picture"));
  } else if (shift) {
    const double step = key_pan * shorter_side();
    pan_view(parameters, bounds, pivot, right * step, down * step, width, height);
    change_in_passing(parameters, tr("Move the view"));
  } else {
    rotate_view(parameters, bounds, pivot, right * key_turn, down * key_turn, workspace_.view_options().upright);
    change_in_passing(parameters, tr("Turn the view"));
  }
  return true;
}

void ViewInput::follow_mouse(const QPointF& at) {
  std::optional<std::size_t> plane;
  if (workspace_.view_options().cut_handles) {
    const Camera camera = workspace_.camera();
    const auto handles = cut_handles(workspace_.shown(), workspace_.bounds(), camera);
    if (const auto handle = handle_at(handles, camera, at.x(), at.y())) plane = handles[*handle].plane;
  }
  set_hot_plane(plane);
}

void ViewInput::set_hot_plane(std::optional<std::size_t> plane) {
  if (plane == hot_plane_) return;
  hot_plane_ = plane;
  show_cursor();
  emit hot_plane_changed();
}

void ViewInput::show_cursor() {
  if (drag_ != Drag::none && dragged_) {
    view_.setCursor(drag_ == Drag::pan ? Qt::SizeAllCursor : Qt::ClosedHandCursor);
  } else if (hot_plane_) {
    view_.setCursor(Qt::OpenHandCursor);
  } else {
    view_.unsetCursor();
  }
}

void ViewInput::look_up(const QPointF& at, Purpose purpose) {
  const Document& document = *workspace_.document();
  if (!workspace_.has_parts(parts_needed(workspace_.shown()))) return;  // nothing is shown yet
  // What is said of an atom are its defects too, whether the mode needs them or not.
  workspace_.need_parts({.atoms = true, .tetrahedra = false, .surface = false, .defects = true, .fields = false});
  std::shared_ptr<const WorkerPicture> shown = scene_ ? scene_() : nullptr;
  if (shown &&
      (!shown->scene || shown->material != document.material || !same_scene(shown->parameters, workspace_.shown()))) {
    shown.reset();
  }
  const auto found = std::make_shared<std::optional<Pick>>();
  job_.run(
      tr("Looking up what is there"),
      [found, shown, material = document.material, parameters = workspace_.shown(), camera = workspace_.camera(),
       column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()))](Progress& progress) {
        std::optional<Scene> own;
        if (!shown) own = make_scene(*material, parameters, progress);
        const Scene& scene = shown ? *shown->scene : *own;
        *found = pick(*material, scene, camera, parameters, column, row, 0.05, progress);
      },
      [this, found, purpose, path = document.path] {
        if (workspace_.document() && workspace_.document()->path == path) take(*found, purpose);
        emit looked_up();
      },
      [this](const QString& message) {
        workspace_.complain(message);
        emit looked_up();
      });
}

void ViewInput::take(const std::optional<Pick>& found, Purpose purpose) {
  if (found) {
    workspace_.add_pick(*found, purpose == Purpose::second);
    // The parts that were missing may have come while it was looked up.
    add_defects_to_picks();
  } else if (purpose != Purpose::second) {
    workspace_.clear_picks();
  }
  if (purpose != Purpose::center) return;
  if (found) {
    workspace_.set_rotation_center(found->position);
    const Vec3& p = found->position;
    workspace_.say(tr("The view turns about %1, %2, %3").arg(p.x, 0, 'f', 3).arg(p.y, 0, 'f', 3).arg(p.z, 0, 'f', 3));
  } else {
    workspace_.reset_rotation_center();
    workspace_.say(tr("The view turns about the middle of the sample"));
  }
}

void ViewInput::add_defects_to_picks() {
  if (!workspace_.document() || !workspace_.document()->material->defects.present()) return;
  const Defects& defects = workspace_.document()->material->defects;
  std::vector<Pick> picks = workspace_.picks();
  bool changed = false;
  for (Pick& pick : picks) {
    if (pick.atom == no_index || pick.atom >= defects.positional.size()) continue;
    const DefectValues values{defects.positional[pick.atom], defects.extra[pick.atom], defects.vacancy[pick.atom]};
    changed = changed || values.positional != pick.defects.positional || values.extra != pick.defects.extra ||
              values.vacancy != pick.defects.vacancy;
    pick.defects = values;
  }
  if (!changed) return;
  for (std::size_t i = 0; i < picks.size(); ++i) workspace_.add_pick(picks[i], i > 0);
}

}  // namespace atomesh::gui
