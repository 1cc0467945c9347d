#include "app/cli/peer_vtk_volume.h"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkColorTransferFunction.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProjectedTetrahedraMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridLinearRayIntegrator.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeZSweepMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/parallel.h"

namespace atomesh::cli {

namespace {

// The two that cast rays keep their picture to themselves.
class RayCastWithPicture final : public vtkUnstructuredGridVolumeRayCastMapper {
 public:
  static RayCastWithPicture* New() { VTK_STANDARD_NEW_BODY(RayCastWithPicture); }
  vtkTypeMacro(RayCastWithPicture, vtkUnstructuredGridVolumeRayCastMapper)

      Vec4f pixel(int column, int row_from_below) const {
    const auto width = static_cast<std::size_t>(ImageMemorySize[0]);
    const unsigned char* p =
        Image + 4 * (static_cast<std::size_t>(row_from_below) * width + static_cast<std::size_t>(column));
    return Vec4f(p[0], p[1], p[2], p[3]) / 255.0F;
  }
};

class ZSweepWithPicture final : public vtkUnstructuredGridVolumeZSweepMapper {
 public:
  static ZSweepWithPicture* New() { VTK_STANDARD_NEW_BODY(ZSweepWithPicture); }
  vtkTypeMacro(ZSweepWithPicture, vtkUnstructuredGridVolumeZSweepMapper)

      Vec4f pixel(int column, int row_from_below) const {
    const auto width = static_cast<std::size_t>(ImageMemorySize[0]);
    const float* p =
        RealRGBAImage + 4 * (static_cast<std::size_t>(row_from_below) * width + static_cast<std::size_t>(column));
    return {p[0], p[1], p[2], p[3]};
  }
};

void fill_grid(const Scene& scene, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(scene.vertices.size()));
  vtkNew<vtkFloatArray> values;
  values->SetName("value");
  values->SetNumberOfTuples(static_cast<vtkIdType>(scene.vertices.size()));
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    const Vec3f& p = scene.vertices[v];
    points->SetPoint(static_cast<vtkIdType>(v), p.x, p.y, p.z);
    values->SetValue(static_cast<vtkIdType>(v), scene.scalars[v]);
  }
  grid.SetPoints(points);
  grid.GetPointData()->SetScalars(values);
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(scene.tetrahedra.size()),
                       static_cast<vtkIdType>(4 * scene.tetrahedra.size()));
  for (const Tetrahedron& tetrahedron : scene.tetrahedra) {
    const vtkIdType corners[4] = {tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3]};
    cells->InsertNextCell(4, corners);
  }
  grid.SetCells(VTK_TETRA, cells);
}

void fill_property(const VolumeParameters& volume, vtkVolumeProperty& property) {
  vtkNew<vtkColorTransferFunction> color;
  vtkNew<vtkPiecewiseFunction> opacity;
  double last = -1.0;
  for (const ColorMapEntry& entry : volume.color_map.entries) {
    // VTK keeps one value for a scalar: where the map jumps its second one holds from the next float on.
    const double scalar = entry.scalar > last
                              ? entry.scalar
                              : std::nextafter(static_cast<float>(last), std::numeric_limits<float>::max());
    color->AddRGBPoint(scalar, entry.color.r, entry.color.g, entry.color.b);
    opacity->AddPoint(scalar, entry.color.a);
    last = scalar;
  }
  property.SetColor(color);
  property.SetScalarOpacity(opacity);
  property.SetScalarOpacityUnitDistance(1.0 / volume.alpha_length);
  property.SetInterpolationTypeToLinear();
  property.ShadeOff();
}

}  // namespace

std::string_view vtk_mapper_name(VtkMapper mapper) {
  switch (mapper) {
    case VtkMapper::ray_cast:
      return "VTK ray cast";
    case VtkMapper::ray_cast_linear:
      return "VTK ray cast, closed form";
    case VtkMapper::z_sweep:
      return "VTK Z sweep";
    case VtkMapper::projected_tetrahedra:
      return "VTK projected tetrahedra";
  }
  return "";
}

