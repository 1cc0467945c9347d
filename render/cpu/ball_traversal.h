// Which balls the rays of a tile of the picture meet: two ways to find them, one answer. Both only propose; whether,
// where and in what order a ray meets a ball is decided by the double of render/shared/ball_ray.h.
#pragma once

#include <memory>
#include <vector>

#include "render/cpu/ball_hits.h"
#include "render/scene.h"
#include "render/shared/ball_ray.h"

namespace atomesh {

// A square of pixels, cut off at the picture's right and lower edge.
struct BallTile {
  static constexpr int side = 16;

  int left = 0;
  int top = 0;
  int columns = 0;
  int rows = 0;
  std::vector<optics::BallRay> rays;  // side × side, row-major from the top left
  std::vector<BallHits> hits;

  explicit BallTile(double least_light)
      : rays(static_cast<std::size_t>(side * side)),
        hits(static_cast<std::size_t>(side * side), BallHits(least_light)) {}
  // Moves the tile: rays of the camera, no hits.
  void aim(const Scene& scene, const Camera& camera, int tile_column, int tile_row);
};

class BallTraversal {
 public:
  virtual ~BallTraversal() = default;
  // Fills tile.hits. May be called by several threads, each with its own tile.
  virtual void trace(BallTile& tile) const = 0;
};

// Balls sorted into the tiles their outlines cover, nearest first; a tile is done when no ray of it sees further.
// Costs a few passes over the balls and nothing to build. Null where balls would have to be entered in more than
// `most_entries` tiles altogether: so large, and so many in front of one another, that most of that is waste.
std::unique_ptr<BallTraversal> project_balls(const Scene& scene, const Camera& camera, std::size_t most_entries);

// A bounding-volume hierarchy of spheres (Embree). Throws UnavailableError when Embree cannot start or runs out of
// memory.
std::unique_ptr<BallTraversal> build_ball_hierarchy(const Scene& scene);

}  // namespace atomesh
