// Every value a user can set for display and rendering (the seed's manual, B.6.2 and B.6.3), as one plain struct, and
// the table that names, bounds and explains each. The CLI's --set, the window's forms, the .crf file and the reference
// documentation all come from the table's rows.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/color_map.h"
#include "core/geometry.h"

namespace atomesh {

enum class Mode { volume_surface, volume, surface, xray, atoms };
enum class Shading { flat, smooth };
// What stands in the volume of mode volume, opaque and lit as in its own mode: nothing, balls for the atoms with a
// defect (above AtomsParameters::regular_limit), balls for all atoms, the surface where rays leave it for
// good.
enum class VolumeSolid { none, defects, atoms, walls };
enum class Projection { perspective, parallel };
// How a ray's segment in a cell is integrated in the modes volume-surface and volume, from its two ends.
//   exact: closed form; colour and opacity are linear between the knots of the colour map, and every knot counts
//   linear: closed form of colour and opacity that are linear from end to end, knots within the cell left out
//   preintegrated: as linear, its one integral looked up in a table (partial pre-integration, Moreland & Angel 2004)
//   sampled: midpoint samples (the seed's)
enum class Integrator { exact, linear, preintegrated, sampled };

// Lights are fixed to the viewer: position in the camera's axes (x right, y up, z towards the viewer) about the
// sample's centre, in units of the sample's bounding radius.
struct Light {
  bool enabled = false;
  Vec3f position{0.0F, 0.0F, 1.0F};
  Vec3f color{1.0F, 1.0F, 1.0F};
  float intensity = 1.0F;
  bool operator==(const Light&) const = default;
};

// Only atoms with normal·position <= distance (or >=) are shown. Å, in the coordinates of the file.
struct CutPlane {
  enum class Side { less_equal, greater_equal };
  bool enabled = false;
  Vec3 normal{1.0, 0.0, 0.0};
  Side side = Side::less_equal;
  double distance = 0.0;
  bool operator==(const CutPlane&) const = default;
  bool keeps(const Vec3& p) const {
    const double d = glm::dot(normal, p);
    return !enabled || (side == Side::less_equal ? d <= distance : d >= distance);
  }
};

inline constexpr int max_lights = 8;
inline constexpr int max_cut_planes = 8;

// B.6.3.1. Colour of atom a = base + positional·multiplier·color + extra·… + vacancy·…, RGBA (seed 5.3.1); A is the
// opacity coefficient, clamped to [0,1]. A sum brighter than 1 is divided by its largest component, which keeps its
// hue: clamped, the strongest defects would all be white.
struct VolumeSurfaceParameters {
  double alpha_length = 0.25;  // 1/Å: extinction = alpha_length · A
  double face_alpha = 0.15;    // opacity of a front-facing surface polygon
  double ambient = 0.3;
  double diffuse = 0.6;
  double specular = 0.3;
  double shininess = 20.0;
  Vec4f base_color{0.25F, 0.4F, 0.55F, 0.02F};
  Vec4f positional_color{1.0F, 0.12F, 0.05F, 1.0F};
  double positional_multiplier = 1.0;
  Vec4f extra_color{0.05F, 0.75F, 0.15F, 1.0F};
  double extra_multiplier = 0.5;
  Vec4f vacancy_color{0.05F, 0.25F, 1.0F, 1.0F};
  double vacancy_multiplier = 0.5;
  bool operator==(const VolumeSurfaceParameters&) const = default;
};

// B.6.3.3. Scalar of an atom = weighted sum of its three defect values, normalised to [0,1] over the sample's atoms
// (range [0, max]); or a field of an imported mesh, normalised from its range. Coloured by the map.
struct VolumeParameters {
  // A name in Material::fields, or "defects"; empty ("auto"): the defects where the material has them, else the first
  // field that is not the same everywhere.
  std::string field;
  std::optional<double> range_low;   // of the field, what the colour map's 0 stands for; absent ("auto"): its smallest
  std::optional<double> range_high;  // and 1; its largest
  double alpha_length = 0.25;        // 1/Å: extinction = alpha_length · A
  double positional_multiplier = 1.0;
  double extra_multiplier = 1.0;
  double vacancy_multiplier = 1.0;
  ColorMap color_map = preset_color_map("viridis");
  VolumeSolid solid = VolumeSolid::none;
  bool operator==(const VolumeParameters&) const = default;
};

// Of the renderer "havs": what is done about pixels whose cells were drawn in a wrong order.
//   lists: their cells are sorted pixel by pixel
//   k_buffer: they go through a buffer that keeps k of them; pixels that are too far out of order for it stay wrong
//   none: nothing
enum class HavsOrder { lists, k_buffer, none };
// Of the same: how a ray's segment in a cell is integrated. exact: closed form, every knot of the colour map counts;
// table: looked up in a pre-integration table; automatic: the table, on software what render/gl/map_ramps.h says.
enum class HavsIntegration { automatic, exact, table };
struct HavsParameters {
  HavsOrder order = HavsOrder::lists;
  int k = 16;
  int memory = 256;  // MB, for lists or buffers; with less the cells are drawn more often
  HavsIntegration integration = HavsIntegration::automatic;
  double table_error = 0.001;  // of a segment's colour; where no table is so accurate, exact is taken
  bool operator==(const HavsParameters&) const = default;
};

// B.6.3.2
struct SurfaceParameters {
  Vec3f color{0.75F, 0.75F, 0.72F};  // ambient and diffuse
  Vec3f emission{0.0F, 0.0F, 0.0F};
  Vec3f specular{0.35F, 0.35F, 0.35F};
  double shininess = 30.0;
  bool operator==(const SurfaceParameters&) const = default;
};

// B.6.3.4. Opacity of a pixel = min(1, alpha_length · thickness), thickness the length of the ray inside the sample.
struct XrayParameters {
  double alpha_length = 0.005;      // 1/Å
  Vec3f color{0.05F, 0.05F, 0.1F};  // dark, to be seen before the white background
  bool operator==(const XrayParameters&) const = default;
};

// B.6.3.5
struct AtomsParameters {
  double scale = 1.0;            // 1 draws each atom with its species' radius
  double regular_opacity = 1.0;  // of atoms none of whose defect values is above regular_limit
  double regular_limit = 0.0;
  std::map<std::string, Vec3f, std::less<>> colors;  // by species name; absent: default_species_color
  std::map<std::string, bool, std::less<>> visible;  // by species name; absent: visible
  std::map<std::string, double, std::less<>> radii;  // Å, by species name; absent: the material's own
  bool operator==(const AtomsParameters&) const = default;
};

struct Parameters {
  Mode mode = Mode::volume_surface;
  Shading shading = Shading::smooth;
  Vec4f background{1.0F, 1.0F, 1.0F, 1.0F};  // A < 1 leaves the picture's background transparent
  std::array<Light, max_lights> lights = default_lights();
  std::array<CutPlane, max_cut_planes> cut_planes{};
  Integrator integrator = Integrator::exact;
  int samples_per_cell = 4;  // of Integrator::sampled (the seed's NumOfSamples)
  int supersampling = 1;     // n×n rays a pixel
  // The view; the camera is made from it by make_camera().
  double azimuth = 30.0;    // degrees, about +z; 0 looks along +y (front)
  double elevation = 20.0;  // degrees above the xy plane
  double roll = 0.0;        // degrees about the viewing direction, counter-clockwise
  double zoom = 1.0;        // 1 shows the whole sample
  Vec3 pan{0.0, 0.0, 0.0};  // Å, added to the centre of the sample as the point looked at
  Projection projection = Projection::perspective;
  double field_of_view = 30.0;  // degrees, of the shorter side of the picture
  VolumeSurfaceParameters volume_surface;
  VolumeParameters volume;
  SurfaceParameters surface;
  XrayParameters xray;
  AtomsParameters atoms;
  HavsParameters havs;

