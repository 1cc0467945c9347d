#include "app/cli/write_vtu.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <span>

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

// One value for each vertex, taken from its atom; `missing` for a vertex that is none.
template <class Array, class Value>
void add_point_data(vtkUnstructuredGrid& grid, const char* name, std::span<const Index> vertex_atom, Value missing,
                    auto value_of) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(vertex_atom.size()));
  for (std::size_t v = 0; v < vertex_atom.size(); ++v) {
    const Index atom = vertex_atom[v];
    array->SetValue(static_cast<vtkIdType>(v), atom == no_index ? missing : static_cast<Value>(value_of(atom)));
  }
  grid.GetPointData()->AddArray(array);
}

}  // namespace

void write_vtu(const std::string& path, const Material& material) {
  const TetMesh& mesh = material.mesh;
  vtkNew<vtkUnstructuredGrid> grid;

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    points->SetPoint(static_cast<vtkIdType>(v), p.x, p.y, p.z);
  }
  grid->SetPoints(points);

  // VTK_TETRA has the same orientation as ours: vertex 3 on the side the normal of 0, 1, 2 points to.
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(mesh.tetrahedra.size()),
                       static_cast<vtkIdType>(4 * mesh.tetrahedra.size()));
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    const vtkIdType corners[4] = {tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3]};
    cells->InsertNextCell(4, corners);
  }
  grid->SetCells(VTK_TETRA, cells);

  for (const VertexField& field : material.fields) {
    vtkNew<vtkFloatArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()));
    std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
    grid->GetPointData()->AddArray(array);
  }
  const std::span<const Index> atoms = mesh.vertex_atom;
  if (material.atoms.size() > 0) {
    add_point_data<vtkIntArray>(*grid, "species", atoms, -1, [&](Index a) { return material.atoms.species[a]; });
    add_point_data<vtkIntArray>(*grid, "atom", atoms, -1, [](Index a) { return a; });
  }
  const Defects& defects = material.defects;
  if (defects.present()) {
    add_point_data<vtkFloatArray>(*grid, "positional", atoms, 0.0F, [&](Index a) { return defects.positional[a]; });
    add_point_data<vtkFloatArray>(*grid, "vacancy", atoms, 0.0F, [&](Index a) { return defects.vacancy[a]; });
    add_point_data<vtkFloatArray>(*grid, "extra", atoms, 0.0F, [&](Index a) { return defects.extra[a]; });
  }
  for (const Column& column : material.atoms.columns) {
    add_point_data<vtkDoubleArray>(*grid, column.name.c_str(), atoms, 0.0, [&](Index a) { return column.values[a]; });
  }

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->WriteToOutputStringOn();
  if (writer->Write() == 0) throw Error(path + ": VTK could not write the grid");
  AtomicFile file(path);
  file.write(writer->GetOutputString());
  file.commit();
}

}  // namespace atomesh::cli
