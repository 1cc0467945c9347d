#include "app/gui/render_worker.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/progressive.h"

namespace atomesh::gui {

namespace {

// The window goes before what is drawn for it.
constexpr int niceness = 5;
// Milliseconds: below the first a picture is drawn whole; below the others with so many coarse ones before.
constexpr double an_instant = 70.0;
constexpr double a_moment = 700.0;
constexpr double a_while = 3000.0;

std::uint8_t to_byte(float channel) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0F, 1.0F) * 255.0F));
}

}  // namespace

QImage to_qimage(const Image& image) {
  const bool opaque =
      std::all_of(image.pixels.begin(), image.pixels.end(), [](const Vec4f& pixel) { return pixel.a >= 1.0F; });
  // Of an opaque picture what painting it takes no conversion of.
  QImage result(image.width, image.height, opaque ? QImage::Format_RGB32 : QImage::Format_ARGB32);
  for (int row = 0; row < image.height; ++row) {
    auto* const pixels = reinterpret_cast<QRgb*>(result.scanLine(row));
    for (int column = 0; column < image.width; ++column) {
      const Vec4f& pixel = image.at(column, row);
      pixels[column] = qRgba(to_byte(pixel.r), to_byte(pixel.g), to_byte(pixel.b), to_byte(pixel.a));
    }
  }
  return result;
}

void put_overlay(QImage& picture, const Image& band, int first_row) {
  for (int row = 0; row < band.height; ++row) {
    auto* const pixels = reinterpret_cast<QRgb*>(picture.scanLine(first_row + row));
    for (int column = 0; column < band.width; ++column) {
      const Vec4f& pixel = band.at(column, row);
      const float a = pixel.a;
      pixels[column] =
          a == 0.0F ? 0U : qRgba(to_byte(a * pixel.r), to_byte(a * pixel.g), to_byte(a * pixel.b), to_byte(a));
    }
  }
}

bool same_scene(const Parameters& a, const Parameters& b) {
  // What make_scene() does not read is made equal.
  Parameters c = a;
  c.background = b.background;
  c.lights = b.lights;
  c.integrator = b.integrator;
  c.samples_per_cell = b.samples_per_cell;
  c.supersampling = b.supersampling;
  c.azimuth = b.azimuth;
  c.elevation = b.elevation;
  c.roll = b.roll;
  c.zoom = b.zoom;
  c.pan = b.pan;
  c.projection = b.projection;
  c.field_of_view = b.field_of_view;
  c.surface = b.surface;
  c.xray = b.xray;
  c.havs = b.havs;
  c.volume.color_map = b.volume.color_map;
  c.volume.alpha_length = b.volume.alpha_length;
  if (b.mode == Mode::volume_surface) c.volume.color_map = a.volume.color_map;  // of a field that is shown
  return c == b;
}

RenderWorker::RenderWorker(QObject* parent) : QObject(parent) {
  qRegisterMetaType<std::shared_ptr<const WorkerPicture>>();
  thread_ = std::thread([this] { run(); });
}

RenderWorker::~RenderWorker() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    next_.reset();
    if (current_ != nullptr) current_->request_cancel();
  }
  wake_.notify_all();
  thread_.join();
}

void RenderWorker::draw(RenderOrder order) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(order);
    if (current_ != nullptr && shown_) current_->request_cancel();
  }
  wake_.notify_all();
}

void RenderWorker::stop() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  if (current_ != nullptr) current_->request_cancel();
}

void RenderWorker::run() {
  // Threads that this one starts for its parallel loops inherit it. That it cannot be done harms nothing.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
  for (;;) {
    Progress progress;
    RenderOrder order;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return quit_ || next_.has_value(); });
      if (quit_) return;
      order = std::move(*next_);
      next_.reset();
      current_ = &progress;
      shown_ = false;
    }
    try {
      work_on(order, progress);
    } catch (const CancelledError&) {
    } catch (const std::bad_alloc&) {
      emit failed(tr("not enough memory for this picture; make the window smaller or switch the mode"));
    } catch (const std::exception& error) {
      emit failed(QString::fromUtf8(error.what()));
    }
    bool nothing_left = false;
    {
      const std::lock_guard lock(mutex_);
      current_ = nullptr;
      nothing_left = !next_.has_value();
    }
    if (nothing_left) emit idle();
  }
}

