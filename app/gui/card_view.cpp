#include "app/gui/card_view.h"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QPainter>
#include <chrono>

#include "core/error.h"
#include "core/stopwatch.h"

namespace atomesh::gui {

const GpuInfo& gpu_of_this_machine() {
  static const GpuInfo info = [] {
    QOpenGLContext context;
    QOffscreenSurface surface;
    surface.create();
    if (!context.create() || !surface.isValid() || !context.makeCurrent(&surface)) return GpuInfo{};
    GpuInfo found =
        gpu_info([&context](const char* name) { return reinterpret_cast<void*>(context.getProcAddress(name)); });
    context.doneCurrent();
    return found;
  }();
  return info;
}

CardView::CardView(QWidget* parent) : QOpenGLWidget(parent) {
  setObjectName("card_view");
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setFocusPolicy(Qt::NoFocus);
}

CardView::~CardView() {
  release();
}

void CardView::initializeGL() {
  connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &CardView::release, Qt::DirectConnection);
}

void CardView::release() {
  if (context() == nullptr) return;
  disconnect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &CardView::release);
  makeCurrent();
  gpu_.release();
  doneCurrent();
}

void CardView::set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters,
                   const Camera& camera, const QImage& overlay) {
  if (scene != scene_) {
    scene_ = scene;
    gpu_.set_scene(scene ? scene->scene : nullptr);
  }
  parameters_ = parameters;
  camera_ = camera;
  overlay_ = overlay;
  update();
}

void CardView::paintGL() {
  if (!scene_) return;
  const auto start = std::chrono::steady_clock::now();
  try {
    gpu_.draw(camera_, parameters_);
    context()->functions()->glFinish();
  } catch (const Error& error) {
    emit failed(QString::fromUtf8(error.what()));
    return;
  }
  const double ms = ms_since(start);
  if (!overlay_.isNull()) {
    QPainter painter(this);
    painter.drawImage(rect(), overlay_);
  }
  emit painted(ms);
}

}  // namespace atomesh::gui
