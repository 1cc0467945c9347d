// Small mesh files for tests, written here and nowhere else: text in VTK's two formats, PLOT3D in every byte layout.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace atomesh::test {

// A legacy .vtk of points, cells (VTK's type, corners) and what follows behind CELL_TYPES.
struct VtkCell {
  int type;
  std::vector<int> corners;
};

inline std::string legacy_vtk(const std::vector<Vec3>& points, const std::vector<VtkCell>& cells,
                              const std::string& data = "") {
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << points.size() << " double\n";
  for (const Vec3& p : points) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  std::size_t size = 0;
  for (const VtkCell& cell : cells) size += cell.corners.size() + 1;
  text << "CELLS " << cells.size() << ' ' << size << '\n';
  for (const VtkCell& cell : cells) {
    text << cell.corners.size();
    for (const int c : cell.corners) text << ' ' << c;
    text << '\n';
  }
  text << "CELL_TYPES " << cells.size() << '\n';
  for (const VtkCell& cell : cells) text << cell.type << '\n';
  text << data;
  return text.str();
}

// The same in XML.
inline std::string vtu(const std::vector<Vec3>& points, const std::vector<VtkCell>& cells,
                       const std::string& data = "") {
  std::ostringstream text;
  text.precision(17);
  text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
       << "<UnstructuredGrid><Piece NumberOfPoints=\"" << points.size() << "\" NumberOfCells=\"" << cells.size()
       << "\">\n"
       << data << "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const Vec3& p : points) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  text << "</DataArray></Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
  for (const VtkCell& cell : cells) {
    for (const int c : cell.corners) text << c << ' ';
    text << '\n';
  }
  text << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
  std::size_t end = 0;
  for (const VtkCell& cell : cells) text << (end += cell.corners.size()) << '\n';
  text << "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n";
  for (const VtkCell& cell : cells) text << cell.type << '\n';
  text << "</DataArray>\n</Cells>\n</Piece></UnstructuredGrid></VTKFile>\n";
  return text.str();
}

// How a PLOT3D file is written.
struct Plot3dForm {
  bool big_endian = false;
  bool record_marks = false;
  bool double_precision = false;
  bool multi_grid = false;
};

class Plot3dWriter {
 public:
  explicit Plot3dWriter(const Plot3dForm& form) : form_(form) {}

  void record(const std::string& bytes) {
    const std::string mark = integer(static_cast<std::int32_t>(bytes.size()));
    bytes_ += form_.record_marks ? mark + bytes + mark : bytes;
  }
  std::string integer(std::int32_t value) const { return number(value); }
  std::string real(double value) const {
    return form_.double_precision ? number(value) : number(static_cast<float>(value));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Number>
  std::string number(Number value) const {
    std::string bytes(sizeof(value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(value));
    return form_.big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
  }

  Plot3dForm form_;
  std::string bytes_;
};

struct Plot3dGrid {
  std::array<int, 3> points;
  std::function<Vec3(int, int, int)> at;
  std::function<int(int, int, int)> iblank;  // none: not written
};

template <class Visit>
void for_each_point(const Plot3dGrid& grid, Visit&& visit) {
  for (int k = 0; k < grid.points[2]; ++k) {
    for (int j = 0; j < grid.points[1]; ++j) {
      for (int i = 0; i < grid.points[0]; ++i) visit(i, j, k);
    }
  }
}

inline void write_dimensions(Plot3dWriter& file, const Plot3dForm& form, const std::vector<Plot3dGrid>& grids) {
  if (form.multi_grid) file.record(file.integer(static_cast<int>(grids.size())));
  std::string dimensions;
  for (const Plot3dGrid& grid : grids) {
    for (const int n : grid.points) dimensions += file.integer(n);
  }
  file.record(dimensions);
}

inline std::string plot3d_grid(const Plot3dForm& form, const std::vector<Plot3dGrid>& grids) {
  Plot3dWriter file(form);
  write_dimensions(file, form, grids);
  for (const Plot3dGrid& grid : grids) {
    std::string record;
    for (int axis = 0; axis < 3; ++axis) {
      for_each_point(grid, [&](int i, int j, int k) { record += file.real(grid.at(i, j, k)[axis]); });
    }
    if (grid.iblank) for_each_point(grid, [&](int i, int j, int k) { record += file.integer(grid.iblank(i, j, k)); });
    file.record(record);
  }
  return file.bytes();
}

// Density 1 + i, momentum (i, j, k), energy 100: a pressure everywhere.
inline std::string plot3d_solution(const Plot3dForm& form, const std::vector<Plot3dGrid>& grids) {
  Plot3dWriter file(form);
  write_dimensions(file, form, grids);
  for (const Plot3dGrid& grid : grids) {
    std::string header;
    for (const double value : {0.5, 0.0, 1000.0, 2.0}) header += file.real(value);
    file.record(header);
    std::string record;
    for (int variable = 0; variable < 5; ++variable) {
      for_each_point(grid, [&](int i, int j, int k) {
        const double values[] = {1.0 + i, double(i), double(j), double(k), 100.0};
        record += file.real(values[variable]);
      });
    }
    file.record(record);
  }
  return file.bytes();
}

}  // namespace atomesh::test
