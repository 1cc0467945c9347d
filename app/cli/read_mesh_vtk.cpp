// .vtu and legacy .vtk by VTK's readers.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetReader.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <optional>

#include "app/cli/check_vtk_file.h"
#include "app/cli/mesh_cells.h"
#include "app/cli/run_vtk_reader.h"
#include "core/error.h"

namespace atomesh::cli {

namespace {

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
      kind = FileCell::unknown;
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
  std::array<std::uint64_t, 3> points{};
  for (std::size_t axis = 0; axis < 3; ++axis) points[axis] = static_cast<std::uint64_t>(std::max(dimensions[axis], 0));
  add_block(cells, points);
  const auto& [i, j, k] = cells.blocks.back().points;
  if (static_cast<std::uint64_t>(data->GetNumberOfPoints()) != i * j * k) {
    throw InputError(path, 0, "the number of points does not match the dimensions");
  }
  add_points(cells, *data, path);
  const std::uint64_t count = i > 1 && j > 1 && k > 1 ? (i - 1) * (j - 1) * (k - 1) : 0;
  if (count > 0) add_attributes(cells, *data, cells.points.size(), count);
  return cells;
}

}  // namespace

MeshCells read_vtk_cells(const std::string& path, const std::string& format, Progress& progress) {
  check_vtk_file(path, format);
  MeshCells cells;
  if (format == "vtu") {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    run_vtk_reader(*reader, path, progress, cells.notes);
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
  run_vtk_reader(*reader, path, progress, cells.notes);
  return cells_of(reader->GetOutput(), path, std::move(cells), progress);
}

}  // namespace atomesh::cli
