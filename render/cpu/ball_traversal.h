// Which balls the rays of a tile of the picture meet: two ways to find them, one answer. Both only propose; whether,
// where and in what order a ray meets a ball is decided by the double of render/shared/ball_ray.h.
#pragma once

#include <memory>
#include <vector>

#include "core/progress.h"
#include "render/cpu/ball_hits.h"
#include "render/pixel_lattice.h"
#include "render/scene.h"
#include "render/shared/ball_ray.h"

namespace atomesh {

// The rays of a lattice's pixels in a square of the window, cut off at the window's right and lower edge. Squares are
// counted from the window's corner.
struct BallTile {
  static constexpr int side = 16;  // pixels of the picture

  int column = 0;  // of the square among the window's
  int row = 0;
  LatticeGrid grid;                   // its pixels
  std::vector<optics::BallRay> rays;  // of pixel (i, j) of the grid at side · j + i
  std::vector<BallHits> hits;

  explicit BallTile(double least_light)
      : grid(PixelLattice{}, 0, 0, 0, 0),
        rays(static_cast<std::size_t>(side * side)),
        hits(static_cast<std::size_t>(side * side), BallHits(least_light)) {}
  static std::size_t place(int i, int j) { return static_cast<std::size_t>(side * j + i); }
  // Moves the tile: rays of the camera, no hits.
  void aim(const Scene& scene, const Camera& camera, const PixelWindow& window, const PixelLattice& lattice,
           int tile_column, int tile_row);
};

class BallTraversal {
 public:
  virtual ~BallTraversal() = default;
  // Fills tile.hits. May be called by several threads, each with its own tile.
  virtual void trace(BallTile& tile) const = 0;
};

// Balls sorted into the tiles their outlines cover, nearest first; a tile is done when no ray of it sees further.
// Costs a few passes over the balls and nothing to build. Null where balls would have to be entered in more than
// `most_entries` tiles altogether: so large, and so many in front of one another, that most of that is waste. Only what
// may be seen in the window is entered. Throws CancelledError.
std::unique_ptr<BallTraversal> project_balls(const Scene& scene, const Camera& camera, const PixelWindow& window,
                                             std::size_t most_entries, const Progress& progress);

// A bounding-volume hierarchy of spheres (Embree). Throws UnavailableError when Embree cannot start or runs out of
// memory.
std::unique_ptr<BallTraversal> build_ball_hierarchy(const Scene& scene);

}  // namespace atomesh
