#include "render/gl/key_sort.h"

#include <array>

#include "core/parallel.h"

namespace atomesh::gl {

namespace {

constexpr int digit_bits = 11;
constexpr std::size_t digit_values = std::size_t{1} << digit_bits;
constexpr std::uint32_t digit_mask = digit_values - 1;
constexpr std::size_t least_block = 1 << 14;  // cells; below it counting digits costs more than it spares

}  // namespace

void sort_by_key(std::vector<KeyedCell>& cells, std::vector<KeyedCell>& scratch, const Progress& progress) {
  const std::size_t count = cells.size();
  scratch.resize(count);
  // One block a thread, so that the places of digits are few; a cancel need not wait for the end of one.
  const std::size_t blocks = std::clamp<std::size_t>(count / least_block, 1, static_cast<std::size_t>(threads()));
  const std::size_t block_size = (count + blocks - 1) / blocks;
  std::vector<std::array<std::uint32_t, digit_values>> places(blocks);
  const auto each = [&](std::size_t begin, std::size_t end, const auto& take) {
    while (begin < end) {
      progress.check();
      for (const std::size_t next = std::min(begin + least_block, end); begin < next; ++begin) take(cells[begin]);
    }
  };
  for (int shift = 0; shift < 32; shift += digit_bits) {
    parallel_for(count, block_size, [&](std::size_t begin, std::size_t end) {
      std::array<std::uint32_t, digit_values>& counts = places[begin / block_size];
      counts.fill(0);
      each(begin, end, [&](const KeyedCell& cell) { ++counts[cell.key >> shift & digit_mask]; });
    });
    std::uint32_t place = 0;
    for (std::size_t digit = 0; digit < digit_values; ++digit) {
      for (std::array<std::uint32_t, digit_values>& counts : places) {
        const std::uint32_t cells_of_digit = counts[digit];
        counts[digit] = place;
        place += cells_of_digit;
      }
    }
    parallel_for(count, block_size, [&](std::size_t begin, std::size_t end) {
      std::array<std::uint32_t, digit_values>& next = places[begin / block_size];
      each(begin, end, [&](const KeyedCell& cell) { scratch[next[cell.key >> shift & digit_mask]++] = cell; });
    });
    cells.swap(scratch);
  }
}

}  // namespace atomesh::gl
