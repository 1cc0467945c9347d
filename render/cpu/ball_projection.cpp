#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "render/cpu/ball_traversal.h"

namespace atomesh {

namespace {

// Pixels whose rays may meet a ball, inclusive; and how near it can be met, rounded down.
struct Outline {
  int left = 0;
  int right = -1;
  int top = 0;
  int bottom = -1;
  float nearest = 0.0F;

  bool empty() const { return left > right || top > bottom; }
};

// Slopes x/z between which the lines through the origin meet the circle of radius r about (x, z), z > r: those of the
// two tangents. Dividing by (z-r)(z+r) keeps a circle that nearly touches the eye's plane from overflowing to nonsense.
std::array<double, 2> tangent_slopes(double x, double z, double r) {
  const double root = r * std::sqrt(std::max(0.0, x * x + (z - r) * (z + r)));
  const double scale = 1.0 / ((z - r) * (z + r));
  return {(x * z - root) * scale, (x * z + root) * scale};
}

class Projector {
 public:
  Projector(const Scene& scene, const Camera& camera) : camera_(camera), eye_(camera.eye - scene.center) {}

  Outline outline_of(const Ball& ball) const {
    const Vec3 p = Vec3(ball.center) - eye_;
    const double x = glm::dot(p, camera_.right);
    const double y = glm::dot(p, camera_.up);
    const double z = glm::dot(p, camera_.forward);
    // Wider than the ball by far more than all rounding here: an outline too large costs nothing but a test.
    const double r = static_cast<double>(ball.radius) + 1e-9 * (glm::length(p) + static_cast<double>(ball.radius));
    const bool perspective = camera_.projection == Projection::perspective;
    Outline outline;
    outline.nearest = rounded_down((perspective ? glm::length(p) : z) - r);
    if (z + r <= 0.0) return outline;
    if (!perspective) {
      set_columns(outline, x - r, x + r);
      set_rows(outline, y - r, y + r);
    } else if (z - r <= 1e-6 * r) {
      outline = {0, camera_.width - 1, 0, camera_.height - 1, outline.nearest};
    } else {
      const auto across = tangent_slopes(x, z, r);
      const auto upward = tangent_slopes(y, z, r);
      set_columns(outline, across[0], across[1]);
      set_rows(outline, upward[0], upward[1]);
    }
    return outline;
  }

 private:
  static float rounded_down(double length) {
    if (length <= 0.0) return 0.0F;
    return std::max(0.0F, static_cast<float>(length * (1.0 - 1e-6)));
  }
  static int clamped(double pixel, int size) { return static_cast<int>(std::clamp(pixel, -1.0, size + 0.0)); }
  // The first and last pixel whose centre lies between the two, one thousandth of a pixel generously.
  void set_columns(Outline& outline, double low, double high) const {
    const double shift = 0.5 * camera_.width - 0.5;
    outline.left = std::max(0, clamped(std::ceil(low / camera_.pixel + shift - 1e-3), camera_.width));
    outline.right =
        std::min(camera_.width - 1, clamped(std::floor(high / camera_.pixel + shift + 1e-3), camera_.width));
  }
  void set_rows(Outline& outline, double low, double high) const {
    const double shift = 0.5 * camera_.height - 0.5;
    outline.top = std::max(0, clamped(std::ceil(shift - high / camera_.pixel - 1e-3), camera_.height));
    outline.bottom =
        std::min(camera_.height - 1, clamped(std::floor(shift - low / camera_.pixel + 1e-3), camera_.height));
  }

  const Camera& camera_;
  Vec3 eye_;
};

// A ball in a tile's list; ordered by how near it can be met (lengths are not negative, so their bits are in order),
// then by index.
using Entry = std::uint64_t;
Entry entry_of(float nearest, std::size_t ball) {
  return (static_cast<Entry>(std::bit_cast<std::uint32_t>(nearest)) << 32U) | static_cast<Entry>(ball);
}
Index ball_of(Entry entry) {
  return static_cast<Index>(entry & 0xFFFFFFFFU);
}
double nearest_of(Entry entry) {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32U)));
}

class ProjectedBalls final : public BallTraversal {
 public:
  ProjectedBalls(const Scene& scene, const Camera& camera)
      : scene_(scene),
        tile_columns_((camera.width + BallTile::side - 1) / BallTile::side),
        tiles_(static_cast<std::size_t>(tile_columns_) *
               static_cast<std::size_t>((camera.height + BallTile::side - 1) / BallTile::side)) {}

