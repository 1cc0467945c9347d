// .vtu, legacy .vtk and PLOT3D by VTK's readers. What VTK says goes into exceptions and notes, not to the terminal.
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetReader.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>
#include <optional>
#include <regex>

#include "app/cli/check_vtk_file.h"
#include "app/cli/mesh_cells.h"
#include "app/cli/plot3d_layout.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

// Keeps what VTK would print.
class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New();
  // clang-format off
  vtkTypeMacro(SilentWindow, vtkOutputWindow)
      // clang-format on
      void DisplayText(const char* text) override {
    take(text, false);
  }
  void DisplayErrorText(const char* text) override { take(text, true); }
  void DisplayWarningText(const char* text) override { take(text, false); }
  void DisplayGenericWarningText(const char* text) override { take(text, true); }
  void DisplayDebugText(const char*) override {}

  std::string first_error;
  std::string first_warning;

 private:
  // "ERROR: In FILE, line N\nvtkSomething (0x…): what it is about\n\n" → "what it is about"
  void take(const char* text, bool error) {
    std::string& kept = error ? first_error : first_warning;
    if (!kept.empty() || text == nullptr) return;
    static const std::regex place(R"(^(ERROR|Warning|Generic Warning): In [^\n]*\n)");
    static const std::regex object(R"(^[A-Za-z0-9_]+ \((0x)?[0-9a-fA-F]+\): )");
    kept = std::regex_replace(std::regex_replace(std::string(text), place, ""), object, "");
    std::replace(kept.begin(), kept.end(), '\n', ' ');
    kept.erase(kept.find_last_not_of(' ') + 1);
    // Where VTK only says which of its objects failed.
    if (kept.empty() || kept.find("(0x") != std::string::npos) kept = "what is announced is not in it";
  }
};
vtkStandardNewMacro(SilentWindow);

// VTK has one window and one log for the whole program: ours, and none, while this lives.
class Silence {
 public:
  Silence() : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Silence() {
    vtkOutputWindow::SetInstance(before_);
    vtkLogger::SetStderrVerbosity(verbosity_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  const SilentWindow& window() const { return *window_; }

 private:
  vtkNew<SilentWindow> window_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

// Runs a reader: cancellable, its complaints InputErrors.
void run(vtkAlgorithm& reader, const std::string& path, Progress& progress, std::vector<std::string>& notes) {
  const Silence silence;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&progress);
  watch->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    if (static_cast<const Progress*>(data)->cancelled()) static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
  });
  reader.AddObserver(vtkCommand::ProgressEvent, watch);
  try {
    reader.Update();
  } catch (const std::bad_alloc&) {
    throw InputError(path, 0, "asks for more memory than there is; it is damaged, or too large for this machine");
  }
  progress.check();
  const std::string& error = silence.window().first_error;
  if (!error.empty()) throw InputError(path, 0, "damaged or incomplete: " + error);
  const std::string& warning = silence.window().first_warning;
  if (!warning.empty()) notes.push_back("reading " + path + ": " + warning);
}

// ---- fields

bool is_ghost_array(const char* name) {
  return name != nullptr && std::string_view(name) == vtkDataSetAttributes::GhostArrayName();
}

void add_array(std::vector<VertexField>& fields, vtkDataArray& array, std::size_t count, const char* of,
               std::vector<std::string>& notes) {
  const std::string name = array.GetName() != nullptr && array.GetName()[0] != '\0'
                               ? array.GetName()
                               : std::string("field ") + std::to_string(fields.size() + 1);
  if (array.GetNumberOfTuples() != static_cast<vtkIdType>(count)) {
    notes.push_back("field " + name + " was left out: it does not have one value for each " + of);
    return;
  }
  const bool added = add_fields(fields, name, count, array.GetNumberOfComponents(), [&](std::size_t i, int component) {
    return array.GetComponent(static_cast<vtkIdType>(i), component);
  });
  if (!added) notes.push_back("field " + name + " was left out: it has more than nine numbers for each " + of);
}

// The active scalars first, then in the file's order.
void add_arrays(std::vector<VertexField>& fields, vtkDataSetAttributes& data, std::size_t count, const char* of,
                std::vector<std::string>& notes) {
  vtkDataArray* active = data.GetScalars();
  if (active != nullptr && !is_ghost_array(active->GetName())) add_array(fields, *active, count, of, notes);
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data.GetArray(i);
    if (array == nullptr || array == active || is_ghost_array(array->GetName())) continue;
    add_array(fields, *array, count, of, notes);
  }
}

