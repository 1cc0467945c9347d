// Repairs a mesh whose vertices were moved so far that some tetrahedra turned inside out.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

struct MendReport {
  std::size_t bad = 0;       // inverted or flat tetrahedra found
  std::size_t removed = 0;   // of them on the outside, taken away
  std::size_t replaced = 0;  // of them inside, replaced together with tetrahedra around them
  std::vector<Index> lost;   // vertices that no tetrahedron is left with, ascending
};

// Every tetrahedron becomes positively oriented (exactly) without gap or overlap. One on the outside is taken away, for
// what it covers backwards lies outside the rest. One inside is replaced: it and its neighbours are a cavity, and the
// search of Liu, Chen & Sun, "Small polyhedron reconnection" (Proc. 15th Int. Meshing Roundtable, 2006) fills it with
// tetrahedra between its vertices, those of small circumspheres first. That tetrahedra whose faces match those of the
// cavity and each other fill it once needs no test for intersections: their boundary winds once about every place
// inside, and each covers places once, positively. Larger cavities are tried where small ones have no filling. Returns
// false, with the mesh partly mended, where that fails or more than `most` are bad.
bool mend_tetrahedra(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points, std::size_t most,
                     MendReport& report, Progress& progress = no_progress());

}  // namespace atomesh