std::shared_ptr<const Scene> RenderWorker::scene_of(const RenderOrder& order, double& ms, Progress& progress) {
  if (scene_ && scene_material_ == order.material && same_scene(scene_parameters_, order.parameters)) {
    ms = 0.0;
    return scene_;
  }
  scene_.reset();
  ms_per_pixel_ = -1.0;
  const auto start = std::chrono::steady_clock::now();
  // It borrows from the material, which stays for as long as the scene does.
  struct Held {
    std::shared_ptr<const Material> material;
    Scene scene;
  };
  const auto held =
      std::make_shared<const Held>(Held{order.material, make_scene(*order.material, order.parameters, progress)});
  scene_ = std::shared_ptr<const Scene>(held, &held->scene);
  scene_material_ = order.material;
  scene_parameters_ = order.parameters;
  ms = ms_since(start);
  return scene_;
}

int RenderWorker::coarse_levels(const RenderOrder& order) const {
  if (ms_per_pixel_ < 0.0) return 1;
  const double rays = order.parameters.supersampling * order.parameters.supersampling;
  const double expected = ms_per_pixel_ * rays * order.width * order.height;
  if (expected < an_instant) return 0;
  return expected < a_moment ? 1 : expected < a_while ? 3 : 7;
}

void RenderWorker::work_on(const RenderOrder& order, Progress& progress) {
  WorkerPicture drawn;
  drawn.number = order.number;
  drawn.material = order.material;
  drawn.scene = scene_of(order, drawn.scene_ms, progress);
  drawn.parameters = order.parameters;
  drawn.camera = make_camera(order.parameters, drawn.scene->bounds, order.width, order.height);
  const auto show = [this, &drawn] {
    emit picture(std::make_shared<const WorkerPicture>(drawn));
    const std::lock_guard lock(mutex_);
    shown_ = true;
    if (next_ && current_ != nullptr) current_->request_cancel();
  };
  if (order.scene_only) {
    show();
    return;
  }
  const Renderer& renderer = find_renderer("auto");
  const bool xray = order.parameters.mode == Mode::xray;
  std::vector<float> thickness;
  Channels channels;
  if (xray) channels.thickness = &thickness;
  const auto thickest = [&thickness] {
    return thickness.empty() ? 0.0 : static_cast<double>(*std::max_element(thickness.begin(), thickness.end()));
  };
  const auto start = std::chrono::steady_clock::now();
  const int coarse = coarse_levels(order);
  if (coarse == 0) {
    const Image image = render(renderer, *drawn.scene, drawn.camera, order.parameters, drawn.stats, channels, progress);
    drawn.ms = ms_since(start);
    drawn.image = to_qimage(image);
    drawn.max_thickness = thickest();
    show();
  } else {
    const auto show_level = [&](const ProgressivePicture& level) {
      // The last is shown below, when its channels are there.
      if (level.complete()) return;
      drawn.image = to_qimage(level.image);
      drawn.level = level.level;
      drawn.levels = level.levels;
      drawn.ms = level.ms;
      show();
    };
    const ProgressivePicture whole =
        render_progressively(renderer, *drawn.scene, drawn.camera, order.parameters, {8, std::nullopt, coarse},
                             drawn.stats, channels, show_level, progress);
    drawn.image = to_qimage(whole.image);
    drawn.level = whole.level;
    drawn.levels = whole.levels;
    drawn.ms = whole.ms;
    drawn.max_thickness = thickest();
    show();
  }
  // Coarse pictures on the way are in it: at worst the next is expected to take longer than it will.
  const double rays = order.parameters.supersampling * order.parameters.supersampling;
  ms_per_pixel_ = drawn.ms / (rays * order.width * order.height);
}

}  // namespace atomesh::gui