// Points and cells that are marked as copies of other pieces' or hidden.
std::vector<bool> ghosts(vtkDataSetAttributes& data, std::size_t count, int bits) {
  auto* marks = vtkUnsignedCharArray::SafeDownCast(data.GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (marks == nullptr || marks->GetNumberOfComponents() != 1 ||
      marks->GetNumberOfTuples() != static_cast<vtkIdType>(count)) {
    return {};
  }
  std::vector<bool> blanked(count);
  for (std::size_t i = 0; i < count; ++i) blanked[i] = (marks->GetValue(static_cast<vtkIdType>(i)) & bits) != 0;
  return blanked;
}

void add_attributes(MeshCells& cells, vtkDataSet& data, std::size_t points, std::size_t count) {
  add_arrays(cells.point_fields, *data.GetPointData(), points, "point", cells.notes);
  add_arrays(cells.cell_fields, *data.GetCellData(), count, "cell", cells.notes);
  cells.blanked_points = ghosts(*data.GetPointData(), points, vtkDataSetAttributes::HIDDENPOINT);
  cells.blanked_cells =
      ghosts(*data.GetCellData(), count, vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::DUPLICATECELL);
}

// ---- geometry

void check_count(vtkIdType points, const std::string& path) {
  if (points < 0 || static_cast<std::uint64_t>(points) >= no_index) {
    throw InputError(path, 0, std::to_string(points) + " points; at most 4,294,967,294 can be read");
  }
}

void add_points(MeshCells& cells, vtkDataSet& data, const std::string& path) {
  const vtkIdType count = data.GetNumberOfPoints();
  check_count(count, path);
  cells.points.reserve(cells.points.size() + static_cast<std::size_t>(count));
  for (vtkIdType p = 0; p < count; ++p) {
    double at[3];
    data.GetPoint(p, at);
    cells.points.emplace_back(at[0], at[1], at[2]);
  }
}

struct KnownShape {
  CellShape shape;
  bool curved = false;  // more points than corners, which come first
};

std::optional<KnownShape> shape_of(int type) {
  switch (type) {
    case VTK_TETRA:
      return KnownShape{CellShape::tetrahedron};
    case VTK_VOXEL:
    case VTK_HEXAHEDRON:
      return KnownShape{CellShape::hexahedron};
    case VTK_WEDGE:
      return KnownShape{CellShape::wedge};
    case VTK_PYRAMID:
      return KnownShape{CellShape::pyramid};
    case VTK_PENTAGONAL_PRISM:
      return KnownShape{CellShape::pentagonal_prism};
    case VTK_HEXAGONAL_PRISM:
      return KnownShape{CellShape::hexagonal_prism};
    case VTK_QUADRATIC_TETRA:
    case VTK_LAGRANGE_TETRAHEDRON:
    case VTK_BEZIER_TETRAHEDRON:
      return KnownShape{CellShape::tetrahedron, true};
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
    case VTK_LAGRANGE_HEXAHEDRON:
    case VTK_BEZIER_HEXAHEDRON:
      return KnownShape{CellShape::hexahedron, true};
    case VTK_QUADRATIC_WEDGE:
    case VTK_QUADRATIC_LINEAR_WEDGE:
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
    case VTK_LAGRANGE_WEDGE:
    case VTK_BEZIER_WEDGE:
      return KnownShape{CellShape::wedge, true};
    case VTK_QUADRATIC_PYRAMID:
    case VTK_LAGRANGE_PYRAMID:
    case VTK_BEZIER_PYRAMID:
      return KnownShape{CellShape::pyramid, true};
    default:
      return {};
  }
}

// The arrays of an unstructured grid, every index of them checked before it is used.
class GridCells {
 public:
  GridCells(vtkUnstructuredGrid& grid, const std::string& path) : grid_(grid), path_(path) {
    vtkCellArray* list = grid.GetCells();
    types_ = grid.GetCellTypesArray();
    const bool any = list != nullptr && list->GetNumberOfCells() > 0;
    if (any && (types_ == nullptr || types_->GetNumberOfTuples() != list->GetNumberOfCells())) {
      throw InputError(path, 0, "the cells' types are missing, or not as many as cells");
    }
    if (!any) return;
    list->ConvertTo64BitStorage();
    offsets_ = list->GetOffsetsArray64();
    corners_ = list->GetConnectivityArray64();
    count_ = static_cast<std::size_t>(offsets_->GetNumberOfValues() - 1);
  }
  std::size_t count() const { return count_; }

  void append(std::size_t c, MeshCells& cells) {
    const int type = types_->GetValue(static_cast<vtkIdType>(c));
    const std::int64_t begin = offsets_->GetValue(static_cast<vtkIdType>(c));
    const std::int64_t end = offsets_->GetValue(static_cast<vtkIdType>(c + 1));
    if (begin < 0 || end < begin || end > corners_->GetNumberOfValues()) {
      throw InputError(path_, 0, "cell " + std::to_string(c) + " lies beyond the list of corners");
    }
    const auto size = static_cast<std::size_t>(end - begin);
    const auto known = shape_of(type);
    FileCell kind = FileCell::without_volume;
    CellShape shape = CellShape::tetrahedron;
    if (known && size >= corner_count(known->shape)) {
      kind = FileCell::simple;
      shape = known->shape;
      curved_ += known->curved ? 1 : 0;
      static constexpr std::int64_t voxel[] = {0, 1, 3, 2, 4, 5, 7, 6};
      for (std::int64_t i = 0; i < static_cast<std::int64_t>(corner_count(shape)); ++i) {
        cells.corners.push_back(corner(begin + (type == VTK_VOXEL ? voxel[i] : i)));
      }
    } else if (known) {
      throw InputError(path_, 0,
                       "cell " + std::to_string(c) + " has " + std::to_string(size) + " corners, expected " +
                           std::to_string(corner_count(known->shape)));
    } else if (type == VTK_POLYHEDRON) {
      kind = FileCell::polyhedron;
      append_faces(c, cells);
    } else if (type == VTK_CONVEX_POINT_SET || type > VTK_HEXAGONAL_PRISM) {
      ++unknown_;
    }
    cells.kinds.push_back(kind);
    cells.shapes.push_back(shape);
    cells.first.push_back(cells.corners.size());
  }

  void add_notes(std::vector<std::string>& notes) const {
    if (curved_ > 0) notes.push_back(std::to_string(curved_) + " curved cells are shown with straight edges");
    if (unknown_ > 0) {
      notes.push_back(std::to_string(unknown_) +
                      " cells of kinds that are not read (curved faces and edges, convex "
                      "point sets, …) were left out");
    }
  }

 private:
  std::uint64_t corner(std::int64_t at) const {
    // A negative one becomes too large, which is found out with the others.
    return static_cast<std::uint64_t>(corners_->GetValue(at));
  }

  void append_faces(std::size_t c, MeshCells& cells) {
    vtkIdTypeArray* faces = grid_.GetFaces();
    vtkIdTypeArray* locations = grid_.GetFaceLocations();
    const auto fail = [&] { throw InputError(path_, 0, "the faces of cell " + std::to_string(c) + " are missing"); };
    if (faces == nullptr || locations == nullptr || static_cast<vtkIdType>(c) >= locations->GetNumberOfValues()) fail();
    vtkIdType at = locations->GetValue(static_cast<vtkIdType>(c));
    const vtkIdType size = faces->GetNumberOfValues();
    const auto next = [&] {
      if (at < 0 || at >= size) fail();
      return faces->GetValue(at++);
    };
    for (vtkIdType left = next(); left > 0; --left) {
      vtkIdType corners = next();
      if (corners < 0 || corners > size - at) fail();
      cells.corners.push_back(static_cast<std::uint64_t>(corners));
      while (corners-- > 0) cells.corners.push_back(static_cast<std::uint64_t>(next()));
    }
  }

  vtkUnstructuredGrid& grid_;
  const std::string& path_;
  vtkUnsignedCharArray* types_ = nullptr;
  vtkTypeInt64Array* offsets_ = nullptr;
  vtkTypeInt64Array* corners_ = nullptr;
  std::size_t count_ = 0;
  std::size_t curved_ = 0;
  std::size_t unknown_ = 0;
};

void add_unstructured(MeshCells& cells, vtkUnstructuredGrid& grid, const std::string& path, Progress& progress) {
  GridCells list(grid, path);
  cells.kinds.reserve(list.count());
  cells.shapes.reserve(list.count());
  cells.first.reserve(list.count() + 1);
  cells.corners.reserve(4 * list.count());
  for (std::size_t c = 0; c < list.count(); ++c) {
    if (c % 65536 == 0) progress.check();
    list.append(c, cells);
  }
  list.add_notes(cells.notes);
  add_attributes(cells, grid, cells.points.size(), list.count());
}

void add_block(MeshCells& cells, const int (&dimensions)[3]) {
  StructuredBlock block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block.points[axis] = static_cast<std::uint64_t>(std::max(dimensions[axis], 0));
  }
  if (!cells.blocks.empty()) {
    const StructuredBlock& before = cells.blocks.back();
    block.first_point = before.first_point + before.points[0] * before.points[1] * before.points[2];
    block.first_cell = before.first_cell + (before.points[0] - 1) * (before.points[1] - 1) * (before.points[2] - 1);
  }
  cells.blocks.push_back(block);
}

