#include "preprocess/atom_blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"

namespace atomesh {

namespace {

constexpr std::int64_t most_blocks = std::int64_t{1} << 20;  // along one axis, so that three numbers fit one key

}  // namespace

AtomBlocks::AtomBlocks(std::span<const Vec3> positions, double edge, const Progress& progress) : edge_(edge) {
  Bounds bounds;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& p = positions[i];
    if (!std::isfinite(p.x + p.y + p.z)) {
      throw Error("atom " + std::to_string(i + 1) + " has a position that is not finite");
    }
    bounds.add(p);
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
  if (all <= positions.size() + 65536) {
    std::vector<Index> next(all + 1, 0);
    for (const Vec3& p : positions) ++next[key_of(p) + 1];
    progress.check();
    table_.assign(all, no_index);
    for (std::uint64_t key = 0; key < all; ++key) {
      if (next[key + 1] > 0) {
        table_[key] = static_cast<Index>(keys_.size());
        keys_.push_back(key);
      }
      next[key + 1] += next[key];
      if (table_[key] != no_index) start_.push_back(next[key + 1]);
    }
    progress.check();
    for (std::size_t i = 0; i < positions.size(); ++i) order_[next[key_of(positions[i])]++] = static_cast<Index>(i);
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