struct VtkVolumeScene::Parts {
  Vec3 center{0.0};  // what is subtracted from coordinates
  Bounds bounds;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkVolumeProperty> property;
  vtkNew<vtkUnstructuredGridLinearRayIntegrator> closed_form;
  vtkNew<vtkUnstructuredGridLinearRayIntegrator> closed_form_of_sweep;
  vtkNew<RayCastWithPicture> ray_cast;
  vtkNew<RayCastWithPicture> ray_cast_linear;
  vtkNew<ZSweepWithPicture> z_sweep;
  vtkNew<vtkProjectedTetrahedraMapper> projected;
  std::array<vtkNew<vtkVolume>, vtk_mappers.size()> volumes;  // in the order of vtk_mappers
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  VtkMapper last = VtkMapper::ray_cast;
  bool projected_before = false;

  vtkUnstructuredGridVolumeMapper* mapper(VtkMapper which) const {
    switch (which) {
      case VtkMapper::ray_cast:
        return ray_cast;
      case VtkMapper::ray_cast_linear:
        return ray_cast_linear;
      case VtkMapper::z_sweep:
        return z_sweep;
      case VtkMapper::projected_tetrahedra:
        break;
    }
    return projected;
  }

  void look(const Camera& camera, bool through_corners) const {
    vtkCamera* vtk = renderer->GetActiveCamera();
    const Vec3 eye = camera.eye - center;
    const Vec3 target = eye + camera.forward;
    vtk->SetPosition(eye.x, eye.y, eye.z);
    vtk->SetFocalPoint(target.x, target.y, target.z);
    vtk->SetViewUp(camera.up.x, camera.up.y, camera.up.z);
    const double half_height = 0.5 * camera.pixel * camera.height;
    vtk->SetParallelProjection(camera.projection == Projection::parallel);
    vtk->SetViewAngle(2.0 * std::atan(half_height) * 180.0 / std::numbers::pi);
    vtk->SetParallelScale(half_height);
    // The window's centre, in half windows. Lower left corners at our centres: what stood half a pixel right and up of
    // a corner stands at it.
    vtk->SetWindowCenter(through_corners ? 1.0 / camera.width : 0.0, through_corners ? 1.0 / camera.height : 0.0);
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p((corner & 1) != 0 ? bounds.max.x : bounds.min.x, (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                   (corner & 4) != 0 ? bounds.max.z : bounds.min.z);
      const double depth = glm::dot(p - camera.eye, camera.forward);
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
    const double margin = 1e-3 * (farthest - nearest);
    vtk->SetClippingRange(std::max(nearest - margin, 1e-4 * farthest), farthest + margin);
  }
};

VtkVolumeScene::VtkVolumeScene(const Scene& scene, const Parameters& parameters) : parts_(std::make_unique<Parts>()) {
  if (std::getenv("DISPLAY") == nullptr) throw UnavailableError("VTK's volume mappers: no display");
  Parts& p = *parts_;
  p.center = scene.center;
  p.bounds = scene.bounds;
  fill_grid(scene, *p.grid);
  fill_property(parameters.volume, *p.property);
  for (RayCastWithPicture* caster : {p.ray_cast.Get(), p.ray_cast_linear.Get()}) {
    caster->SetImageSampleDistance(1.0F);
    caster->AutoAdjustSampleDistancesOff();
    caster->IntermixIntersectingGeometryOff();
    caster->SetNumberOfThreads(threads());
  }
  p.ray_cast_linear->SetRayIntegrator(p.closed_form);
  p.z_sweep->SetImageSampleDistance(1.0F);
  p.z_sweep->AutoAdjustSampleDistancesOff();
  p.z_sweep->IntermixIntersectingGeometryOff();
  p.z_sweep->SetRayIntegrator(p.closed_form_of_sweep);

  p.renderer->SetBackground(0.0, 0.0, 0.0);
  p.renderer->SetBackgroundAlpha(0.0);
  p.renderer->AutomaticLightCreationOff();
  for (const VtkMapper which : vtk_mappers) {
    vtkVolume* volume = p.volumes[static_cast<std::size_t>(which)];
    p.mapper(which)->SetInputData(p.grid);
    volume->SetMapper(p.mapper(which));
    volume->SetProperty(p.property);
    p.renderer->AddVolume(volume);
  }
  p.window->SetShowWindow(false);
  p.window->SetUseOffScreenBuffers(true);
  p.window->SetMultiSamples(0);
  p.window->SetAlphaBitPlanes(1);
  p.window->AddRenderer(p.renderer);
}

VtkVolumeScene::~VtkVolumeScene() = default;

void VtkVolumeScene::draw(VtkMapper mapper, const Camera& camera) {
  Parts& p = *parts_;
  p.window->SetSize(camera.width, camera.height);
  // A new renderer in the memory of an old one of the same size takes its aspect for known, and has none.
  p.renderer->SetAspect(static_cast<double>(camera.width) / camera.height, 1.0);
  p.look(camera, mapper == VtkMapper::ray_cast || mapper == VtkMapper::ray_cast_linear);
  for (const VtkMapper which : vtk_mappers) {
    p.volumes[static_cast<std::size_t>(which)]->SetVisibility(which == mapper ? 1 : 0);
  }
  p.last = mapper;
  if (mapper == VtkMapper::projected_tetrahedra && !p.projected_before) {
    p.window->Render();  // binds no attributes before its first thousand cells, which are lost
    p.projected_before = true;
  }
  // Z sweep warns of edges between two vertices that it has moved to one pixel.
  const int warnings = vtkObject::GetGlobalWarningDisplay();
  if (mapper == VtkMapper::z_sweep) vtkObject::GlobalWarningDisplayOff();
  p.window->Render();
  p.window->WaitForCompletion();
  vtkObject::SetGlobalWarningDisplay(warnings);
}

Image VtkVolumeScene::image() const {
  const Parts& p = *parts_;
  const int* size = p.window->GetSize();
  Image image(size[0], size[1]);
  vtkNew<vtkUnsignedCharArray> window_pixels;
  if (p.last == VtkMapper::projected_tetrahedra) {
    p.window->GetRGBACharPixelData(0, 0, size[0] - 1, size[1] - 1, 0, window_pixels);
  }
  for (int row = 0; row < image.height; ++row) {
    const int from_below = image.height - 1 - row;
    for (int column = 0; column < image.width; ++column) {
      Vec4f& pixel = image.at(column, row);
      switch (p.last) {
        case VtkMapper::ray_cast:
          pixel = p.ray_cast->pixel(column, from_below);
          break;
        case VtkMapper::ray_cast_linear:
          pixel = p.ray_cast_linear->pixel(column, from_below);
          break;
        case VtkMapper::z_sweep:
          pixel = p.z_sweep->pixel(column, from_below);
          break;
        case VtkMapper::projected_tetrahedra: {
          const unsigned char* bytes = window_pixels->GetPointer(
              4 * (static_cast<vtkIdType>(from_below) * image.width + static_cast<vtkIdType>(column)));
          pixel = Vec4f(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0F;
          break;
        }
      }
    }
  }
  return image;
}

std::string VtkVolumeScene::driver() const {
  const auto* window = vtkOpenGLRenderWindow::SafeDownCast(parts_->window.Get());
  if (window == nullptr) return "unknown";
  const std::string report = const_cast<vtkOpenGLRenderWindow*>(window)->ReportCapabilities();
  const std::string key = "OpenGL renderer string:";
  const std::size_t at = report.find(key);
  if (at == std::string::npos) return "unknown";
  const std::size_t from = report.find_first_not_of(' ', at + key.size());
  return report.substr(from, report.find('\n', from) - from);
}

}  // namespace atomesh::cli