MeshCells cells_of(vtkDataSet* data, const std::string& path, MeshCells cells, Progress& progress) {
  if (data == nullptr) throw InputError(path, 0, "damaged or incomplete: there is nothing in it");
  check_count(data->GetNumberOfPoints(), path);
  int dimensions[3] = {0, 0, 0};
  if (auto* structured = vtkStructuredGrid::SafeDownCast(data)) {
    structured->GetDimensions(dimensions);
  } else if (auto* image = vtkImageData::SafeDownCast(data)) {
    image->GetDimensions(dimensions);
  } else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data)) {
    rectilinear->GetDimensions(dimensions);
  } else if (auto* unstructured = vtkUnstructuredGrid::SafeDownCast(data)) {
    add_points(cells, *data, path);
    add_unstructured(cells, *unstructured, path, progress);
    return cells;
  } else {
    throw InputError(path, 0,
                     std::string("holds ") + data->GetClassName() +
                         "; expected a grid with volume: unstructured, structured, rectilinear or an image");
  }
  add_block(cells, dimensions);
  const auto& [i, j, k] = cells.blocks.back().points;
  if (static_cast<std::uint64_t>(data->GetNumberOfPoints()) != i * j * k) {
    throw InputError(path, 0, "the number of points does not match the dimensions");
  }
  add_points(cells, *data, path);
  const std::uint64_t count = i > 1 && j > 1 && k > 1 ? (i - 1) * (j - 1) * (k - 1) : 0;
  if (count > 0) add_attributes(cells, *data, cells.points.size(), count);
  return cells;
}

