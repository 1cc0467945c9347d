#include "preprocess/neighbour_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/within_64.h"

namespace atomesh {

namespace {

constexpr std::uint64_t no_key = ~std::uint64_t{0};
// Cells an axis may have: three cell numbers fit one key, and their product never overflows.
constexpr std::int64_t most_cells = std::int64_t{1} << 20;
constexpr double border = 1e-9;
// Points worked on between two looks at a cancel.
constexpr std::size_t piece = std::size_t{1} << 16;

std::uint64_t spread(std::uint64_t key) {
  key *= 0x9E3779B97F4A7C15ULL;
  return key ^ key >> 29;
}

struct Run {
  const double* x;
  const double* y;
  const double* z;
  std::size_t count;
};

// Writes first + n for every place n of the run within √limit of the centre; returns how many.
std::size_t within(const Run& run, const Vec3& centre, double limit, Index first, Index* out) {
  constexpr std::size_t block = 64;
  std::array<double, block> distance2;
  std::size_t found = 0;
  for (std::size_t begin = 0; begin < run.count; begin += block) {
    const std::size_t count = std::min(block, run.count - begin);
    for (std::size_t n = 0; n < count; ++n) {
      const double dx = run.x[begin + n] - centre.x;
      const double dy = run.y[begin + n] - centre.y;
      const double dz = run.z[begin + n] - centre.z;
      distance2[n] = dx * dx + dy * dy + dz * dz;
    }
    // Every place is written and only kept ones advance: no branch that the processor could guess wrong.
    for (std::size_t n = 0; n < count; ++n) {
      out[found] = first + static_cast<Index>(begin + n);
      found += distance2[n] <= limit ? 1 : 0;
    }
  }
  return found;
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

NeighbourGrid::NeighbourGrid(std::span<const Vec3> points, const Box& box, double reach, double cell,
                             Progress& progress)
    : periodic_(box.any_periodic()), box_(box), edge_(cell) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!finite(points[i])) throw Error("atom " + std::to_string(i + 1) + " has a position that is not finite");
  }
  if (periodic_) {
    const double volume = std::abs(box.volume());
    const double product = glm::length(box.vectors[0]) * glm::length(box.vectors[1]) * glm::length(box.vectors[2]);
    if (!(volume > 1e-9 * product) || !std::isfinite(product)) {
      throw Error("the box is periodic but its vectors span no volume; give three independent vectors");
    }
    to_fraction_ = glm::inverse(box.matrix());
  }
  wrap_points(points, progress);
  if (periodic_) add_images(points.size(), reach, progress);
  sort_into_cells(points.size(), progress);
}

void NeighbourGrid::wrap_points(std::span<const Vec3> points, Progress& progress) {
  x_.resize(points.size());
  y_.resize(points.size());
  z_.resize(points.size());
  point_.resize(points.size());
  parallel_for(points.size(), piece, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 q = wrap(points[i]);
      x_[i] = q.x;
      y_[i] = q.y;
      z_[i] = q.z;
      point_[i] = static_cast<Index>(i);
    }
  });
}

Vec3 NeighbourGrid::wrap(const Vec3& p) const {
  if (!periodic_) return p;
  const Vec3 fraction = to_fraction_ * (p - box_.origin);
  Vec3 wrapped = p;
  for (int k = 0; k < 3; ++k) {
    if (box_.periodic[k]) wrapped -= std::floor(fraction[k] + border) * box_.vectors[k];
  }
  return wrapped;
}

Vec3 NeighbourGrid::nearest_image(const Vec3& d) const {
  if (!periodic_) return d;
  const Vec3 fraction = to_fraction_ * d;
  Vec3 nearest = d;
  for (int k = 0; k < 3; ++k) {
    if (box_.periodic[k]) nearest -= std::round(fraction[k]) * box_.vectors[k];
  }
  return nearest;
}