  bool enter_balls(const Camera& camera, std::size_t most_entries) {
    const std::size_t count = scene_.balls.size();
    outlines_.resize(count);
    // Ranges of balls count and then enter by themselves; a tile's list is made of theirs in order.
    const std::size_t ranges = std::clamp<std::size_t>(count / 4096, 1, 64);
    const auto first_of = [count, ranges](std::size_t range) { return count * range / ranges; };
    std::vector<std::size_t> next(ranges * tiles_, 0);
    const Projector projector(scene_, camera);
    parallel_for(ranges, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t range = begin; range < end; ++range) {
        for (std::size_t i = first_of(range); i < first_of(range + 1); ++i) {
          outlines_[i] = projector.outline_of(scene_.balls[i]);
          for_each_tile(outlines_[i], [&](std::size_t tile) { ++next[range * tiles_ + tile]; });
        }
      }
    });
    begin_.assign(tiles_ + 1, 0);
    std::size_t total = 0;
    for (std::size_t tile = 0; tile < tiles_; ++tile) {
      begin_[tile] = total;
      for (std::size_t range = 0; range < ranges; ++range) {
        const std::size_t here = next[range * tiles_ + tile];
        next[range * tiles_ + tile] = total;
        total += here;
      }
    }
    begin_[tiles_] = total;
    if (total > most_entries) return false;
    entries_.resize(total);
    parallel_for(ranges, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t range = begin; range < end; ++range) {
        for (std::size_t i = first_of(range); i < first_of(range + 1); ++i) {
          const Entry entry = entry_of(outlines_[i].nearest, i);
          for_each_tile(outlines_[i], [&](std::size_t tile) { entries_[next[range * tiles_ + tile]++] = entry; });
        }
      }
    });
    return true;
  }

  void trace(BallTile& tile) const override {
    const auto index = static_cast<std::size_t>(tile.top / BallTile::side) * static_cast<std::size_t>(tile_columns_) +
                       static_cast<std::size_t>(tile.left / BallTile::side);
    std::vector<Entry> nearest_last(entries_.begin() + static_cast<std::ptrdiff_t>(begin_[index]),
                                    entries_.begin() + static_cast<std::ptrdiff_t>(begin_[index + 1]));
    // Most entries are never looked at, so they are put in order only as far as the tile sees.
    std::make_heap(nearest_last.begin(), nearest_last.end(), std::greater<>());
    double reach = std::numeric_limits<double>::infinity();
    for (int taken = 1; !nearest_last.empty(); ++taken) {
      std::pop_heap(nearest_last.begin(), nearest_last.end(), std::greater<>());
      const Entry entry = nearest_last.back();
      nearest_last.pop_back();
      if (nearest_of(entry) > reach) return;
      meet(tile, ball_of(entry));
      if (taken % 8 == 0) reach = furthest_reach(tile);
    }
  }

 private:
  template <class Visit>
  void for_each_tile(const Outline& outline, Visit visit) const {
    if (outline.empty()) return;
    for (int row = outline.top / BallTile::side; row <= outline.bottom / BallTile::side; ++row) {
      for (int column = outline.left / BallTile::side; column <= outline.right / BallTile::side; ++column) {
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_columns_) +
              static_cast<std::size_t>(column));
      }
    }
  }

  void meet(BallTile& tile, Index index) const {
    const Ball& ball = scene_.balls[index];
    const Outline& outline = outlines_[index];
    const int right = std::min(outline.right, tile.left + tile.columns - 1);
    const int bottom = std::min(outline.bottom, tile.top + tile.rows - 1);
    for (int row = std::max(outline.top, tile.top); row <= bottom; ++row) {
      for (int column = std::max(outline.left, tile.left); column <= right; ++column) {
        const auto pixel = static_cast<std::size_t>((row - tile.top) * BallTile::side + column - tile.left);
        const double length = optics::length_to_ball(tile.rays[pixel], ball);
        if (length <= tile.hits[pixel].reach() && std::isfinite(length)) {
          tile.hits[pixel].add(length, index, static_cast<double>(ball.color.a));
        }
      }
    }
  }

  static double furthest_reach(const BallTile& tile) {
    double furthest = 0.0;
    for (int row = 0; row < tile.rows; ++row) {
      for (int column = 0; column < tile.columns; ++column) {
        furthest = std::max(furthest, tile.hits[static_cast<std::size_t>(row * BallTile::side + column)].reach());
      }
    }
    return furthest;
  }

  const Scene& scene_;
  int tile_columns_;
  std::size_t tiles_;
  std::vector<Outline> outlines_;
  std::vector<std::size_t> begin_;  // of each tile's entries
  std::vector<Entry> entries_;
};

}  // namespace

void BallTile::aim(const Scene& scene, const Camera& camera, int tile_column, int tile_row) {
  left = tile_column * side;
  top = tile_row * side;
  columns = std::min(side, camera.width - left);
  rows = std::min(side, camera.height - top);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto pixel = static_cast<std::size_t>(row * side + column);
      rays[pixel] = optics::ball_ray(scene, camera, left + column, top + row);
      hits[pixel].clear();
    }
  }
}

std::unique_ptr<BallTraversal> project_balls(const Scene& scene, const Camera& camera, std::size_t most_entries) {
  auto projection = std::make_unique<ProjectedBalls>(scene, camera);
  if (!projection->enter_balls(camera, most_entries)) return nullptr;
  return projection;
}

}  // namespace atomesh
