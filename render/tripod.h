// Which way the axes point in a picture: arrows with letters, for x, y, z and for the crystal's own cell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/unit_cell.h"
#include "render/canvas.h"

namespace atomesh {

struct TripodArrow {
  std::string name;
  Vec3 direction{0.0};  // unit vector, Å of the file
  Vec3f color{0.0F};
};

// x, y, z in red, green, blue; and, where one of a, b, c points elsewhere than its x, y or z, a second tripod of a, b,
// c.
std::vector<std::vector<TripodArrow>> make_tripods(const std::optional<UnitCell>& cell);

// Where everything stands; made once for a picture, drawn as often as wanted, as LegendDrawing. In the lower left
// corner, above `bottom`: the row at which a scale bar begins, or the picture's height. Perspective is left out: what
// is shown is how the sample lies to the line of sight.
class TripodDrawing {
 public:
  TripodDrawing(const Camera& camera, const Vec4f& background, const std::vector<std::vector<TripodArrow>>& tripods,
                int bottom);

  void draw(Canvas& canvas) const;
  // What it may cover; none where the picture is too small for it.
  const std::optional<CanvasBox>& box() const { return box_; }

 private:
  struct Arrow {
    CanvasPoint from;
    CanvasPoint to;
    double toward;  // the viewer: 1 straight at him, -1 away
    std::string name;
    Vec4f color;
  };
  void draw_arrow(Canvas& canvas, const Arrow& arrow) const;
  void draw_letter(Canvas& canvas, const Arrow& arrow) const;

  double size_;  // of the letters, pixels
  Vec4f paper_;
  std::optional<CanvasBox> box_;
  std::vector<Arrow> arrows_;  // farthest first
};

}  // namespace atomesh
