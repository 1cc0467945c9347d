// What lies over the picture: legend, scale bar, tripod of the axes, marks. The same for the window and saved pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/gui/workspace.h"
#include "core/camera.h"
#include "core/image.h"
#include "render/canvas.h"
#include "render/legend.h"
#include "render/scene.h"

namespace atomesh::gui {

// A straight line between two places (Å) with a text at its middle: what was measured.
struct MeasuredLine {
  Vec3 from{0.0};
  Vec3 to{0.0};
  std::string text;
  bool operator==(const MeasuredLine&) const = default;
};

struct OverlayParts {
  std::optional<Legend> legend;
  std::optional<ScaleBar> scale_bar;
  bool tripod = false;  // x, y, z and, where they differ, the cell's a, b, c
  // A sphere as its outline, a point as a cross; beside it the text. Seen through whatever is before it; what is not in
  // front of the eye is left out.
  std::vector<Mark> marks;
  std::vector<MeasuredLine> lines;
};

// Over `image`, a finished picture or the band of it that begins at first_row of `camera`'s; or over a transparent one
// of the same size, to be laid over a picture later. Everything goes with the picture's size; ink suits the background.
void draw_overlay(Image& image, int first_row, const Camera& camera, const Material& material, const Vec4f& background,
                  const OverlayParts& parts);

// The legend and scale bar of a picture of the scene, as far as the options ask. `max_thickness`: Å, for mode xray.
OverlayParts overlay_parts(const ViewOptions& options, const Scene& scene, const Material& material,
                           const Parameters& parameters, const Camera& camera, double max_thickness,
                           std::vector<Mark> marks);

// What the picks look like in the view: around an atom a ring of the size its ball has, in a cell a cross; and between
// two of them the shortest way, through the box's periodic boundaries, with its length. Adds to marks and lines.
void add_picks(OverlayParts& parts, const std::vector<Pick>& picks, const Material& material,
               const Parameters& parameters);

// Where a point is in the picture; nothing where it is not in front of the eye. (As everywhere on a canvas, the centre
// of the first pixel is (0.5, 0.5).)
std::optional<CanvasPoint> canvas_point(const Camera& camera, const Vec3& point);
// The outline of a sphere: so many points around. Empty where a part of it is not in front of the eye.
std::vector<CanvasPoint> sphere_outline(const Camera& camera, const Vec3& center, double radius, int points = 128);

}  // namespace atomesh::gui
