// A frame made of a function that draws whole pictures: draws all of it and keeps the lattice's pixels of the window.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "render/renderer.h"

namespace atomesh {

class WholePictureFrame final : public Frame {
 public:
  using Draw = std::function<Image(RenderStats&, const Channels&, Progress&)>;

  WholePictureFrame(const PixelWindow& window, Draw draw) : window_(window), draw_(std::move(draw)) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    std::vector<float> thickness;
    std::vector<float> depth;
    std::vector<Index> id;
    const Image whole = draw_(stats,
                              {channels.thickness != nullptr ? &thickness : nullptr,
                               channels.depth != nullptr ? &depth : nullptr, channels.id != nullptr ? &id : nullptr},
                              progress);
    take(lattice, whole.width, whole.pixels, image.pixels, Vec4f(0.0F));
    if (!thickness.empty()) take(lattice, whole.width, thickness, *channels.thickness, 0.0F);
    if (!depth.empty()) take(lattice, whole.width, depth, *channels.depth, std::numeric_limits<float>::infinity());
    if (!id.empty()) take(lattice, whole.width, id, *channels.id, no_index);
  }

 private:
  template <class T>
  void take(const PixelLattice& lattice, int picture_width, const std::vector<T>& from, std::vector<T>& to,
            const T& nothing) const {
    const auto size = static_cast<std::size_t>(window_.width) * static_cast<std::size_t>(window_.height);
    if (to.size() != size) to.assign(size, nothing);
    for (int row = 0; row < window_.height; ++row) {
      if ((window_.top + row) % lattice.row_stride != lattice.row_phase) continue;
      for (int column = 0; column < window_.width; ++column) {
        if ((window_.left + column) % lattice.column_stride != lattice.column_phase) continue;
        to[static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.width) + static_cast<std::size_t>(column)] =
            from[static_cast<std::size_t>(window_.top + row) * static_cast<std::size_t>(picture_width) +
                 static_cast<std::size_t>(window_.left + column)];
      }
    }
  }

  PixelWindow window_;
  Draw draw_;
};

}  // namespace atomesh
