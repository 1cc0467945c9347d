#include "render/cpu/cpu_renderer.h"

#include "render/cpu/atom_balls.h"
#include "render/cpu/cell_projection.h"
#include "render/cpu/surface_modes.h"
#include "render/cpu/whole_picture_frame.h"

namespace atomesh {

namespace {

class CpuRenderer final : public Renderer {
 public:
  std::string_view name() const override { return "cpu"; }

  std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                 const PixelWindow& window, RenderStats&, Progress& progress) const override {
    progress.stage("render");
    return std::make_unique<WholePictureFrame>(
        window, [&scene, &camera, &parameters](RenderStats& stats, const Channels& channels, Progress& following) {
          switch (scene.mode) {
            case Mode::volume_surface:
            case Mode::volume:
              return draw_cell_projection(scene, camera, parameters, stats, following);
            case Mode::surface:
              return draw_surface(scene, camera, parameters, stats, channels, following);
            case Mode::xray:
              return draw_xray(scene, camera, parameters, stats, channels, following);
            case Mode::atoms:
              break;
          }
          return draw_atom_balls(scene, camera, parameters, stats, channels, following);
        });
  }
};

}  // namespace

const Renderer& cpu_renderer() {
  static const CpuRenderer renderer;
  return renderer;
}

}  // namespace atomesh
