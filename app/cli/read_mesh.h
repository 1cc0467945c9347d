// Tetrahedral meshes of any origin → Material, through VTK's readers: .vtu, legacy .vtk, PLOT3D; and TetGen's
// .node/.ele.
#pragma once

#include <string>
#include <vector>

#include "core/material.h"
#include "core/progress.h"

namespace atomesh::cli {

struct MeshFileOptions {
  std::string solution;  // PLOT3D: the Q file; empty: found beside the grid ("combxyz.bin" → "combq.bin") or none
};

struct MeshFileReport {
  std::string format;  // "vtu", "vtk", "plot3d", "tetgen"
  std::uint64_t points = 0;
  std::uint64_t cells = 0;         // of the file, blanked ones left out
  std::uint64_t tetrahedra = 0;    // of the result
  std::uint64_t blanked = 0;       // cells that touch a blanked point
  std::uint64_t flat = 0;          // tetrahedra without volume, left out
  std::uint64_t turned = 0;        // tetrahedra of cells that the file lists inside out
  std::uint64_t skipped = 0;       // cells without volume of their own: vertices, lines, triangles, …
  std::vector<std::string> notes;  // for people
};

// By extension and, failing that, by content: .vtu .vtk .node .ele, and PLOT3D in .xyz .x .g .bin .p3d. An .xyz with
// atoms is none.
bool is_mesh_file(const std::string& path);

// A material without atoms: mesh, surface, and a field for each point scalar (of vectors their magnitude and
// components; cell scalars averaged at the vertices). Hexahedra, voxels, wedges and pyramids are split into tetrahedra
// so that neighbours agree on the diagonals of the faces they share: five to a hexahedron of a structured grid, turn
// and turn about (six where a grid closes on itself out of turn); elsewhere by the smallest vertex number (Dompierre et
// al. 1999, "How to subdivide pyramids, prisms and hexahedra into tetrahedra"). Vertices that hang in a neighbour's
// face and faces that neighbours split differently leave walls inside, part of the surface, which a note counts.
// mesh.delaunay is false. Throws InputError naming the file for anything damaged, empty or not finite.
Material read_mesh_file(const std::string& path, const MeshFileOptions& options, MeshFileReport& report,
                        Progress& progress = no_progress());

}  // namespace atomesh::cli
