#include "app/cli/peer_vtk_decimation.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridQuadricDecimation.h>

#include <chrono>
#include <cmath>
#include <ctime>

namespace atomesh::cli {

VtkDecimation decimate_with_vtk(const TetMesh& mesh, std::span<const float> scalars, double reduction) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  vtkNew<vtkFloatArray> values;
  values->SetName("value");
  values->SetNumberOfTuples(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    points->SetPoint(static_cast<vtkIdType>(v), p.x, p.y, p.z);
    values->SetValue(static_cast<vtkIdType>(v), scalars[v]);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(values);
  grid->GetPointData()->SetActiveScalars("value");
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(mesh.tetrahedra.size()),
                       static_cast<vtkIdType>(4 * mesh.tetrahedra.size()));
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    const vtkIdType corners[4] = {tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3]};
    cells->InsertNextCell(4, corners);
  }
  grid->SetCells(10, cells);  // VTK_TETRA

  vtkNew<vtkUnstructuredGridQuadricDecimation> decimation;
  decimation->SetInputData(grid);
  decimation->SetScalarsName("value");
  decimation->SetTargetReduction(reduction);
  const std::clock_t cpu = std::clock();
  const auto start = std::chrono::steady_clock::now();
  decimation->Update();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;

  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;

  VtkDecimation result;
  result.ms = elapsed.count();
  result.cpu_ms = cpu_ms;
  result.tetrahedra_before = mesh.tetrahedra.size();
  vtkUnstructuredGrid* out = decimation->GetOutput();
  double volume_after = 0.0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < out->GetNumberOfCells(); ++c) {
    out->GetCellPoints(c, ids);
    if (ids->GetNumberOfIds() != 4) continue;
    std::array<Vec3, 4> corners;
    for (vtkIdType i = 0; i < 4; ++i) {
      Vec3& p = corners[static_cast<std::size_t>(i)];
      out->GetPoint(ids->GetId(i), &p.x);
    }
    const double volume = signed_volume(corners[0], corners[1], corners[2], corners[3]);
    ++result.tetrahedra_after;
    result.inverted += volume > 0.0 ? 0 : 1;
    volume_after += volume;
  }
  const double volume_before = volume(mesh);
  result.volume_change = std::abs(volume_after - volume_before) / volume_before;
  return result;
}

}  // namespace atomesh::cli
