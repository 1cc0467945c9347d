#include "app/gui/viewport.h"

#include <QPainter>
#include <cmath>
#include <utility>

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
  follow_size();
}

void Viewport::showEvent(QShowEvent*) {
  follow_size();
  order();
}

void Viewport::forget_pictures() {
  picture_.reset();
  update();
}

void Viewport::order() {
  if (!workspace_.document() || !isVisible()) {
    worker_.stop();
    return;
  }
  // Without the mode's parts nothing can be drawn; the workspace reads them and says so.
  if (!workspace_.has_parts(parts_needed(workspace_.shown()))) return;
  was_settled_ = false;
  worker_.draw(
      {++number_, workspace_.document()->material, workspace_.shown(), workspace_.width(), workspace_.height(), false});
}

void Viewport::take(std::shared_ptr<const WorkerPicture> picture) {
  // Of a document that is gone.
  if (!workspace_.document() || picture->material != workspace_.document()->material) return;
  picture_ = std::move(picture);
  update();
  emit frame_shown(picture_, 0.0);
}

bool Viewport::settled() const {
  return workspace_.document().has_value() && picture_ && picture_->number == number_ && picture_->complete() &&
         workspace_.has_parts(parts_needed(workspace_.shown()));
}

bool Viewport::drawn_by_gpu() const {
  return false;
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
