#include "render/cpu/atom_balls.h"

#include <atomic>
#include <chrono>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/cpu/ball_traversal.h"
#include "render/shared/lights.h"
#include "render/shared/materials.h"

namespace atomesh {

namespace {

using Clock = std::chrono::steady_clock;

std::unique_ptr<BallTraversal> make_traversal(const Scene& scene, const Camera& camera, const PixelWindow& window,
                                              BallSearch search, const Progress& progress) {
  if (search != BallSearch::hierarchy) {
    const std::size_t most =
        search == BallSearch::projection ? std::numeric_limits<std::size_t>::max() : most_projected_entries;
    if (auto projection = project_balls(scene, camera, window, most, progress)) return projection;
  }
  return build_ball_hierarchy(scene);
}

// Composed front to back, premultiplied.
Vec4f shade(const Scene& scene, const std::vector<optics::LightRay>& lights, const optics::BallRay& ray,
            const std::vector<BallHits::Hit>& hits) {
  Vec3f color(0.0F);
  float left = 1.0F;
  for (const BallHits::Hit& hit : hits) {
    const Ball& ball = scene.balls[hit.ball];
    const Vec3 point = ray.origin + hit.length * ray.direction;
    const Vec3f normal(glm::normalize(point - Vec3(ball.center)));
    const Vec3f lit = optics::phong(optics::ball_material(Vec3f(ball.color)), Vec3f(point), normal,
                                    Vec3f(-ray.direction), lights.data(), static_cast<int>(lights.size()));
    color += left * ball.color.a * lit;
    left *= 1.0F - ball.color.a;
  }
  return {color, 1.0F - left};
}

class AtomBallFrame final : public Frame {
 public:
  AtomBallFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                std::unique_ptr<BallTraversal> traversal)
      : scene_(scene),
        camera_(camera),
        window_(window),
        lights_(optics::scene_lights(parameters, scene, camera)),
        traversal_(std::move(traversal)) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    const Clock::time_point start = Clock::now();
    size_channel(channels.depth, window_, std::numeric_limits<float>::infinity());
    size_channel(channels.id, window_, no_index);
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::size_t> done{0};
    const int tile_columns = (window_.width + BallTile::side - 1) / BallTile::side;
    const auto tile_rows = static_cast<std::size_t>((window_.height + BallTile::side - 1) / BallTile::side);
    parallel_for(tile_rows, 1, [&](std::size_t tile_row, std::size_t) {
      BallTile tile(faintest);
      std::uint64_t composed = 0;
      for (int tile_column = 0; tile_column < tile_columns; ++tile_column) {
        progress.check();
        tile.aim(scene_, camera_, window_, lattice, tile_column, static_cast<int>(tile_row));
        if (tile.grid.empty()) continue;
        if (traversal_) traversal_->trace(tile);
        composed += shade_tile(tile, image, channels);
      }
      steps += composed;
      const std::size_t finished = ++done;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0) progress.update(static_cast<double>(finished) / static_cast<double>(tile_rows));
    });
    progress.update(1.0);
    stats.steps += steps;
    stats.render_ms += ms_since(start);
  }

 private:
  // Returns the number of balls composed.
  std::uint64_t shade_tile(const BallTile& tile, Image& image, const Channels& channels) const {
    std::uint64_t composed = 0;
    for (int j = 0; j < tile.grid.rows(); ++j) {
      for (int i = 0; i < tile.grid.columns(); ++i) {
        const std::vector<BallHits::Hit>& hits = tile.hits[BallTile::place(i, j)].hits();
        const optics::BallRay& ray = tile.rays[BallTile::place(i, j)];
        const std::size_t pixel = window_.place(tile.grid.column(i), tile.grid.row(j));
        const bool any = !hits.empty();
        image.pixels[pixel] = any ? shade(scene_, lights_, ray, hits) : Vec4f(0.0F);
        composed += hits.size();
        if (channels.depth != nullptr) {
          (*channels.depth)[pixel] =
              any ? static_cast<float>(hits.front().length * glm::dot(ray.direction, camera_.forward))
                  : std::numeric_limits<float>::infinity();
        }
        if (channels.id != nullptr) (*channels.id)[pixel] = any ? scene_.balls[hits.front().ball].atom : no_index;
      }
    }
    return composed;
  }

  const Scene& scene_;
  const Camera& camera_;
  PixelWindow window_;
  std::vector<optics::LightRay> lights_;
  std::unique_ptr<BallTraversal> traversal_;  // null where there is no ball
};

}  // namespace

std::unique_ptr<Frame> prepare_atom_balls(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                          const PixelWindow& window, RenderStats& stats, const Progress& progress,
                                          BallSearch search) {
  const Clock::time_point start = Clock::now();
  std::unique_ptr<BallTraversal> traversal;
  if (!scene.balls.empty()) traversal = make_traversal(scene, camera, window, search, progress);
  auto frame = std::make_unique<AtomBallFrame>(scene, camera, parameters, window, std::move(traversal));
  stats.setup_ms += ms_since(start);
  return frame;
}

}  // namespace atomesh
