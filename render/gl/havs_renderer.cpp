#include "render/gl/havs_renderer.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/cpu/cpu_renderer.h"
#include "render/gl/context.h"
#include "render/gl/volume.h"
#include "render/solids.h"

namespace atomesh {

namespace {

// Larger pictures are drawn in windows, which need no more than 100 MB of pixels each.
constexpr int window_side = 2048;

// The context with what is drawn in it; stays until the process ends, as drivers do.
class Card {
 public:
  static Card& get() {
    static std::mutex mutex;
    static Card* card = nullptr;
    const std::lock_guard lock(mutex);
    if (card == nullptr) card = new Card;
    return *card;
  }

  // Calls use(Volume) with the context current; `user` says whose scene it is, and whether it still is.
  template <class Use>
  void with_volume(const void* user, const Scene& scene, Use&& use) {
    const gl::HeadlessContext::Current current(context_);
    if (!volume_) volume_.emplace();
    if (user_ != user) {
      volume_->set_scene(scene);
      user_ = user;
    }
    use(*volume_);
  }

  void forget(const void* user) {
    const gl::HeadlessContext::Current current(context_);
    if (user_ == user) user_ = nullptr;
  }

 private:
  Card() = default;

  gl::HeadlessContext context_;
  std::optional<gl::Volume> volume_;
  const void* user_ = nullptr;
};

class HavsFrame final : public Frame {
 public:
  HavsFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window)
      : card_(Card::get()), scene_(scene), camera_(camera), parameters_(parameters), window_(window) {}
  ~HavsFrame() override { card_.forget(this); }

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    card_.with_volume(this, scene_, [&](gl::Volume& volume) {
      const int side = std::min(window_side, volume.largest_side());
      const auto along = [side](int length) { return (length + side - 1) / side; };
      const double share = 1.0 / std::max(1, along(window_.width) * along(window_.height));
      double begin = 0.0;
      for (int top = 0; top < window_.height; top += side) {
        for (int left = 0; left < window_.width; left += side) {
          const PixelWindow part{window_.left + left, window_.top + top, std::min(side, window_.width - left),
                                 std::min(side, window_.height - top)};
          Progress of_part(progress, begin, begin + share);
          begin += share;
          volume.draw(camera_, parameters_, part, lattice, stats, of_part, ray_ends(channels, part, lattice));
          const auto start = std::chrono::steady_clock::now();
          copy(volume.read(), LatticeGrid(lattice, part), image);
          stats.render_ms += ms_since(start);
        }
      }
    });
    progress.update(1.0);
  }

 private:
  // Of the lattice's pixels in the part.
  std::vector<float> ray_ends(const Channels& channels, const PixelWindow& part, const PixelLattice& lattice) const {
    std::vector<float> ends;
    if (channels.ray_end == nullptr) return ends;
    const LatticeGrid grid(lattice, part);
    ends.reserve(grid.pixels());
    for (int j = 0; j < grid.rows(); ++j) {
      for (int i = 0; i < grid.columns(); ++i) {
        ends.push_back((*channels.ray_end)[window_.place(grid.column(i), grid.row(j))]);
      }
    }
    return ends;
  }

  void copy(const Image& drawn, const LatticeGrid& grid, Image& image) const {
    for (int j = 0; j < drawn.height; ++j) {
      for (int i = 0; i < drawn.width; ++i) {
        image.pixels[window_.place(grid.column(i), grid.row(j))] = drawn.at(i, j);
      }
    }
  }

  Card& card_;
  const Scene& scene_;
  const Camera& camera_;
  const Parameters& parameters_;
  const PixelWindow window_;
};

class HavsRenderer final : public Renderer {
 public:
  std::string_view name() const override { return "havs"; }

  std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                 const PixelWindow& window, RenderStats& stats, Progress& progress) const override {
    if (scene.mode != Mode::volume) {
      throw UsageError("renderer \"havs\": draws the mode volume only; \"cpu\" draws the mode " +
                       std::string(mode_name(scene.mode)));
    }
    progress.stage("render");
    // What stands in the volume is the CPU's, whose pictures are the same.
    return with_solids(std::make_unique<HavsFrame>(scene, camera, parameters, window), cpu_renderer(), scene, camera,
                       parameters, window, stats, progress);
  }
};

}  // namespace

const Renderer& havs_renderer() {
  static const HavsRenderer renderer;
  return renderer;
}

}  // namespace atomesh