// ---- PLOT3D

// Density, momentum and energy, and the pressure of an ideal gas where those allow one everywhere.
void add_solution(MeshCells& cells, vtkPointData& data, std::size_t count, const std::string& path) {
  vtkDataArray* density = data.GetArray("Density");
  vtkDataArray* momentum = data.GetArray("Momentum");
  vtkDataArray* energy = data.GetArray("StagnationEnergy");
  for (vtkDataArray* array : {density, momentum, energy}) {
    if (array == nullptr || array->GetNumberOfTuples() != static_cast<vtkIdType>(count)) {
      throw InputError(path, 0, "damaged or incomplete: no density, momentum and energy at each point");
    }
  }
  const auto value = [](vtkDataArray* array) {
    return [array](std::size_t i, int c) { return array->GetComponent(static_cast<vtkIdType>(i), c); };
  };
  std::vector<VertexField> fields;
  add_fields(fields, "Density", count, 1, value(density));
  add_fields(fields, "Energy", count, 1, value(energy));
  add_fields(fields, "Momentum", count, 3, value(momentum));
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

}  // namespace

MeshCells read_vtk_cells(const std::string& path, const std::string& format, Progress& progress) {
  check_vtk_file(path, format);
  MeshCells cells;
  if (format == "vtu") {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    run(*reader, path, progress, cells.notes);
    return cells_of(reader->GetOutput(), path, std::move(cells), progress);
  }
  vtkNew<vtkDataSetReader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllFieldsOn();
  run(*reader, path, progress, cells.notes);
  return cells_of(reader->GetOutput(), path, std::move(cells), progress);
}

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
  vtkNew<vtkMultiBlockPLOT3DReader> reader;
  reader->AutoDetectFormatOff();
  reader->SetXYZFileName(path.c_str());
  if (!solution.empty()) reader->SetQFileName(solution.c_str());
  reader->SetBinaryFile(layout->text ? 0 : 1);
  reader->SetHasByteCount(layout->record_marks ? 1 : 0);
  reader->SetMultiGrid(layout->multi_grid ? 1 : 0);
  reader->SetIBlanking(layout->iblank ? 1 : 0);
  reader->SetDoublePrecision(layout->double_precision ? 1 : 0);
  if (layout->big_endian) {
    reader->SetByteOrderToBigEndian();
  } else {
    reader->SetByteOrderToLittleEndian();
  }
  MeshCells cells;
  run(*reader, path, progress, cells.notes);
  vtkMultiBlockDataSet* output = reader->GetOutput();
  if (output == nullptr || output->GetNumberOfBlocks() != layout->grids.size()) {
    throw InputError(path, 0, "damaged or incomplete: not all grids are in it");
  }
  for (unsigned b = 0; b < output->GetNumberOfBlocks(); ++b) {
    auto* grid = vtkStructuredGrid::SafeDownCast(output->GetBlock(b));
    if (grid == nullptr) throw InputError(path, 0, "damaged or incomplete: grid " + std::to_string(b + 1));
    int dimensions[3] = {0, 0, 0};
    grid->GetDimensions(dimensions);
    add_block(cells, dimensions);
    add_points(cells, *grid, path);
    const auto count = static_cast<std::size_t>(grid->GetNumberOfPoints());
    if (!solution.empty()) add_solution(cells, *grid->GetPointData(), count, solution);
    if (!layout->iblank) continue;
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

}  // namespace atomesh::cli
