#include "render/cpu/cell_projection_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace atomesh::cell_projection {

SetupOutput Tile::resize(std::size_t count, bool colored) {
  const auto grow = [](auto& list, std::size_t size) {
    if (list.size() < size) list.resize(size);
  };
  count_ = count;
  grow(planes, count);
  grow(refinements, count);
  grow(keys, count);
  grow(blocks, count);
  grow(colors, colored ? count : 0);
  grow(ranges, colored ? count : 0);
  grow(scalars, colored ? 0 : count);
  return {planes.data(),  refinements.data(), colors.data(), ranges.data(),
          scalars.data(), keys.data(),        blocks.data(), per_block_.data()};
}

// Keys are resolved to 2^-32 of their range: a radix sort of three digits. (With two, deep tiles of millions of small
// cells come out so disordered that putting them right costs more than half of the picture.)
void Tile::sort() {
  constexpr int digit = 11;
  constexpr std::size_t digits = 3;
  constexpr std::uint32_t digit_mask = (1U << digit) - 1;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t n = 0; n < count_; ++n) {
    if (blocks[n] == 0) continue;
    low = std::min(low, keys[n]);
    high = std::max(high, keys[n]);
  }
  constexpr double largest = 4294967295.0;
  const double scale = high > low ? largest / (high - low) : 0.0;
  std::array<std::array<std::uint32_t, 1 << digit>, digits> places{};
  sorted_.clear();
  for (std::size_t n = 0; n < count_; ++n) {
    if (blocks[n] == 0) continue;
    const auto key = static_cast<std::uint32_t>((keys[n] - low) * scale);
    sorted_.push_back({key, static_cast<std::uint32_t>(n)});
    for (std::size_t pass = 0; pass < digits; ++pass) ++places[pass][key >> (digit * pass) & digit_mask];
  }
  sorting_.resize(sorted_.size());
  for (std::size_t pass = 0; pass < digits; ++pass) {
    std::uint32_t place = 0;
    for (std::uint32_t& at : places[pass]) place += std::exchange(at, place);
    for (const Entry& entry : sorted_) {
      sorting_[places[pass][entry.key >> (digit * pass) & digit_mask]++] = entry;
    }
    sorted_.swap(sorting_);
  }
}

void Tile::list_blocks() {
  sort();
  begin_.assign(blocks_per_tile + 1, 0);
  for (std::size_t b = 0; b < blocks_per_tile; ++b) begin_[b + 1] = begin_[b] + per_block_[b];
  // A place more, for what is listed under no block: no branch then guesses how many blocks a cell has, up to four.
  cells_.resize(begin_[blocks_per_tile] + 1);
  std::array<std::uint32_t, blocks_per_tile + 1> fill{};
  std::copy(begin_.begin(), begin_.end(), fill.begin());
  for (const Entry& entry : sorted_) {
    BlockSet rest = blocks[entry.cell];
    do {
      for (int i = 0; i < 4; ++i) {
        std::uint32_t& at = fill[static_cast<std::size_t>(std::countr_zero(rest))];
        cells_[at] = entry.cell;
        at += rest != 0 ? 1U : 0U;
        rest &= rest - 1;
      }
    } while (rest != 0);
  }
}

BlockScratch Tile::scratch() {
  std::size_t longest = 1;
  for (std::size_t b = 0; b + 1 < begin_.size(); ++b)
    longest = std::max<std::size_t>(longest, begin_[b + 1] - begin_[b]);
  if (lanes_.size() < longest) {
    floats_.resize(longest * (block_pixels * 2));
    numbers_.resize(longest * (3 + block_pixels));
    lanes_.resize(longest);
  }
  float* floats = floats_.data();
  std::uint32_t* numbers = numbers_.data();
  return {floats,
          floats + longest * block_pixels,
          lanes_.data(),
          numbers,
          numbers + longest,
          numbers + 2 * longest,
          numbers + 3 * longest};
}

std::unique_ptr<Tile> TilePool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<Tile>();
  std::unique_ptr<Tile> tile = std::move(free_.back());
  free_.pop_back();
  return tile;
}

void TilePool::give_back(std::unique_ptr<Tile> tile) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(tile));
}

}  // namespace atomesh::cell_projection
