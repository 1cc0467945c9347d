// What is under the mouse: an atom or a cell, with all that is known of it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/material.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "core/vertex_defects.h"
#include "render/scene.h"

namespace atomesh::gui {

struct Neighbour {
  Index atom;
  double distance;  // Å, through periodic boundaries
};

struct Pick {
  Vec3 position{0.0};  // Å: of the atom, else where the ray met the cell
  Index atom = no_index;
  Index tetrahedron = no_index;  // of the scene, in the modes of the volume
  Index triangle = no_index;     // of the scene, in modes surface and xray
  double depth = 0.0;            // along Camera::forward, of what the ray met
  // Of the atom; of a mesh without atoms, the field's value at `position`.
  DefectValues defects;
  std::optional<double> field;
  std::vector<Neighbour> neighbours;  // of the atom, nearest first
};

// The nearest thing that pixel (column, row) of the camera's picture shows, or nothing.
//   atoms:                  the ball the ray meets, balls of less than `opacity` in all left out before others
//   surface, xray:          the triangle it meets, and the nearest of its corners' atoms
//   volume, volume-surface: the first cell that makes at least `opacity` of the pixel by itself, dimmed by what is
//                           before it; where none does, the one at which the ray has half of its opacity, faces
//                           included. And the nearest of its corners' atoms. A ray that nobody sees (less than half of
//                           1/255) shows nothing.
// Some 30 ms for 4.4 million cells, 6 ms for half a million balls: beside the window's thread, that is. Throws
// CancelledError.
std::optional<Pick> pick(const Material& material, const Scene& scene, const Camera& camera,
                         const Parameters& parameters, int column, int row, double opacity = 0.05,
                         Progress& progress = no_progress());

// What is known of an atom: position, defects, and its neighbours through the periodic boundaries: all that are at most
// 1.3 times as far as the nearest (other atoms at the very same place come first and are not that), at most 32. An atom
// has more than one distance where the box is small. Throws UsageError for an atom that there is not.
Pick pick_atom(const Material& material, Index atom, Progress& progress = no_progress());

// From a to b by the shortest way through the periodic boundaries of the box, whatever its shape; the straight one
// where another is as short. Å.
Vec3 shortest_way(const Box& box, const Vec3& a, const Vec3& b);

// Label and value, one row each: "Species", "Na"; "Position", "1.000, 2.000, 3.000 Å"; … for the panel and for copying.
std::vector<std::pair<std::string, std::string>> describe(const Pick& pick, const Material& material);

}  // namespace atomesh::gui
