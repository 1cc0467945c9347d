#include "render/cpu/atom_balls.h"

#include <atomic>
#include <chrono>

#include "core/parallel.h"
#include "render/cpu/ball_traversal.h"
#include "render/shared/lights.h"
#include "render/shared/materials.h"

namespace atomesh {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::unique_ptr<BallTraversal> make_traversal(const Scene& scene, const Camera& camera, BallSearch search) {
  if (search != BallSearch::hierarchy) {
    const std::size_t most =
        search == BallSearch::projection ? std::numeric_limits<std::size_t>::max() : most_projected_entries;
    if (auto projection = project_balls(scene, camera, most)) return projection;
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

}  // namespace

Image draw_atom_balls(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                      const Channels& channels, Progress& progress, BallSearch search) {
  progress.stage("atom balls");
  Image image(camera.width, camera.height);
  if (channels.depth != nullptr) channels.depth->assign(image.pixels.size(), std::numeric_limits<float>::infinity());
  if (channels.id != nullptr) channels.id->assign(image.pixels.size(), no_index);
  stats = {};
  if (scene.balls.empty()) return image;

  const Clock::time_point building = Clock::now();
  const std::vector<optics::LightRay> lights = optics::scene_lights(parameters, scene, camera);
  const std::unique_ptr<BallTraversal> traversal = make_traversal(scene, camera, search);
  stats.setup_ms = ms_since(building);

  const Clock::time_point drawing = Clock::now();
  std::atomic<std::uint64_t> steps{0};
  const int tile_columns = (camera.width + BallTile::side - 1) / BallTile::side;
  const int tile_rows = (camera.height + BallTile::side - 1) / BallTile::side;
  parallel_for(static_cast<std::size_t>(tile_rows), 1, [&](std::size_t begin, std::size_t end) {
    progress.check();
    BallTile tile(faintest);
    std::uint64_t composed = 0;
    for (std::size_t t = begin * static_cast<std::size_t>(tile_columns);
         t < end * static_cast<std::size_t>(tile_columns); ++t) {
      tile.aim(scene, camera, static_cast<int>(t) % tile_columns, static_cast<int>(t) / tile_columns);
      traversal->trace(tile);
      for (int row = 0; row < tile.rows; ++row) {
        for (int column = 0; column < tile.columns; ++column) {
          const auto in_tile = static_cast<std::size_t>(row * BallTile::side + column);
          const std::vector<BallHits::Hit>& hits = tile.hits[in_tile].hits();
          if (hits.empty()) continue;
          const optics::BallRay& ray = tile.rays[in_tile];
          const auto pixel = static_cast<std::size_t>(tile.top + row) * static_cast<std::size_t>(camera.width) +
                             static_cast<std::size_t>(tile.left + column);
          image.pixels[pixel] = shade(scene, lights, ray, hits);
          composed += hits.size();
          if (channels.depth != nullptr) {
            (*channels.depth)[pixel] =
                static_cast<float>(hits.front().length * glm::dot(ray.direction, camera.forward));
          }
          if (channels.id != nullptr) (*channels.id)[pixel] = scene.balls[hits.front().ball].atom;
        }
      }
    }
    steps += composed;
  });
  stats.render_ms = ms_since(drawing);
  stats.steps = steps;
  progress.update(1.0);
  return image;
}

}  // namespace atomesh
