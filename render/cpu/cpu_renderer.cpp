#include "render/cpu/cpu_renderer.h"

#include "render/cpu/atom_balls.h"
#include "render/cpu/cell_projection.h"
#include "render/cpu/surface_modes.h"
#include "render/solids.h"

namespace atomesh {

namespace {

class CpuRenderer final : public Renderer {
 public:
  std::string_view name() const override { return "cpu"; }

  std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                 const PixelWindow& window, RenderStats& stats, Progress& progress) const override {
    progress.stage("render");
    switch (scene.mode) {
      case Mode::surface:
        return prepare_surface(scene, camera, parameters, window, stats, progress);
      case Mode::xray:
        return prepare_xray(scene, camera, parameters, window, stats, progress);
      case Mode::atoms:
        return prepare_atom_balls(scene, camera, parameters, window, stats, progress);
      case Mode::volume_surface:
      case Mode::volume:
        break;
    }
    return with_solids(prepare_cell_projection(scene, camera, parameters, window, stats, progress), *this, scene,
                       camera, parameters, window, stats, progress);
  }
};

}  // namespace

const Renderer& cpu_renderer() {
  static const CpuRenderer renderer;
  return renderer;
}

}  // namespace atomesh
