#include "app/gui/card_view.h"

#include <QEvent>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "core/error.h"
#include "core/progress.h"
#include "core/stopwatch.h"
#include "render/gl/coarse_volume.h"

namespace atomesh::gui {

namespace {

// Who drags at most rests for so long, ms, in between.
constexpr int at_rest = 150;

// Of refining, ms: between them the window answers.
constexpr double slice = 15.0;

double rays_of(const Camera& camera, const Parameters& parameters) {
  return static_cast<double>(camera.width) * camera.height * parameters.supersampling * parameters.supersampling;
}

// Is current in place of a context that is lost, while what belonged to that is deleted. Their names mean nothing to
// it: no call is without a context, or meets somebody else's objects.
class StandIn {
 public:
  StandIn() {
    surface_.create();
    current_ = context_.create() && surface_.isValid() && context_.makeCurrent(&surface_);
  }
  ~StandIn() {
    if (current_) context_.doneCurrent();
  }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;
  bool current() const { return current_; }

 private:
  QOffscreenSurface surface_;
  QOpenGLContext context_;
  bool current_ = false;
};

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
  next_slice_.setSingleShot(true);
  next_slice_.setInterval(0);
  connect(&rest_, &QTimer::timeout, this, &CardView::refine);
  connect(&next_slice_, &QTimer::timeout, this, &CardView::refine);
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
  if (context()->isValid()) makeCurrent();
  if (context()->isValid() && QOpenGLContext::currentContext() == context()) {
    give_back();
    doneCurrent();
    return;
  }
  const StandIn other;
  if (other.current()) {
    give_back();
  } else {
    abandon();
  }
}

// A context is current.
void CardView::give_back() {
  gpu_->release();
  drop_volume();
  overlay_drawing_.release();
}

// There is no OpenGL any more: what would call it to go stays in memory.
void CardView::abandon() {
  stop_refining();
  for (auto* picture : {&volume_, &coarse_}) static_cast<void>(picture->release());
  drop_volume();
  static_cast<void>(gpu_.release());
  gpu_ = std::make_unique<GpuScene>();
  if (scene_ && scene_->scene->mode != Mode::volume) gpu_->set_scene(scene_->scene);
  overlay_drawing_.abandon();
}

// Whether OpenGL may be called from then on; else it fails.
bool CardView::take_context() {
  if (failed_) return false;
  if (context()->isValid()) makeCurrent();  // by which Qt finds out
  if (!context()->isValid()) {
    fail(tr("OpenGL: the context is lost, the graphics card was reset"));
  } else if (QOpenGLContext::currentContext() != context()) {
    fail(tr("OpenGL: the context cannot be made current"));
  }
  return !failed_;
}

void CardView::drop_volume() {
  stop_refining();
  volume_.reset();
  coarse_.reset();
  shown_.reset();
  next_.reset();
  stale_ = true;
}

void CardView::set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters,
                   const Camera& camera, const QImage& overlay) {
  if (failed_) return;
  const bool volume = scene && scene->scene->mode == Mode::volume;
  const bool other_size = camera.width != camera_.width || camera.height != camera_.height;
  const bool changed = scene != scene_ || parameters != parameters_ || other_size;
  if (scene != scene_) gpu_->set_scene(scene && !volume ? scene->scene : nullptr);
  scene_ = scene;
  parameters_ = parameters;
  camera_ = camera;
  overlay_ = overlay;
  if (!volume) {
    stop_refining();
    stale_ = true;
    detail_ = {};
  } else if (changed) {
    stop_refining();
    stale_ = true;
    moving_.expect(static_cast<double>(scene->scene->tetrahedra.size()), rays_of(camera, parameters),
                   scene->scene->solids != nullptr);
    detail_ = moving_.next();
  } else if (!stale_ && !detail_.whole() && !refining_) {
    rest_.start();  // it was hidden
  }
  update();
}

// Qt takes for granted that it can make the context current when it draws or makes another framebuffer.
bool CardView::event(QEvent* event) {
  switch (event->type()) {
    case QEvent::Paint:
    case QEvent::Resize:
    case QEvent::ScreenChangeInternal:
#if QT_VERSION >= QT_VERSION_CHECK(6, 6, 0)
    case QEvent::DevicePixelRatioChange:
#endif
      if (context() != nullptr && !take_context()) return true;
      break;
    default:
      break;
  }
  const bool taken = QOpenGLWidget::event(event);
  if (event->type() == QEvent::Paint && context() == nullptr) fail(tr("OpenGL: no context can be made"));
  return taken;
}

QImage CardView::picture() {
  if (context() == nullptr || !take_context()) return {};
  QImage shown = grabFramebuffer();
  return failed_ ? QImage() : shown;
}

