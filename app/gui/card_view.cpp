#include "app/gui/card_view.h"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QPainter>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "core/stopwatch.h"
#include "render/gl/coarse_volume.h"

namespace atomesh::gui {

namespace {

// Who drags at most rests for so long, ms, in between.
constexpr int at_rest = 150;

}  // namespace

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
  rest_.setSingleShot(true);
  rest_.setInterval(at_rest);
  connect(&rest_, &QTimer::timeout, this, [this] {
    detail_ = {};
    update();
  });
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
  volume_.reset();
  coarse_.reset();
  doneCurrent();
}

void CardView::set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters,
                   const Camera& camera, const QImage& overlay) {
  const bool volume = scene && scene->scene->mode == Mode::volume;
  if (scene != scene_) {
    gpu_.set_scene(scene && !volume ? scene->scene : nullptr);
    scene_ = scene;
    moving_.forget();
    rest_.stop();
    detail_ = {};
  } else if (volume && parameters != parameters_) {
    if (parameters.supersampling != parameters_.supersampling || camera.width != camera_.width ||
        camera.height != camera_.height) {
      moving_.forget();
    }
    detail_ = moving_.next();
    if (detail_.whole()) {
      rest_.stop();
    } else {
      rest_.start();
    }
  }
  parameters_ = parameters;
  camera_ = camera;
  overlay_ = overlay;
  update();
}

void CardView::paintEvent(QPaintEvent* event) {
  if (context() != nullptr && !context()->isValid()) {
    fail(tr("OpenGL: the context is lost, the graphics card was reset"));
    return;
  }
  QOpenGLWidget::paintEvent(event);
}

void CardView::draw_volume() {
  gpu_.drop_scene();
  if (!volume_) volume_ = std::make_unique<gl::VolumePicture>();
  if (volume_->scene() != scene_->scene) {
    coarse_.reset();
    volume_->set_scene(scene_->scene);
  }
  if (detail_.cells < 1.0) {
    draw_coarse_volume();
    return;
  }
  volume_->draw(camera_, parameters_, {.stride = detail_.stride});
  if (detail_.whole()) {
    moving_.drew_whole(volume_->last(), parameters_.supersampling);
  } else {
    moving_.drew_moving(volume_->last(), detail_);
  }
}

void CardView::draw_coarse_volume() {
  if (!coarse_) {
    const std::shared_ptr<const Scene>& whole = scene_->scene;
    const auto all = static_cast<double>(whole->tetrahedra.size());
    Scene coarse = gl::coarse_volume(*whole, static_cast<std::size_t>(detail_.cells * all));
    // They borrow of the material, as the whole scene does, which therefore stays with them.
    if (whole->solids) coarse.solids = std::shared_ptr<const Scene>(whole, whole->solids.get());
    coarse_ = std::make_unique<gl::VolumePicture>();
    coarse_->set_scene(std::make_shared<const Scene>(std::move(coarse)));
  }
  // Its cells overlap here and there: there is no right order to restore.
  Parameters parameters = parameters_;
  parameters.havs.order = HavsOrder::none;
  coarse_->draw(camera_, parameters, {.stride = detail_.stride});
  moving_.drew_moving(coarse_->last(), detail_);
}

void CardView::fail(const QString& message) {
  if (failed_) return;
  failed_ = true;
  volume_.reset();
  coarse_.reset();
  emit failed(message);
}

void CardView::paintGL() {
  if (!scene_ || failed_) return;
  const auto start = std::chrono::steady_clock::now();
  try {
    if (scene_->scene->mode == Mode::volume) {
      draw_volume();
    } else {
      volume_.reset();
      coarse_.reset();
      gpu_.draw(camera_, parameters_);
      context()->functions()->glFinish();
      gl::require_living_context();
    }
  } catch (const std::bad_alloc&) {
    fail(tr("there is not enough memory"));
    return;
  } catch (const std::exception& error) {
    fail(QString::fromUtf8(error.what()));
    return;
  }
  const double ms = ms_since(start);
  const bool whole = detail_.whole();
  if (!overlay_.isNull()) {
    QPainter painter(this);
    painter.drawImage(rect(), overlay_);
  }
  emit painted(ms, whole);
}

}  // namespace atomesh::gui
