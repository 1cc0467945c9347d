#include "render/gl/marked_tiles.h"

#include "core/parallel.h"

namespace atomesh::gl {

MarkedTiles::MarkedTiles(std::span<const std::uint8_t> pixels, int width, int height, std::uint8_t bits)
    : columns_((width + (1 << shift) - 1) >> shift), left_(0), bottom_(0), right_(width - 1), top_(height - 1) {
  const int rows = (height + (1 << shift) - 1) >> shift;
  const auto line = static_cast<std::size_t>(columns_) + 1;
  sums_.assign(line * (static_cast<std::size_t>(rows) + 1), 0);
  parallel_for(static_cast<std::size_t>(rows), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      std::uint32_t* marks = &sums_[(row + 1) * line + 1];
      const std::size_t first = row << shift;
      const std::size_t last = std::min(first + (1 << shift), static_cast<std::size_t>(height));
      for (std::size_t j = first; j < last; ++j) {
        const std::uint8_t* pixel = &pixels[j * static_cast<std::size_t>(width)];
        for (int i = 0; i < width; ++i) marks[i >> shift] |= (pixel[i] & bits) != 0 ? 1U : 0U;
      }
    }
  });
  for (std::size_t row = 1; row <= static_cast<std::size_t>(rows); ++row) {
    std::uint32_t along = 0;
    for (std::size_t column = 1; column < line; ++column) {
      along += sums_[row * line + column];
      sums_[row * line + column] = sums_[(row - 1) * line + column] + along;
    }
  }
}

}  // namespace atomesh::gl