  static std::array<Light, max_lights> default_lights();
  bool operator==(const Parameters&) const = default;
};

// What a value is, for forms and for messages.
enum class ParameterType { boolean, integer, real, choice, text, rgb, rgba, vector, color_map };

struct ParameterRow {
  std::string key;  // "volume_surface.face_alpha", "light.1.position", "atoms.color.<species>"
  ParameterType type;
  std::string group;  // heading in forms and documentation: "Display", "Lights", "Volume and surface", …
  std::string label;  // "Face alpha constant", as in the manual where it has the entry
  std::string unit;   // "", "Å", "1/Å", "degrees"
  double min;         // range of a number (and of each component of a colour or vector); ignored for boolean, choice
  double max;
  std::vector<std::string> choices;  // of a choice
  std::string help;                  // one or two sentences
};

// All rows in the order of the manual. Keys of lights and cut planes are counted from 1; keys that end in "<species>"
// stand for one key per species name.
const std::vector<ParameterRow>& parameter_table();
// The row of a key ("atoms.color.Na" finds "atoms.color.<species>"). Throws UsageError naming the nearest key.
const ParameterRow& parameter_row(std::string_view key);

// Sets one value from text: "0.3", "true", "smooth", "#rrggbb" or "#rrggbbaa" or "0.1,0.2,0.3[,0.4]" for colours,
// "x,y,z" for vectors, "viridis" or "0:#00000000 0.5:#ff0000 1:0.1,0.2,0.3,0.4" for colour maps. "auto" for a species'
// colour or radius, a field or a range goes back to its own. Throws UsageError with key, text and what was expected
// (range, choices); `parameters` is then unchanged.
void set_parameter(Parameters& parameters, std::string_view key, std::string_view text);
// What set_parameter takes for a row, as its messages say it: "a number from 0 to 1", "flat or smooth".
std::string expected_value(const ParameterRow& row);
// The value as text that set_parameter reads back to exactly the same value.
std::string get_parameter(const Parameters& parameters, std::string_view key);

// Every key there is for a sample with these species, in the order of the table.
std::vector<std::string> parameter_keys(const std::vector<std::string>& species = {});
// Throws UsageError naming the first value that set_parameter would refuse (a struct can be filled with anything).
void check_parameters(const Parameters& parameters);
// The reference documentation: one Markdown table a group, with key, range, default and meaning of each row.
std::string parameter_documentation();

std::string_view mode_name(Mode mode);       // "volume-surface", "volume", "surface", "xray", "atoms"
Mode mode_from_name(std::string_view name);  // throws UsageError naming the nearest

}  // namespace atomesh
