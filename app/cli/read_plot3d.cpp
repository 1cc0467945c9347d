// PLOT3D: grids in text are read here, which may have Fortran's exponents, and the binary ones by VTK's reader.
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStructuredGrid.h>

#include <algorithm>
#include <functional>

#include "app/cli/mesh_cells.h"
#include "app/cli/next_word.h"
#include "app/cli/plot3d_layout.h"
#include "app/cli/run_vtk_reader.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

// Density, momentum and energy of the last block's points, and the pressure of an ideal gas where those allow one
// everywhere. value(point, variable) is the density, the three components of the momentum, and the energy.
void add_solution(MeshCells& cells, std::size_t count, const std::function<double(std::size_t, int)>& value) {
  std::vector<VertexField> fields;
  add_fields(fields, "Density", count, 1, [&](std::size_t i, int) { return value(i, 0); });
  add_fields(fields, "Energy", count, 1, [&](std::size_t i, int) { return value(i, 4); });
  add_fields(fields, "Momentum", count, 3, [&](std::size_t i, int c) { return value(i, 1 + c); });
  constexpr double gamma = 1.4;
  VertexField pressure{"Pressure", std::vector<float>(count)};
  bool sensible = true;
  for (std::size_t i = 0; i < count; ++i) {
    const double rho = fields[0].values[i];
    const double m = fields[2].values[i];
    const double p = (gamma - 1.0) * (fields[1].values[i] - 0.5 * m * m / rho);
    sensible = sensible && rho > 0.0 && p > 0.0;
    pressure.values[i] = static_cast<float>(p);
  }
  if (sensible) fields.push_back(std::move(pressure));
  // Blocks follow one another; a pressure that one of them has not is left out of all.
  if (cells.blocks.size() == 1) {
    cells.point_fields = std::move(fields);
    return;
  }
  const std::size_t shared = std::min(cells.point_fields.size(), fields.size());
  cells.point_fields.resize(shared);
  for (std::size_t f = 0; f < shared; ++f) {
    auto& all = cells.point_fields[f].values;
    all.insert(all.end(), fields[f].values.begin(), fields[f].values.end());
  }
}

// ---- text

// The numbers of a text after the dimensions, as many as the layout asks for.
class TextNumbers {
 public:
  TextNumbers(std::string_view bytes, const Plot3dLayout& layout, const std::string& path) : rest_(bytes), path_(path) {
    for (std::size_t n = 0; n < 3 * layout.grids.size() + (layout.multi_grid ? 1 : 0); ++n) next_word(rest_);
  }

  // A D of Fortran's doubles is an E.
  double next() {
    const std::string_view word = next_word(rest_);
    double value = 0.0;
    if (parse_real(word, value)) return value;
    std::string number(word);
    for (char& c : number) c = c == 'D' || c == 'd' ? 'E' : c;
    if (parse_real(number, value)) return value;
    throw InputError(path_, 0,
                     "damaged or incomplete: expected a number, got \"" + std::string(word.substr(0, 40)) + "\"");
  }
  std::vector<double> next(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = next();
    return values;
  }

 private:
  std::string_view rest_;
  const std::string& path_;
};

MeshCells read_text(std::string_view bytes, const std::string& path, const Plot3dLayout& layout, Progress& progress) {
  MeshCells cells;
  TextNumbers numbers(bytes, layout, path);
  for (const auto& grid : layout.grids) {
    progress.check();
    add_block(cells, grid);
    const std::size_t first = cells.points.size();
    const auto count = static_cast<std::size_t>(grid[0] * grid[1] * grid[2]);
    cells.points.resize(first + count);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t p = first; p < first + count; ++p) cells.points[p][axis] = numbers.next();
    }
    if (!layout.iblank) continue;
    for (std::size_t p = 0; p < count; ++p) cells.blanked_points.push_back(numbers.next() == 0.0);
  }
  return cells;
}

void read_text_solution(MeshCells& all, const std::string& path, const Plot3dLayout& layout, Progress& progress) {
  const MappedFile file(path);
  TextNumbers numbers(file.bytes(), layout, path);
  const std::vector<StructuredBlock> blocks = std::move(all.blocks);
  all.blocks.clear();
  for (const StructuredBlock& block : blocks) {
    progress.check();
    all.blocks.push_back(block);
    numbers.next(4);  // Mach number, angle of attack, Reynolds number, time
    const auto count = static_cast<std::size_t>(block.points[0] * block.points[1] * block.points[2]);
    const std::vector<double> values = numbers.next(5 * count);
    add_solution(all, count, [&](std::size_t p, int v) { return values[static_cast<std::size_t>(v) * count + p]; });
  }
}

// ---- binary

