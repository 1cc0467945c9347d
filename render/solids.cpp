#include "render/solids.h"

#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t rows_together = 8;

class SolidsFrame final : public Frame {
 public:
  SolidsFrame(std::unique_ptr<Frame> volume, std::unique_ptr<Frame> solids, const PixelWindow& window)
      : volume_(std::move(volume)), solids_(std::move(solids)), window_(window) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    // The listener hears of the solids as the first third.
    Image behind(window_.width, window_.height);
    std::vector<float> depth;
    Channels of_solids;
    of_solids.depth = &depth;
    Progress first(progress, 0.0, 0.3);
    solids_->draw(lattice, behind, stats, of_solids, first);
    Channels of_volume = channels;
    of_volume.ray_end = &depth;
    Progress second(progress, 0.3, 1.0);
    volume_->draw(lattice, image, stats, of_volume, second);
    const LatticeGrid grid(lattice, window_);
    parallel_for(static_cast<std::size_t>(grid.rows()), rows_together, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        for (int i = 0; i < grid.columns(); ++i) {
          const std::size_t pixel = window_.place(grid.column(i), grid.row(static_cast<int>(j)));
          Vec4f& front = image.pixels[pixel];
          front += (1.0F - front.a) * behind.pixels[pixel];
        }
      }
    });
  }

 private:
  std::unique_ptr<Frame> volume_;
  std::unique_ptr<Frame> solids_;
  PixelWindow window_;
};

}  // namespace

std::unique_ptr<Frame> with_solids(std::unique_ptr<Frame> volume, const Renderer& renderer, const Scene& scene,
                                   const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                                   RenderStats& stats, Progress& progress) {
  if (scene.solids == nullptr) return volume;
  return std::make_unique<SolidsFrame>(
      std::move(volume), renderer.prepare(*scene.solids, camera, parameters, window, stats, progress), window);
}

}  // namespace atomesh
