#include "preprocess/atom_blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::int64_t most_blocks = std::int64_t{1} << 20;  // along one axis, so that three numbers fit one key
constexpr std::size_t atoms_per_range = 1 << 14;

}  // namespace

AtomBlocks::AtomBlocks(std::span<const Vec3> positions, double edge, const Progress& progress) : edge_(edge) {
  const std::size_t ranges = (positions.size() + atoms_per_range - 1) / atoms_per_range;
  std::vector<Bounds> bounds_of_range(ranges);
  std::vector<std::size_t> not_finite(ranges, positions.size());  // the first of each range
  parallel_for(positions.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Bounds own;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& p = positions[i];
      if (!std::isfinite(p.x + p.y + p.z)) {
        not_finite[begin / atoms_per_range] = i;
        break;
      }
      own.add(p);
    }
    bounds_of_range[begin / atoms_per_range] = own;
  });
  Bounds bounds;
  for (std::size_t n = 0; n < ranges; ++n) {
    if (not_finite[n] < positions.size()) {
      throw Error("atom " + std::to_string(not_finite[n] + 1) + " has a position that is not finite");
    }
    bounds.add(bounds_of_range[n].min);
    bounds.add(bounds_of_range[n].max);
  }
  progress.check();
  start_.push_back(0);
  if (positions.empty()) return;
  min_ = bounds.min;
  const Vec3 extent = bounds.extent();
  edge_ = std::max(edge_, std::max({extent.x, extent.y, extent.z}) / static_cast<double>(most_blocks - 2));
  for (int k = 0; k < 3; ++k) count_[k] = static_cast<std::int64_t>(extent[k] / edge_) + 1;

  const std::uint64_t all = static_cast<std::uint64_t>(count_[0] * count_[1] * count_[2]);
  order_.resize(positions.size());
  if (all <= positions.size() + 65536 && all < no_index) {
    std::vector<Index> key(positions.size());
    parallel_for(positions.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t i = begin; i < end; ++i) key[i] = static_cast<Index>(key_of(positions[i]));
    });
    std::vector<Index> next(all + 1, 0);
    for (const Index k : key) ++next[std::size_t{k} + 1];
    progress.check();
    table_.assign(all, no_index);
    for (std::uint64_t k = 0; k < all; ++k) {
      if (next[k + 1] > 0) {
        table_[k] = static_cast<Index>(keys_.size());
        keys_.push_back(k);
      }
      next[k + 1] += next[k];
      if (table_[k] != no_index) start_.push_back(next[k + 1]);
    }
    progress.check();
    for (std::size_t i = 0; i < positions.size(); ++i) order_[next[key[i]]++] = static_cast<Index>(i);
  } else {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::vector<std::uint64_t> key(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) key[i] = key_of(positions[i]);
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    for (std::size_t n = 0; n < order_.size(); ++n) {
      if (n > 0 && key[order_[n]] == keys_.back()) {
        start_.back() = static_cast<Index>(n + 1);
      } else {
        keys_.push_back(key[order_[n]]);
        start_.push_back(static_cast<Index>(n + 1));
      }
    }
  }
}

std::uint64_t AtomBlocks::key_of(const Vec3& p) const {
  std::uint64_t key = 0;
  for (int k = 2; k >= 0; --k) {
    const auto place = std::min(static_cast<std::int64_t>((p[k] - min_[k]) / edge_), count_[k] - 1);
    key = key * static_cast<std::uint64_t>(count_[k]) + static_cast<std::uint64_t>(place);
  }
  return key;
}

std::array<std::int64_t, 3> AtomBlocks::place(std::size_t block) const {
  const auto key = static_cast<std::int64_t>(keys_[block]);
  return {key % count_[0], key / count_[0] % count_[1], key / (count_[0] * count_[1])};
}

Vec3 AtomBlocks::center(std::size_t block) const {
  const auto at = place(block);
  return min_ + edge_ * Vec3(static_cast<double>(at[0]) + 0.5, static_cast<double>(at[1]) + 0.5,
                             static_cast<double>(at[2]) + 0.5);
}

Index AtomBlocks::neighbour(std::size_t block, int dx, int dy, int dz) const {
  auto at = place(block);
  const std::array<int, 3> d{dx, dy, dz};
  for (int k = 0; k < 3; ++k) {
    at[k] += d[k];
    if (at[k] < 0 || at[k] >= count_[k]) return no_index;
  }
  const auto key = static_cast<std::uint64_t>((at[2] * count_[1] + at[1]) * count_[0] + at[0]);
  if (!table_.empty()) return table_[key];
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
  return found != keys_.end() && *found == key ? static_cast<Index>(found - keys_.begin()) : no_index;
}

}  // namespace atomesh
