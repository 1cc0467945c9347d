// Cells that are all of one colour: what lies between the others.
//
// Most of a good crystal has no defect, and its vertices all have the base colour. Cells that have only such vertices
// need not be projected one by one: a ray is in one of them wherever it is inside the surface and in none of the other
// cells, and a stretch of one colour has a closed form whatever its length.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "render/scene.h"

namespace atomesh::cell_projection {

class UniformMedium {
 public:
  // None.
  UniformMedium() = default;
  // Of mode volume_surface. None where less than half of the vertices have one colour, or where the surface is too
  // large a part of the mesh for this to pay. Takes a byte a vertex.
  explicit UniformMedium(const Scene& scene);

  bool present() const { return !of_color_.empty(); }
  // Whether it is all there is.
  bool everywhere() const { return present() && everywhere_; }
  const Vec4f& color() const { return color_; }
  bool holds(const Tetrahedron& cell) const {
    return present() && (of_color_[cell[0]] & of_color_[cell[1]] & of_color_[cell[2]] & of_color_[cell[3]]) != 0;
  }

 private:
  Vec4f color_{0.0F};
  std::vector<std::uint8_t> of_color_;  // per vertex
  bool everywhere_ = false;
};

}  // namespace atomesh::cell_projection
