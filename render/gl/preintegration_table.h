// What segment.glsl (render/gl/shaders) reads to integrate a ray's segment: the colour map as linear pieces.
#pragma once

#include <epoxy/gl.h>

#include "core/color_map.h"
#include "render/gl/objects.h"

namespace atomesh::gl {

class PreintegrationTable {
 public:
  // Linear pieces side by side that cover every scalar, of `color_map` with extinction alpha_length (1/Å) · opacity;
  // does nothing where neither has changed.
  void update(const ColorMap& color_map, double alpha_length);

  // As the texture buffer of unit 8 (segment_pieces); before each draw with a shader that includes segment.glsl.
  void bind() const;

 private:
  ColorMap color_map_;
  double alpha_length_ = 0.0;
  Buffer pieces_;
  Handle<detail::destroy_texture> pieces_texture_;
};

}  // namespace atomesh::gl
