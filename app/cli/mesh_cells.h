// What a mesh file says, before it is split into tetrahedra and checked: between the readers of one format each and
// build_mesh(), which makes a Material of any of them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/cli/read_mesh.h"
#include "core/geometry.h"
#include "core/material.h"
#include "core/progress.h"
#include "core/split_cells.h"

namespace atomesh::cli {

// `unknown`: of a kind that is not read; the reader says so itself.
enum class FileCell : std::uint8_t { without_volume, simple, polyhedron, unknown };

// Points of one i-j-k grid, i fastest, in MeshCells::points from `first_point` on; its (n-1) products are the cells.
struct StructuredBlock {
  std::array<std::uint64_t, 3> points{};
  std::uint64_t first_point = 0;
  std::uint64_t first_cell = 0;  // of MeshCells::cell_fields
};

struct MeshCells {
  std::vector<Vec3> points;
  // Cells of any shape. Cell c has corners[first[c]] to corners[first[c + 1]]; of a polyhedron the faces, each a number
  // of corners and that many corners. Corners were not checked yet.
  std::vector<FileCell> kinds;
  std::vector<CellShape> shapes;
  std::vector<std::uint64_t> first{0};
  std::vector<std::uint64_t> corners;
  // Or blocks of hexahedra.
  std::vector<StructuredBlock> blocks;
  // One value for each point, or cell; may be not finite.
  std::vector<VertexField> point_fields;
  std::vector<VertexField> cell_fields;
  // Not part of the mesh; empty where all are.
  std::vector<bool> blanked_points;
  std::vector<bool> blanked_cells;
  std::vector<std::string> notes;
};

// The block behind those that are there already.
void add_block(MeshCells& cells, const std::array<std::uint64_t, 3>& points);

// A number for each point or cell as fields: of vectors the magnitude under their name and the components under it with
// _x, _y, _z; of up to nine numbers the components with _0, _1, …. `value(i, component)` is called for all of them.
// False, and nothing added, for more.
template <class Value>
bool add_fields(std::vector<VertexField>& fields, const std::string& name, std::size_t count, int components,
                Value&& value);

// Splits, turns, merges and checks; fills in `report` but for its format. `path` is the file's name in messages. Throws
// InputError for corners beyond the points, coordinates that are not finite or beyond 1e100, and a mesh without volume;
// UnavailableError when there is not the memory.
Material build_mesh(const MeshCells& cells, const std::string& path, MeshFileReport& report, Progress& progress);

// One reader a format. All throw InputError for what is damaged.
MeshCells read_vtk_cells(const std::string& path, const std::string& format, Progress& progress);  // "vtk", "vtu"
MeshCells read_plot3d_cells(const std::string& path, const std::string& solution, Progress& progress);
MeshCells read_tetgen_cells(const std::string& path, Progress& progress);

template <class Value>
bool add_fields(std::vector<VertexField>& fields, const std::string& name, std::size_t count, int components,
                Value&& value) {
  if (components < 1 || components > 9) return false;
  const auto add = [&](const std::string& full_name, auto&& of) {
    VertexField field{full_name, std::vector<float>(count)};
    for (std::size_t i = 0; i < count; ++i) field.values[i] = static_cast<float>(of(i));
    fields.push_back(std::move(field));
  };
  if (components == 1) {
    add(name, [&](std::size_t i) { return value(i, 0); });
    return true;
  }
  const bool vector = components <= 3;
  if (vector) {
    add(name,
        [&](std::size_t i) { return glm::length(Vec3(value(i, 0), value(i, 1), components > 2 ? value(i, 2) : 0.0)); });
  }
  for (int c = 0; c < components; ++c) {
    add(name + "_" + (vector ? std::string(1, "xyz"[c]) : std::to_string(c)),
        [&](std::size_t i) { return value(i, c); });
  }
  return true;
}

}  // namespace atomesh::cli