void CardView::hideEvent(QHideEvent* event) {
  stop_refining();
  QOpenGLWidget::hideEvent(event);
}

// Binds it, of the picture's size.
void CardView::bind(Target& target) const {
  const QSize size(camera_.width, camera_.height);
  if (!target || target->size() != size) target = std::make_unique<QOpenGLFramebufferObject>(size);
  if (!target->isValid() || !target->bind()) throw UnavailableError("OpenGL: a picture of this size cannot be made");
}

void CardView::draw_volume() {
  gpu_->drop_scene();
  if (!volume_) volume_ = std::make_unique<gl::VolumePicture>();
  if (volume_->scene() != scene_->scene) {
    coarse_.reset();
    volume_->set_scene(scene_->scene);
  }
  bind(shown_);
  if (detail_.whole()) {
    // It was expected to take less than half of this.
    volume_->begin(camera_, parameters_);
    if (volume_->proceed(2.0 * moving_budget)) {
      moving_.drew_whole(volume_->last(), parameters_.supersampling);
      return;
    }
    volume_->give_up();
    moving_.gave_up_whole(2.0 * moving_budget);
    detail_ = moving_.next();
  }
  if (detail_.cells < 1.0) {
    draw_coarse_volume();
    return;
  }
  volume_->draw(camera_, parameters_, {.stride = detail_.stride});
  moving_.drew_moving(volume_->last(), detail_);
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

void CardView::show_volume() {
  QOpenGLExtraFunctions& gl = *context()->extraFunctions();
  GLint screen = 0;
  gl.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &screen);
  if (stale_) {
    const auto start = std::chrono::steady_clock::now();
    stop_refining();
    draw_volume();
    shown_ms_ = ms_since(start);
    stale_ = false;
    if (!detail_.whole()) rest_.start();
  }
  gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_->handle());
  gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(screen));
  gl.glDisable(GL_SCISSOR_TEST);
  gl.glBlitFramebuffer(0, 0, shown_->width(), shown_->height(), 0, 0, shown_->width(), shown_->height(),
                       GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl.glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(screen));
  gl.glFinish();
}

// One slice of the whole picture, which is begun where it is not.
void CardView::refine() {
  // What is stale is painted first.
  if (failed_ || stale_ || detail_.whole() || !isVisible() || !take_context()) return;
  bool finished = false;
  double fraction = 0.0;
  if (!draw_or_fail([&] {
        const auto start = std::chrono::steady_clock::now();
        bind(next_);
        if (!refining_) {
          volume_->begin(camera_, parameters_);
          refining_ = true;
          refined_ms_ = 0.0;
        }
        Progress progress([&fraction](std::string_view, double drawn) { fraction = drawn; });
        finished = volume_->proceed(slice, progress);
        refined_ms_ += ms_since(start);
      })) {
    return;
  }
  context()->functions()->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
  if (!finished) {
    if (fraction > 0.0) emit refining(fraction);
    next_slice_.start();
    return;
  }
  refining_ = false;
  moving_.drew_whole(volume_->last(), parameters_.supersampling);
  std::swap(shown_, next_);
  shown_ms_ = refined_ms_;
  detail_ = {};
  update();
}

void CardView::stop_refining() {
  rest_.stop();
  next_slice_.stop();
  if (refining_) volume_->give_up();
  refining_ = false;
}

template <class Draw>
bool CardView::draw_or_fail(Draw&& draw) {
  try {
    draw();
    return true;
  } catch (const std::bad_alloc&) {
    fail(tr("there is not enough memory"));
  } catch (const std::exception& error) {
    fail(QString::fromUtf8(error.what()));
  }
  return false;
}

void CardView::fail(const QString& message) {
  if (failed_) return;
  failed_ = true;
  stop_refining();
  emit failed(message);
}

void CardView::paintGL() {
  if (!scene_ || failed_) return;
  const auto start = std::chrono::steady_clock::now();
  const bool volume = scene_->scene->mode == Mode::volume;
  if (!draw_or_fail([&] {
        if (volume) {
          show_volume();
        } else {
          drop_volume();
          gpu_->draw(camera_, parameters_);
          context()->functions()->glFinish();
          gl::require_living_context();
        }
      })) {
    return;
  }
  const double ms = volume ? shown_ms_ : ms_since(start);
  const bool whole = detail_.whole();
  if (!overlay_.isNull()) {
    const QSize size = rect().size() * devicePixelRatioF();
    context()->functions()->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
    if (!draw_or_fail([&] { overlay_drawing_.draw(overlay_, size.width(), size.height()); })) return;
  }
  emit painted(ms, whole);
}

}  // namespace atomesh::gui