void add_vtk_solution(MeshCells& cells, vtkPointData& data, std::size_t count, const std::string& path) {
  vtkDataArray* density = data.GetArray("Density");
  vtkDataArray* momentum = data.GetArray("Momentum");
  vtkDataArray* energy = data.GetArray("StagnationEnergy");
  for (vtkDataArray* array : {density, momentum, energy}) {
    if (array == nullptr || array->GetNumberOfTuples() != static_cast<vtkIdType>(count)) {
      throw InputError(path, 0, "damaged or incomplete: no density, momentum and energy at each point");
    }
  }
  add_solution(cells, count, [&](std::size_t i, int v) {
    const auto p = static_cast<vtkIdType>(i);
    return v == 0   ? density->GetComponent(p, 0)
           : v == 4 ? energy->GetComponent(p, 0)
                    : momentum->GetComponent(p, v - 1);
  });
}

MeshCells read_binary(const std::string& path, const std::string& solution, const Plot3dLayout& layout,
                      Progress& progress) {
  vtkNew<vtkMultiBlockPLOT3DReader> reader;
  reader->AutoDetectFormatOff();
  reader->SetXYZFileName(path.c_str());
  if (!solution.empty()) reader->SetQFileName(solution.c_str());
  reader->SetBinaryFile(1);
  reader->SetHasByteCount(layout.record_marks ? 1 : 0);
  reader->SetMultiGrid(layout.multi_grid ? 1 : 0);
  reader->SetIBlanking(layout.iblank ? 1 : 0);
  reader->SetDoublePrecision(layout.double_precision ? 1 : 0);
  if (layout.big_endian) {
    reader->SetByteOrderToBigEndian();
  } else {
    reader->SetByteOrderToLittleEndian();
  }
  MeshCells cells;
  run_vtk_reader(*reader, path, progress, cells.notes);
  vtkMultiBlockDataSet* output = reader->GetOutput();
  if (output == nullptr || output->GetNumberOfBlocks() != layout.grids.size()) {
    throw InputError(path, 0, "damaged or incomplete: not all grids are in it");
  }
  for (unsigned b = 0; b < output->GetNumberOfBlocks(); ++b) {
    const auto& points = layout.grids[b];
    const auto count = static_cast<std::size_t>(points[0] * points[1] * points[2]);
    auto* grid = vtkStructuredGrid::SafeDownCast(output->GetBlock(b));
    if (grid == nullptr || grid->GetNumberOfPoints() != static_cast<vtkIdType>(count)) {
      throw InputError(path, 0, "damaged or incomplete: grid " + std::to_string(b + 1));
    }
    add_block(cells, points);
    for (std::size_t p = 0; p < count; ++p) {
      double at[3];
      grid->GetPoint(static_cast<vtkIdType>(p), at);
      cells.points.emplace_back(at[0], at[1], at[2]);
    }
    if (!solution.empty()) add_vtk_solution(cells, *grid->GetPointData(), count, solution);
    if (!layout.iblank) continue;
    // 0 is no part of the grid; negative ones were interpolated from another grid and are as good as any.
    auto* iblank = vtkIntArray::SafeDownCast(grid->GetPointData()->GetArray("IBlank"));
    if (iblank == nullptr || iblank->GetNumberOfTuples() != grid->GetNumberOfPoints()) {
      throw InputError(path, 0, "damaged or incomplete: the blanking of grid " + std::to_string(b + 1));
    }
    for (std::size_t p = 0; p < count; ++p) {
      cells.blanked_points.push_back(iblank->GetValue(static_cast<vtkIdType>(p)) == 0);
    }
  }
  return cells;
}

}  // namespace

MeshCells read_plot3d_cells(const std::string& path, const std::string& solution, Progress& progress) {
  const MappedFile file(path);
  const auto layout = find_plot3d_layout(file.bytes());
  if (!layout) {
    if (is_plot3d_solution(file.bytes())) {
      throw InputError(path, 0, "is a PLOT3D solution; give the grid that it belongs to");
    }
    throw InputError(path, 0,
                     "is no PLOT3D grid, or a truncated one: no byte order, records and precision account for "
                     "its " +
                         std::to_string(file.bytes().size()) + " bytes");
  }
  if (!solution.empty()) {
    const MappedFile values(solution);
    const std::string problem = plot3d_solution_problem(values.bytes(), *layout);
    if (!problem.empty()) throw InputError(solution, 0, problem);
  }
  if (!layout->text) return read_binary(path, solution, *layout, progress);
  MeshCells cells = read_text(file.bytes(), path, *layout, progress);
  if (!solution.empty()) read_text_solution(cells, solution, *layout, progress);
  return cells;
}

}  // namespace atomesh::cli
