#include "app/gui/viewport.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/gui/card_view.h"
#include "app/gui/cut_handle.h"
#include "app/gui/overlay.h"
#include "app/gui/view_input.h"

namespace atomesh::gui {

Viewport::Viewport(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("viewport");
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(160, 120);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setAccessibleName(tr("View of the sample"));
  connect(&worker_, &RenderWorker::picture, this, &Viewport::take, Qt::QueuedConnection);
  connect(&worker_, &RenderWorker::failed, &workspace_, &Workspace::complain, Qt::QueuedConnection);
  connect(&workspace_, &Workspace::shown_changed, this, &Viewport::order);
  connect(&workspace_, &Workspace::document_changed, this, &Viewport::forget_pictures);
  connect(&workspace_, &Workspace::view_options_changed, this, [this] {
    card_failed_ = {};
    refresh_overlay();
    order();
  });
  input_ = std::make_unique<ViewInput>(workspace_, *this);
  input_->set_scene_source([this] { return drawn_by_gpu() ? scene_ : picture_; });
  connect(input_.get(), &ViewInput::hot_plane_changed, this, &Viewport::refresh_overlay);
  connect(&workspace_, &Workspace::picks_changed, this, &Viewport::refresh_overlay);
  connect(&workspace_, &Workspace::marks_changed, this, &Viewport::refresh_overlay);
}

Viewport::~Viewport() {
  worker_.stop();
}

void Viewport::follow_size() {
  const double ratio = devicePixelRatioF();
  workspace_.set_view_size(std::max(1, static_cast<int>(std::lround(width() * ratio))),
                           std::max(1, static_cast<int>(std::lround(height() * ratio))));
}

void Viewport::resizeEvent(QResizeEvent*) {
  if (card_ != nullptr) card_->setGeometry(rect());
  follow_size();
}

void Viewport::showEvent(QShowEvent*) {
  follow_size();
  order();
}

void Viewport::forget_pictures() {
  picture_.reset();
  scene_.reset();
  if (card_ != nullptr) card_->hide();
  update();
}

std::optional<QString> Viewport::why_not_by_gpu() const {
  const Mode mode = workspace_.shown().mode;
  if (mode != Mode::surface && mode != Mode::atoms && mode != Mode::volume) return tr("it draws no such mode");
  const ViewOptions::Drawing drawing = workspace_.view_options().drawing;
  if (drawing == ViewOptions::Drawing::cpu) return tr("the display options say so");
  if (card_failed_[static_cast<std::size_t>(mode)]) return tr("the graphics card could not");
  const GpuInfo& gpu = gpu_of_this_machine();
  if (!(mode == Mode::volume ? gpu.volumes : gpu.sufficient)) {
    return tr("there is no OpenGL %1 here, only \"%2\" %3")
        .arg(mode == Mode::volume ? "4.3" : "3.2", QString::fromStdString(gpu.renderer),
             QString::fromStdString(gpu.version));
  }
  if (drawing == ViewOptions::Drawing::automatic && gpu.software) {
    return tr("OpenGL runs in software, which takes longer: %1").arg(QString::fromStdString(gpu.renderer));
  }
  return std::nullopt;
}

void Viewport::say_who_draws() {
  if (workspace_.shown().mode != Mode::volume) return;
  const std::optional<QString> why_not = why_not_by_gpu();
  const QString line =
      why_not
          ? tr("The processor draws the volume: %1").arg(*why_not)
          : tr("The graphics card draws the volume: %1").arg(QString::fromStdString(gpu_of_this_machine().renderer));
  if (line == said_of_volumes_) return;
  said_of_volumes_ = line;
  workspace_.say(line);
}

bool Viewport::scene_is_shown() const {
  return scene_ && scene_->material == workspace_.document()->material &&
         same_scene(scene_->parameters, workspace_.shown());
}

void Viewport::order() {
  if (!workspace_.document() || !isVisible()) {
    worker_.stop();
    return;
  }
  // Without the mode's parts nothing can be drawn; the workspace reads them and says so.
  if (!workspace_.has_parts(parts_needed(workspace_.shown()))) return;
  was_settled_ = false;
  card_painted_ = false;
  const bool on_card = drawn_by_gpu();
  say_who_draws();
  if (on_card && scene_is_shown()) {
    worker_.stop();
    show_on_card();
    return;
  }
  worker_.draw({++number_, workspace_.document()->material, workspace_.shown(), workspace_.width(), workspace_.height(),
                on_card});
}

void Viewport::take(std::shared_ptr<const WorkerPicture> picture) {
  // Of a document that is gone.
  if (!workspace_.document() || picture->material != workspace_.document()->material) return;
  if (picture->image.isNull()) {
    scene_ = std::move(picture);
    if (drawn_by_gpu() && scene_is_shown()) show_on_card();
    return;
  }
  if (picture->number != number_ && drawn_by_gpu()) return;
  picture_ = std::move(picture);
  if (card_ != nullptr) card_->hide();
  refresh_overlay();
  emit frame_shown(picture_, 0.0, picture_->complete());
}

QImage Viewport::overlay(const WorkerPicture& of, const Parameters& parameters, const Camera& camera) const {
  OverlayParts parts = overlay_parts(workspace_.view_options(), *of.scene, *of.material, parameters, camera,
                                     of.max_thickness, workspace_.marks());
  add_picks(parts, workspace_.picks(), *of.material, parameters);
  std::vector<CutHandle> handles;
  if (workspace_.view_options().cut_handles) handles = cut_handles(parameters, of.scene->bounds, camera);
  // In bands that stay in the processor's caches: of a large view all at once would be a hundred megabytes.
  QImage result(camera.width, camera.height, QImage::Format_ARGB32_Premultiplied);
  constexpr int rows = 64;
  for (int first = 0; first < camera.height; first += rows) {
    Image band(camera.width, std::min(rows, camera.height - first));
    draw_cut_handles(band, first, camera, parameters.background, handles, input_->hot_plane());
    draw_overlay(band, first, camera, *of.material, parameters.background, parts);
    put_overlay(result, band, first);
  }
  return result;
}

void Viewport::refresh_overlay() {
  if (!workspace_.document()) return;
  if (drawn_by_gpu() && card_ != nullptr && scene_is_shown()) {
    show_on_card();
  } else if (picture_) {
    overlay_ = overlay(*picture_, picture_->parameters, picture_->camera);
  }
  update();
}

void Viewport::show_on_card() {
  if (card_ == nullptr) {
    card_ = new CardView(this);
    connect(card_, &CardView::painted, this, [this](double ms, bool whole) {
      if (!drawn_by_gpu()) return;
      card_painted_ = whole;
      emit frame_shown(nullptr, ms, whole);
      if (whole && !was_settled_) {
        was_settled_ = true;
        emit became_settled();
      }
    });
    connect(card_, &CardView::refining, this, &Viewport::refining);
    connect(card_, &CardView::failed, this,
            [this] { card_failed_[static_cast<std::size_t>(scene_->scene->mode)] = true; });
    connect(card_, &CardView::failed, this, &Viewport::give_up_card, Qt::QueuedConnection);
    card_->setGeometry(rect());
  }
  const Camera camera = workspace_.camera();
  card_->set(scene_, workspace_.shown(), camera, overlay(*scene_, workspace_.shown(), camera));
  card_->show();
  picture_.reset();
}

// It cannot draw; the processor can.
void Viewport::give_up_card(const QString& message) {
  if (card_ == nullptr) return;
  // With its context: that may be what failed.
  card_->hide();
  card_->deleteLater();
  card_ = nullptr;
  workspace_.say(tr("The graphics card cannot draw this, so the processor does: %1").arg(message));
  order();
}

bool Viewport::settled() const {
  if (!workspace_.document() || !workspace_.has_parts(parts_needed(workspace_.shown()))) return false;
  if (drawn_by_gpu()) return card_painted_ && scene_is_shown();
  return picture_ && picture_->number == number_ && picture_->complete();
}

QImage Viewport::screenshot() {
  if (drawn_by_gpu() && card_ != nullptr && card_->isVisible()) return card_->picture();
  return picture_ ? grab().toImage() : QImage();
}

void Viewport::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const Vec4f& background = workspace_.shown().background;
  const bool covers = picture_ && picture_->image.format() == QImage::Format_RGB32;
  if (!covers) painter.fillRect(rect(), QColor::fromRgbF(background.r, background.g, background.b));
  if (picture_) {
    if (picture_->image.size() == size() * devicePixelRatioF()) {
      painter.scale(1.0 / devicePixelRatioF(), 1.0 / devicePixelRatioF());
      painter.drawImage(0, 0, picture_->image);
      painter.drawImage(0, 0, overlay_);
    } else {
      painter.drawImage(rect(), picture_->image);  // until the one of the new size is there
    }
  }
  painter.end();
  if (settled() && !was_settled_) {
    was_settled_ = true;
    emit became_settled();
  }
}

}  // namespace atomesh::gui