void NeighbourGrid::add_images(std::size_t points, double reach, Progress& progress) {
  std::array<double, 3> margin{0, 0, 0};  // reach as a fraction of the box's width between its faces
  std::array<int, 3> images{0, 0, 0};
  double count = 1.0;
  for (int k = 0; k < 3; ++k) {
    if (!box_.periodic[k]) continue;
    // Rows of the inverse are the reciprocal vectors; their length is one over the distance of the faces.
    margin[k] = reach * glm::length(Vec3(to_fraction_[0][k], to_fraction_[1][k], to_fraction_[2][k])) + 2 * border;
    count *= 2.0 * std::ceil(margin[k]) + 1.0;
    if (!(count < 100000.0)) {
      throw Error("the periodic box is too thin for a neighbourhood of " + std::to_string(reach) +
                  " Å; repeat it along its short axes");
    }
    images[k] = static_cast<int>(std::ceil(margin[k]));
  }
  struct Image {
    Vec3 place;
    Index point;
  };
  // Most points are far from every face and have none.
  std::vector<std::vector<Image>> pieces((points + piece - 1) / piece);
  parallel_for(points, piece, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Image>& found = pieces[begin / piece];
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 home(x_[i], y_[i], z_[i]);
      const Vec3 fraction = to_fraction_ * (home - box_.origin);
      std::array<std::array<int, 2>, 3> shifts{};
      bool inner = true;
      for (int k = 0; k < 3; ++k) {
        if (!box_.periodic[k]) continue;
        // Shifted fractions from -margin to 1 + margin.
        shifts[k] = {std::max(-images[k], static_cast<int>(std::ceil(-margin[k] - fraction[k]))),
                     std::min(images[k], static_cast<int>(std::floor(1.0 + margin[k] - fraction[k])))};
        inner = inner && shifts[k][0] == 0 && shifts[k][1] == 0;
      }
      if (inner) continue;
      for (int a = shifts[0][0]; a <= shifts[0][1]; ++a) {
        for (int b = shifts[1][0]; b <= shifts[1][1]; ++b) {
          for (int c = shifts[2][0]; c <= shifts[2][1]; ++c) {
            if (a == 0 && b == 0 && c == 0) continue;
            found.push_back({home + static_cast<double>(a) * box_.vectors[0] +
                                 static_cast<double>(b) * box_.vectors[1] + static_cast<double>(c) * box_.vectors[2],
                             static_cast<Index>(i)});
          }
        }
      }
    }
  });
  std::size_t slots = points;
  for (const std::vector<Image>& found : pieces) slots += found.size();
  if (slots >= no_index) throw UnavailableError("too many atoms with their periodic images: over 2^32 - 2");
  x_.reserve(slots);
  y_.reserve(slots);
  z_.reserve(slots);
  point_.reserve(slots);
  for (std::vector<Image>& found : pieces) {
    for (const Image& image : found) {
      x_.push_back(image.place.x);
      y_.push_back(image.place.y);
      z_.push_back(image.place.z);
      point_.push_back(image.point);
    }
    found = {};
    progress.check();
  }
}

std::array<std::int64_t, 3> NeighbourGrid::cell_of(const Vec3& p) const {
  std::array<std::int64_t, 3> cell;
  for (int k = 0; k < 3; ++k) cell[k] = std::min(static_cast<std::int64_t>((p[k] - min_[k]) / edge_), cells_[k] - 1);
  return cell;
}

