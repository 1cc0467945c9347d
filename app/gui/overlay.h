// What lies over the picture: legend, scale bar, tripod of the axes, marks. The same for the window and saved pictures.
#pragma once

#include <optional>
#include <vector>

#include "app/gui/workspace.h"
#include "core/camera.h"
#include "core/image.h"
#include "render/legend.h"
#include "render/scene.h"

namespace atomesh::gui {

struct OverlayParts {
  std::optional<Legend> legend;
  std::optional<ScaleBar> scale_bar;
  bool tripod = false;
  // Named and coloured by what it points along: x, y, z; with a unit cell also a, b, c where they differ from them.
  std::vector<Mark> marks;
};

// Over `image`, a finished picture or the band of it that begins at first_row of `camera`'s; or over a transparent one
// of the same size, to be laid over a picture later. `ink` suits the background.
void draw_overlay(Image& image, int first_row, const Camera& camera, const Material& material, const Vec4f& background,
                  const OverlayParts& parts);

// The legend and scale bar of a picture of the scene, as far as the options ask. `max_thickness`: Å, for mode xray.
OverlayParts overlay_parts(const ViewOptions& options, const Scene& scene, const Material& material,
                           const Parameters& parameters, const Camera& camera, double max_thickness,
                           std::vector<Mark> marks);

}  // namespace atomesh::gui
