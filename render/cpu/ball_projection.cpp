#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "render/cpu/ball_traversal.h"

namespace atomesh {

namespace {

// Pixels of the window whose rays may meet a ball, inclusive; and how near it can be met, rounded down.
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
  Projector(const Scene& scene, const Camera& camera, const PixelWindow& window)
      : camera_(camera), window_(window), eye_(camera.eye - scene.center) {}

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
      outline = {window_.left, window_.left + window_.width - 1, window_.top, window_.top + window_.height - 1,
                 outline.nearest};
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
  static int clamped(double pixel, int first, int size) {
    return static_cast<int>(std::clamp(pixel, first - 1.0, first + size + 0.0));
  }
  // The first and last pixel whose centre lies between the two, one thousandth of a pixel generously.
  void set_columns(Outline& outline, double low, double high) const {
    const double shift = 0.5 * camera_.width - 0.5;
    const auto column = [this](double at) { return clamped(at, window_.left, window_.width); };
    outline.left = std::max(window_.left, column(std::ceil(low / camera_.pixel + shift - 1e-3)));
    outline.right = std::min(window_.left + window_.width - 1, column(std::floor(high / camera_.pixel + shift + 1e-3)));
  }
  void set_rows(Outline& outline, double low, double high) const {
    const double shift = 0.5 * camera_.height - 0.5;
    const auto row = [this](double at) { return clamped(at, window_.top, window_.height); };
    outline.top = std::max(window_.top, row(std::ceil(shift - high / camera_.pixel - 1e-3)));
    outline.bottom = std::min(window_.top + window_.height - 1, row(std::floor(shift - low / camera_.pixel + 1e-3)));
  }

  const Camera& camera_;
  PixelWindow window_;
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
  ProjectedBalls(const Scene& scene, const PixelWindow& window)
      : scene_(scene),
        window_(window),
        tile_columns_((window.width + BallTile::side - 1) / BallTile::side),
        tiles_(static_cast<std::size_t>(tile_columns_) *
               static_cast<std::size_t>((window.height + BallTile::side - 1) / BallTile::side)) {}

  bool enter_balls(const Camera& camera, std::size_t most_entries, const Progress& progress) {
    const std::size_t count = scene_.balls.size();
    outlines_.resize(count);
    // Ranges of balls count and then enter by themselves; a tile's list is made of theirs in order.
    const std::size_t ranges = std::clamp<std::size_t>(count / 4096, 1, 64);
    const auto first_of = [count, ranges](std::size_t range) { return count * range / ranges; };
    std::vector<std::size_t> next(ranges * tiles_, 0);
    const Projector projector(scene_, camera, window_);
    parallel_for(ranges, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t range = begin; range < end; ++range) {
        progress.check();
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
        progress.check();
        for (std::size_t i = first_of(range); i < first_of(range + 1); ++i) {
          const Entry entry = entry_of(outlines_[i].nearest, i);
          for_each_tile(outlines_[i], [&](std::size_t tile) { entries_[next[range * tiles_ + tile]++] = entry; });
        }
      }
    });
    return true;
  }

  void trace(BallTile& tile) const override {
    const auto index = static_cast<std::size_t>(tile.row) * static_cast<std::size_t>(tile_columns_) +
                       static_cast<std::size_t>(tile.column);
    std::vector<Entry> nearest_last;
    nearest_last.reserve(begin_[index + 1] - begin_[index]);
    for (std::size_t at = begin_[index]; at < begin_[index + 1]; ++at) {
      if (!pixels_under(outlines_[ball_of(entries_[at])], tile).empty()) nearest_last.push_back(entries_[at]);
    }
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
    const int last_row = (outline.bottom - window_.top) / BallTile::side;
    const int last_column = (outline.right - window_.left) / BallTile::side;
    for (int row = (outline.top - window_.top) / BallTile::side; row <= last_row; ++row) {
      for (int column = (outline.left - window_.left) / BallTile::side; column <= last_column; ++column) {
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_columns_) +
              static_cast<std::size_t>(column));
      }
    }
  }

  // Of the tile's grid, ends included.
  struct GridBox {
    int first_i, last_i, first_j, last_j;
    bool empty() const { return first_i > last_i || first_j > last_j; }
  };
  static GridBox pixels_under(const Outline& outline, const BallTile& tile) {
    const LatticeGrid& grid = tile.grid;
    return {grid.first_i(outline.left), grid.last_i(outline.right), grid.first_j(outline.top),
            grid.last_j(outline.bottom)};
  }

  void meet(BallTile& tile, Index index) const {
    const Ball& ball = scene_.balls[index];
    const GridBox box = pixels_under(outlines_[index], tile);
    for (int j = box.first_j; j <= box.last_j; ++j) {
      for (int i = box.first_i; i <= box.last_i; ++i) {
        const std::size_t at = BallTile::place(i, j);
        const double length = optics::length_to_ball(tile.rays[at], ball);
        if (length <= tile.hits[at].reach() && std::isfinite(length)) {
          tile.hits[at].add(length, index, static_cast<double>(ball.color.a));
        }
      }
    }
  }

  static double furthest_reach(const BallTile& tile) {
    double furthest = 0.0;
    for (int j = 0; j < tile.grid.rows(); ++j) {
      for (int i = 0; i < tile.grid.columns(); ++i) {
        furthest = std::max(furthest, tile.hits[BallTile::place(i, j)].reach());
      }
    }
    return furthest;
  }

  const Scene& scene_;
  PixelWindow window_;
  int tile_columns_;
  std::size_t tiles_;
  std::vector<Outline> outlines_;
  std::vector<std::size_t> begin_;  // of each tile's entries
  std::vector<Entry> entries_;
};

}  // namespace

void BallTile::aim(const Scene& scene, const Camera& camera, const PixelWindow& window, const PixelLattice& lattice,
                   int tile_column, int tile_row) {
  column = tile_column;
  row = tile_row;
  const int left = window.left + tile_column * side;
  const int top = window.top + tile_row * side;
  grid = LatticeGrid(lattice, left, std::min(left + side, window.left + window.width), top,
                     std::min(top + side, window.top + window.height));
  for (int j = 0; j < grid.rows(); ++j) {
    for (int i = 0; i < grid.columns(); ++i) {
      rays[place(i, j)] = optics::ball_ray(scene, camera, grid.column(i), grid.row(j));
      hits[place(i, j)].clear();
    }
  }
}

std::unique_ptr<BallTraversal> project_balls(const Scene& scene, const Camera& camera, const PixelWindow& window,
                                             std::size_t most_entries, const Progress& progress) {
  auto projection = std::make_unique<ProjectedBalls>(scene, window);
  if (!projection->enter_balls(camera, most_entries, progress)) return nullptr;
  return projection;
}

}  // namespace atomesh