void NeighbourGrid::sort_into_cells(std::size_t points, Progress& progress) {
  const std::size_t slots = point_.size();
  Bounds bounds;
  for (std::size_t s = 0; s < slots; ++s) bounds.add(Vec3(x_[s], y_[s], z_[s]));
  home_.clear();
  if (slots == 0) {
    start_.assign(2, 0);
    return;
  }
  min_ = bounds.min;
  const Vec3 extent = bounds.extent();
  edge_ = std::max({edge_, extent.x / static_cast<double>(most_cells - 2),
                    extent.y / static_cast<double>(most_cells - 2), extent.z / static_cast<double>(most_cells - 2)});
  for (int k = 0; k < 3; ++k) cells_[k] = static_cast<std::int64_t>(extent[k] / edge_) + 1;
  const auto key_of = [&](std::size_t s) {
    const auto [x, y, z] = cell_of({x_[s], y_[s], z_[s]});
    return static_cast<std::uint64_t>((z * cells_[1] + y) * cells_[0] + x);
  };
  const auto in_pieces = [&](std::size_t count, auto&& body) {
    for (std::size_t begin = 0; begin < count; begin += piece) {
      progress.check();
      for (std::size_t s = begin; s < std::min(begin + piece, count); ++s) body(s);
    }
  };
  // order[n] is the old slot that becomes slot n; equal keys keep their order.
  std::vector<Index> order(slots);
  const std::uint64_t all = static_cast<std::uint64_t>(cells_[0] * cells_[1] * cells_[2]);
  if (all <= 8 * slots + 32768) {
    // Keys fit 32 bits here.
    std::vector<std::uint32_t> key(slots);
    parallel_for(slots, piece, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t s = begin; s < end; ++s) key[s] = static_cast<std::uint32_t>(key_of(s));
    });
    start_.assign(all + 1, 0);
    in_pieces(slots, [&](std::size_t s) { ++start_[key[s] + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    // start_[k] runs through cell k's slots and ends where cell k + 1's begin: one place on.
    in_pieces(slots, [&](std::size_t s) { order[start_[key[s]]++] = static_cast<Index>(s); });
    std::copy_backward(start_.begin(), start_.end() - 1, start_.end());
    start_[0] = 0;
  } else {
    std::vector<std::uint64_t> key(slots);
    in_pieces(slots, [&](std::size_t s) { key[s] = key_of(s); });
    std::iota(order.begin(), order.end(), Index{0});
    std::size_t compared = 0;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      if (++compared % (16 * piece) == 0) progress.check();
      return key[a] < key[b];
    });
    const std::size_t capacity = std::bit_ceil(2 * slots);
    table_key_.assign(capacity, no_key);
    table_range_.resize(capacity);
    for (std::size_t n = 0; n < slots;) {
      std::size_t end = n + 1;
      while (end < slots && key[order[end]] == key[order[n]]) ++end;
      std::size_t place = spread(key[order[n]]) & (capacity - 1);
      while (table_key_[place] != no_key) place = (place + 1) & (capacity - 1);
      table_key_[place] = key[order[n]];
      table_range_[place] = {static_cast<Index>(n), static_cast<Index>(end)};
      n = end;
    }
  }
  const auto permute = [&](auto& values) {
    auto old = values;
    parallel_for(slots, piece, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t n = begin; n < end; ++n) values[n] = old[order[n]];
    });
  };
  permute(x_);
  permute(y_);
  permute(z_);
  permute(point_);
  home_.reserve(points);
  for (std::size_t n = 0; n < slots; ++n) {
    if (order[n] < points) home_.push_back(static_cast<Index>(n));
  }
}

NeighbourGrid::Range NeighbourGrid::sparse_cell(std::uint64_t key) const {
  const std::size_t mask = table_key_.size() - 1;
  for (std::size_t place = spread(key) & mask;; place = (place + 1) & mask) {
    if (table_key_[place] == key) return table_range_[place];
    if (table_key_[place] == no_key) return {0, 0};
  }
}

// Calls body(begin, end) for runs of slots that hold everything between two corners.
template <class Body>
void NeighbourGrid::for_ranges(const Vec3& from, const Vec3& to, Body&& body) const {
  std::array<std::int64_t, 3> low, high;
  for (int k = 0; k < 3; ++k) {
    const double last = static_cast<double>(cells_[k] - 1);
    const double first_cell = std::floor((from[k] - min_[k]) / edge_);
    const double last_cell = std::floor((to[k] - min_[k]) / edge_);
    if (!(last_cell >= 0.0) || !(first_cell <= last)) return;
    low[k] = static_cast<std::int64_t>(std::max(first_cell, 0.0));
    high[k] = static_cast<std::int64_t>(std::min(last_cell, last));
  }
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      const std::uint64_t row = static_cast<std::uint64_t>((z * cells_[1] + y) * cells_[0]);
      if (!start_.empty()) {
        const Index begin = start_[row + low[0]];
        const Index end = start_[row + high[0] + 1];
        if (begin != end) body(begin, end);
        continue;
      }
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        const Range range = sparse_cell(row + static_cast<std::uint64_t>(x));
        if (range.begin != range.end) body(range.begin, range.end);
      }
    }
  }
}

std::size_t NeighbourGrid::count_candidates(const Vec3& centre, double radius) const {
  std::size_t count = 0;
  for_ranges(centre - radius, centre + radius, [&](Index begin, Index end) { count += end - begin; });
  return count;
}

void NeighbourGrid::find(const Vec3& centre, double radius, std::vector<Index>& slots, Index except) const {
  const double limit = radius * radius;
  slots.resize(slots.capacity());
  std::size_t found = 0;
  for_ranges(centre - radius, centre + radius, [&](Index begin, Index end) {
    const std::size_t count = end - begin;
    if (slots.size() < found + count) slots.resize(2 * slots.size() + count);
    found += within({&x_[begin], &y_[begin], &z_[begin], count}, centre, limit, begin, slots.data() + found);
  });
  slots.resize(found);
  if (except == no_index) return;
  const auto self = std::find(slots.begin(), slots.end(), except);
  if (self != slots.end()) slots.erase(self);
}

