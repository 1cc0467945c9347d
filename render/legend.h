// What the colours of a picture mean, and how long an Å is in it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/material.h"
#include "core/parameters.h"
#include "render/scene.h"

namespace atomesh {

// A range of values with the colour of each.
struct LegendScale {
  double min = 0.0;
  double max = 1.0;
  std::function<Vec4f(double)> color;  // of a value's pixel in the picture, not premultiplied
  // A value that is marked: where the colour stops changing.
  std::optional<double> mark{};
  std::string mark_text{};
  // Whether there are values beyond the ends, which then have the ends' colours.
  bool below = false;
  bool above = false;
};

struct LegendEntry {
  std::string name;
  Vec3f color;
};

// Either a scale or entries.
struct Legend {
  std::string title;  // with the unit: "thickness, Å"; may be empty
  std::optional<LegendScale> scale{};
  std::vector<LegendEntry> entries{};
  bool balls = false;  // entries are shown as discs, else as squares
};

// From 0 to `max_thickness` (Å) the colours as they are drawn: opacity min(1, alpha_length · thickness) over the
// picture's background, the thickness marked from which on it is 1. A mesh without atoms is in a unit that its file
// does not say: then without unit, here and below.
Legend xray_legend(const XrayParameters& parameters, const Vec4f& background, double max_thickness,
                   bool angstroms = true);

// What the colour map's [0,1] stands for.
struct ShownScalar {
  std::string name;  // with its unit where it has one
  double min = 0.0;
  double max = 1.0;
  bool below = false;  // there are values below min
  bool above = false;
};
// The colour map without its opacities. A scalar that is the same everywhere has the colour of the map's middle.
Legend color_map_legend(const ColorMap& map, const ShownScalar& scalar);

// The colours that are added up; what has the multiplier 0 is left out, and the defects all are where there are none.
Legend volume_surface_legend(const VolumeSurfaceParameters& parameters, bool defects);

// The species of the balls in the scene with their colours, in the order of the table of species.
Legend atoms_legend(const Scene& scene, const Atoms& atoms);

// The legend of the scene's mode: in the modes of the volume, that of the field where one is shown. Nothing for mode
// surface, whose one colour is that of the lights and the material, or when the picture shows nothing. `max_thickness`
// is for mode xray: the largest of Channels::thickness.
std::optional<Legend> make_legend(const Scene& scene, const Material& material, const Parameters& parameters,
                                  double max_thickness);

// A length of 1, 2 or 5 times a power of ten, and how long it is in the picture.
struct ScaleBar {
  double length = 0.0;  // Å
  double pixels = 0.0;
  std::string text;  // "20 Å", "5 nm", "5 units"; in perspective "20 Å at center"
};
// The longest that takes at most a fifth of the picture's width. In perspective it holds at the depth of `center` (Å,
// in the file's coordinates); nothing where that is not in front of the eye.
std::optional<ScaleBar> make_scale_bar(const Camera& camera, const Vec3& center, bool angstroms = true);

}  // namespace atomesh