void NeighbourGrid::gather(Index slot, double radius, GridBlock& block) const {
  const std::array<std::int64_t, 3> cell = cell_of(position(slot));
  if (cell == block.cell && radius == block.radius) return;
  block.cell = cell;
  block.radius = radius;
  block.origin = min_ + edge_ * Vec3(cell[0], cell[1], cell[2]);
  block.count = 0;
  const Vec3 reach(radius);
  for_ranges(block.origin - reach, block.origin + edge_ + reach, [&](Index begin, Index end) {
    const std::size_t first = block.count;
    const std::size_t count = end - begin;
    block.count += count;
    const std::size_t room = (block.count + 63) / 64 * 64;
    if (block.slot.size() < room) {
      for (auto* values : {&block.x, &block.y, &block.z}) values->resize(2 * room);
      block.slot.resize(2 * room);
    }
    const auto copy = [&](const std::vector<double>& from, double origin, std::vector<float>& values) {
      const double* source = &from[begin];
      float* target = &values[first];
      for (std::size_t n = 0; n < count; ++n) target[n] = static_cast<float>(source[n] - origin);
    };
    copy(x_, block.origin.x, block.x);
    copy(y_, block.origin.y, block.y);
    copy(z_, block.origin.z, block.z);
    std::iota(block.slot.begin() + static_cast<std::ptrdiff_t>(first),
              block.slot.begin() + static_cast<std::ptrdiff_t>(block.count), begin);
  });
  for (std::size_t n = block.count; n % 64 != 0; ++n) block.x[n] = block.y[n] = block.z[n] = 1e18F;
}

std::size_t NeighbourGrid::find_in(const GridBlock& block, Index slot, double radius, std::vector<Index>& slots) const {
  const Vec3 centre = position(slot) - block.origin;
  const std::array<float, 3> from{static_cast<float>(centre.x), static_cast<float>(centre.y),
                                  static_cast<float>(centre.z)};
  const auto limit = static_cast<float>(radius * radius);
  static const Within64 within = within_64();
  if (slots.size() < block.count) slots.resize(block.count);
  std::size_t found = 0;
  for (std::size_t begin = 0; begin < block.count; begin += 64) {
    std::uint64_t hits = within(&block.x[begin], &block.y[begin], &block.z[begin], from.data(), limit);
    for (; hits != 0; hits &= hits - 1) {
      const Index hit = block.slot[begin + static_cast<std::size_t>(std::countr_zero(hits))];
      slots[found] = hit;
      found += hit != slot ? 1 : 0;
    }
  }
  return found;
}

double median_nearest_distance(std::span<const Vec3> points, const Box& box, Progress& progress) {
  if (points.size() < 2) return 0.0;
  const Bounds bounds = bounds_of(points);
  // Start from the spacing of as many points spread evenly (but of atoms, where that is far more) and widen while
  // most points find nobody.
  const Vec3 extent = glm::max(bounds.extent(), Vec3(1e-3 * bounds.diagonal()));
  const double spacing = std::max(std::cbrt(extent.x * extent.y * extent.z / static_cast<double>(points.size())), 1e-9);
  const std::size_t stride = (points.size() + 19999) / 20000;
  std::vector<double> nearest;
  std::vector<Index> slots;
  for (double radius = std::min(1.5 * spacing, 4.0);; radius *= 2.0) {
    const NeighbourGrid grid(points, box, radius, radius, progress);
    nearest.clear();
    std::size_t asked = 0;
    for (std::size_t n = 0; n < grid.home_slots().size(); n += stride, ++asked) {
      const Index slot = grid.home_slots()[n];
      const Vec3 centre = grid.position(slot);
      grid.find(centre, radius, slots, slot);
      double best = radius * radius * 2.0;
      for (const Index s : slots) {
        const Vec3 d = grid.position(s) - centre;
        best = std::min(best, glm::dot(d, d));
      }
      if (!slots.empty()) nearest.push_back(std::sqrt(best));
    }
    // Those that found nobody are further away than all that did.
    if (nearest.size() > asked / 2 || radius > 2.0 * bounds.diagonal()) {
      if (nearest.empty()) return 0.0;
      const std::size_t middle = std::min(asked / 2, nearest.size() - 1);
      std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(middle), nearest.end());
      return nearest[middle];
    }
  }
}

}  // namespace atomesh
