#include "core/parameter_table.h"

namespace atomesh {

namespace {

constexpr double far = 1e9;  // Å; beyond it doubles resolve less than a hundredth of an atom after a few operations

class Table {
 public:
  std::vector<ParameterEntry> entries;

  void group(std::string name) { group_ = std::move(name); }

  // A value that is a member of the struct; `locate` returns a reference to it.
  template <class Locate>
  void add(std::string key, ParameterType type, std::string label, std::string unit, double min, double max,
           std::string help, Locate locate) {
    entries.push_back({{std::move(key), type, group_, std::move(label), std::move(unit), min, max, {}, std::move(help)},
                       [locate](Parameters& p) -> ParameterSlot { return &locate(p); }});
  }

  template <class Locate>
  void real(std::string key, std::string label, std::string unit, double min, double max, std::string help,
            Locate locate) {
    add(std::move(key), ParameterType::real, std::move(label), std::move(unit), min, max, std::move(help), locate);
  }

  template <class Locate>
  void rgb(std::string key, std::string label, std::string help, Locate locate) {
    add(std::move(key), ParameterType::rgb, std::move(label), "", 0.0, 1.0, std::move(help), locate);
  }

  template <class Locate>
  void rgba(std::string key, std::string label, std::string help, Locate locate) {
    add(std::move(key), ParameterType::rgba, std::move(label), "", 0.0, 1.0, std::move(help), locate);
  }

  template <class Locate>
  void direction(std::string key, std::string label, std::string unit, double max, std::string help, Locate locate) {
    add(std::move(key), ParameterType::vector, std::move(label), std::move(unit), -max, max, std::move(help), locate);
    entries.back().slot = [locate](Parameters& p) -> ParameterSlot { return DirectionSlot{&locate(p)}; };
  }

  template <class Locate>
  void name(std::string key, std::string label, std::string help, Locate locate) {
    entries.push_back({{std::move(key), ParameterType::text, group_, std::move(label), "", 0, 0, {}, std::move(help)},
                       [locate](Parameters& p) -> ParameterSlot { return NameSlot{&locate(p)}; }});
  }

  // An enumeration whose values are 0, 1, … in the order of `choices`.
  template <class Locate>
  void choice(std::string key, std::string label, std::vector<std::string> choices, std::string help, Locate locate) {
    entries.push_back({{std::move(key), ParameterType::choice, group_, std::move(label), "", 0, 0, std::move(choices),
                        std::move(help)},
                       [locate](Parameters& p) -> ParameterSlot {
                         auto& value = locate(p);
                         using Enum = std::remove_reference_t<decltype(value)>;
                         return ChoiceSlot{static_cast<std::size_t>(value),
                                           [&value](std::size_t index) { value = static_cast<Enum>(index); }};
                       }});
  }

 private:
  std::string group_;
};

void add_display(Table& t) {
  t.group("Display");
  t.rgba(
      "background", "Background color", "Color behind the sample; opacity below 1 leaves it transparent in the PNG.",
      [](Parameters & p) -> auto& { return p.background; });
  t.choice(
      "mode", "Render mode", {"volume-surface", "volume", "surface", "xray", "atoms"},
      "What is drawn: defects inside a translucent sample with its surface, a volume of one scalar, the surface "
      "alone, the thickness, or a ball for each atom.",
      [](Parameters & p) -> auto& { return p.mode; });
  t.choice(
      "shading", "Shading mode", {"flat", "smooth"},
      "Normals of the surface: one for each triangle, or interpolated between its vertices.",
      [](Parameters & p) -> auto& { return p.shading; });
}

void add_lights(Table& t) {
  t.group("Lights");
  for (int i = 0; i < max_lights; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const std::string key = "light." + std::to_string(i + 1) + ".";
    const std::string label = "Light " + std::to_string(i + 1) + " ";
    t.add(
        key + "enabled", ParameterType::boolean, label + "enabled", "", 0, 1,
        "Whether the light shines. With none enabled only ambient and emitted light is left.",
        [n](Parameters & p) -> auto& { return p.lights[n].enabled; });
    t.add(
        key + "position", ParameterType::vector, label + "position", "sample radii", -1000, 1000,
        "x to the right, y up, z towards the viewer, about the center of the sample: lights stay with the viewer.",
        [n](Parameters & p) -> auto& { return p.lights[n].position; });
    t.rgb(
        key + "color", label + "color",
        "Color of the light.", [n](Parameters & p) -> auto& { return p.lights[n].color; });
    t.real(
        key + "intensity", label + "intensity", "", 0, 10,
        "Factor on the light's color.", [n](Parameters & p) -> auto& { return p.lights[n].intensity; });
  }
}

void add_cut_planes(Table& t) {
  t.group("Cut planes");
  for (int i = 0; i < max_cut_planes; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const std::string key = "cut_plane." + std::to_string(i + 1) + ".";
    const std::string label = "Cut plane " + std::to_string(i + 1) + " ";
    t.add(
        key + "enabled", ParameterType::boolean, label + "enabled", "", 0, 1,
        "Whether the plane cuts. Only atoms that satisfy every enabled plane are shown.", [n](Parameters & p) -> auto& {
          return p.cut_planes[n].enabled;
        });
    t.direction(
        key + "normal", label + "a, b, c", "", far,
        "The factors in a x + b y + c z ≤ d (or ≥ d); x, y, z as in the file. Not all zero.",
        [n](Parameters & p) -> auto& { return p.cut_planes[n].normal; });
    t.choice(
        key + "side", label + "op", {"less-equal", "greater-equal"},
        "Which atoms stay; <= and >= are read too.", [n](Parameters & p) -> auto& { return p.cut_planes[n].side; });
    t.real(
        key + "distance", label + "d", "Å", -far, far,
        "Right side of the equation; in Å where the normal has length 1.", [n](Parameters & p) -> auto& {
          return p.cut_planes[n].distance;
        });
  }
}

void add_volume_surface(Table& t) {
  t.group("Volume and surface");
  const auto of = [](auto member) {
    return [member](Parameters & p) -> auto& {
      return p.volume_surface.*member;
    };
  };
  using P = VolumeSurfaceParameters;
  t.real("volume_surface.alpha_length", "Volume alpha length constant", "1/Å", 0, 1e12,
         "Opacity of the volume: extinction is this times an atom's opacity coefficient.", of(&P::alpha_length));
  t.real("volume_surface.face_alpha", "Face alpha constant", "", 0, 1,
         "Opacity of surface polygons that face the viewer.", of(&P::face_alpha));
  t.real("volume_surface.ambient", "Ambient reflection coefficient", "", 0, 1, "Ambient reflection of the surface.",
         of(&P::ambient));
  t.real("volume_surface.diffuse", "Diffuse reflection coefficient", "", 0, 1, "Diffuse reflection of the surface.",
         of(&P::diffuse));
  t.real("volume_surface.specular", "Specular reflection coefficient", "", 0, 1, "Specular reflection of the surface.",
         of(&P::specular));
  t.real("volume_surface.shininess", "Shininess coefficient", "", 0, 1000, "Exponent of the specular highlight.",
         of(&P::shininess));
  t.rgba("volume_surface.base_color", "Base color",
         "Color of every atom, to which the defect colors are added; the fourth number is the opacity coefficient.",
         of(&P::base_color));
  t.rgba("volume_surface.positional_color", "Positional defect color", "Color of displaced neighborhoods.",
         of(&P::positional_color));
  t.real("volume_surface.positional_multiplier", "Positional defect multiplier", "", 0, 1e6,
         "Weight of the positional defect color.", of(&P::positional_multiplier));
  t.rgba("volume_surface.extra_color", "Extra atom defect color", "Color of atoms with an extra atom nearby.",
         of(&P::extra_color));
  t.real("volume_surface.extra_multiplier", "Extra atom defect multiplier", "", 0, 1e6,
         "Weight of the extra atom defect color.", of(&P::extra_multiplier));
  t.rgba("volume_surface.vacancy_color", "Vacancy defect color", "Color of atoms with a vacancy nearby.",
         of(&P::vacancy_color));
  t.real("volume_surface.vacancy_multiplier", "Vacancy defect multiplier", "", 0, 1e6,
         "Weight of the vacancy defect color.", of(&P::vacancy_multiplier));
}

void add_surface(Table& t) {
  t.group("Surface");
  const auto of = [](auto member) {
    return [member](Parameters & p) -> auto& {
      return p.surface.*member;
    };
  };
  using P = SurfaceParameters;
  t.rgb("surface.color", "Ambient and diffuse color", "Color of the surface's material under light.", of(&P::color));
  t.rgb("surface.emission", "Emission color", "Light the surface gives off by itself.", of(&P::emission));
  t.rgb("surface.specular", "Specular color", "Color of the highlight.", of(&P::specular));
  t.real("surface.shininess", "Shininess coefficient", "", 0, 1000, "Exponent of the highlight.", of(&P::shininess));
}

void add_volume(Table& t) {
  t.group("Volume");
  const auto of = [](auto member) {
    return [member](Parameters & p) -> auto& {
      return p.volume.*member;
    };
  };
  using P = VolumeParameters;
  t.real("volume.alpha_length", "Volume alpha length constant", "1/Å", 0, 1e12,
         "Opacity of the volume: extinction is this times the color map's opacity coefficient.", of(&P::alpha_length));
  t.real("volume.positional_multiplier", "Positional defect multiplier", "", 0, 1e6,
         "Weight of positional defects in an atom's scalar.", of(&P::positional_multiplier));
  t.real("volume.extra_multiplier", "Extra atom defect multiplier", "", 0, 1e6,
         "Weight of extra atom defects in an atom's scalar.", of(&P::extra_multiplier));
  t.real("volume.vacancy_multiplier", "Vacancy defect multiplier", "", 0, 1e6,
         "Weight of vacancy defects in an atom's scalar.", of(&P::vacancy_multiplier));
  t.name("volume.field", "Field",
         "The scalar that is shown: a field of an imported mesh, or defects; auto shows the defects where there are "
         "any, else the first field that varies.",
         of(&P::field));
  t.real("volume.range_low", "Range from", "", -1e300, 1e300,
         "Value of the field that the color map's 0 stands for; auto is its smallest.", of(&P::range_low));
  t.real("volume.range_high", "Range to", "", -1e300, 1e300,
         "Value of the field that the color map's 1 stands for; auto is its largest.", of(&P::range_high));
  t.add("volume.color_map", ParameterType::color_map, "Color map", "", 0, 1,
        "Color and opacity coefficient of the normalized scalar: a preset, or 2 to 32 entries scalar:color with blanks "
        "between them.",
        of(&P::color_map));
  t.choice("volume.solid", "Solids in the volume", {"none", "defects", "atoms", "walls"},
           "What stands in the volume, opaque: balls of the atoms with a defect, balls of all atoms (both as in mode "
           "atoms), or the surface seen from inside, behind everything (as in mode surface).",
           of(&P::solid));
}

void add_xray(Table& t) {
  t.group("X-ray");
  t.real(
      "xray.alpha_length", "XRAY alpha length constant", "1/Å", 0, 1e12,
      "Opacity for each Å of sample that a ray passes.", [](Parameters & p) -> auto& { return p.xray.alpha_length; });
  t.rgb(
      "xray.color", "XRAY base color", "Color of the sample.", [](Parameters & p) -> auto& { return p.xray.color; });
}

void add_atoms(Table& t) {
  t.group("Atom balls");
  t.real(
      "atoms.scale", "Atom-ball scale", "", 0.001, 100, "1 draws each atom with the radius of its species.",
      [](Parameters & p) -> auto& { return p.atoms.scale; });
  t.real(
      "atoms.regular_opacity", "Regular atom opacity", "", 0, 1,
      "Opacity of atoms without a defect in their neighborhood.",
      [](Parameters & p) -> auto& { return p.atoms.regular_opacity; });
  t.real(
      "atoms.regular_limit", "Regular atom limit", "", 0, 1e6,
      "Atoms none of whose three defect values is above this are regular; raise it to see only the strongest defects.",
      [](Parameters & p) -> auto& { return p.atoms.regular_limit; });
  t.rgb(
      "atoms.color.<species>", "Atom-ball colors", "Color of a species; \"auto\" is its element's.",
      [](Parameters & p) -> auto& { return p.atoms.colors; });
  t.add(
      "atoms.visible.<species>", ParameterType::boolean, "Atom-ball visibilities", "", 0, 1,
      "Whether the atoms of a species are drawn.", [](Parameters & p) -> auto& { return p.atoms.visible; });
  t.real(
      "atoms.radius.<species>", "Atom-ball radii", "Å", 0.001, 100,
      "Radius of a species; \"auto\" is that of the file, or its element's.",
      [](Parameters & p) -> auto& { return p.atoms.radii; });
}

void add_view(Table& t) {
  t.group("View");
  t.real(
      "view.azimuth", "Azimuth", "degrees", -360, 360, "Turn about +z; 0 looks along +y (front).",
      [](Parameters & p) -> auto& { return p.azimuth; });
  t.real(
      "view.elevation", "Elevation", "degrees", -90, 90, "Height of the viewer above the xy plane.",
      [](Parameters & p) -> auto& { return p.elevation; });
  t.real(
      "view.roll", "Roll", "degrees", -360, 360, "Turn of the picture about the viewing direction.",
      [](Parameters & p) -> auto& { return p.roll; });
  t.real(
      "view.zoom", "Zoom", "", 1e-3, 1e4, "1 shows the whole sample.", [](Parameters & p) -> auto& { return p.zoom; });
  t.add(
      "view.pan", ParameterType::vector, "Pan", "Å", -far, far,
      "Added to the center of the sample: the point looked at.", [](Parameters & p) -> auto& { return p.pan; });
  t.choice(
      "view.projection", "Projection", {"perspective", "parallel"}, "How depth is drawn.",
      [](Parameters & p) -> auto& { return p.projection; });
  t.real(
      "view.field_of_view", "Field of view", "degrees", 1, 150,
      "Angle of the shorter side of the picture in perspective.",
      [](Parameters & p) -> auto& { return p.field_of_view; });
}

void add_quality(Table& t) {
  t.group("Quality");
  t.choice(
      "quality.integrator", "Integrator", {"exact", "linear", "preintegrated", "sampled"},
      "How a ray is summed up inside a cell. exact: closed form, where the color map bends inside the cell too. "
      "linear: closed form of color and opacity that go straight from where the ray enters the cell to where it "
      "leaves. "
      "preintegrated: as linear, its integral from a table. sampled: midpoint samples. "
      "In mode volume-surface exact and linear are the same.",
      [](Parameters & p) -> auto& { return p.integrator; });
  t.add(
      "quality.samples_per_cell", ParameterType::integer, "Samples per cell", "", 1, 1024,
      "Samples of the integrator sampled on a ray's way through a cell. Twice as many make a quarter of the error, or "
      "on the average half of it where the color map jumps.",
      [](Parameters & p) -> auto& { return p.samples_per_cell; });
  t.add(
      "quality.supersampling", ParameterType::integer, "Supersampling", "", 1, 16, "n draws n × n rays for each pixel.",
      [](Parameters & p) -> auto& { return p.supersampling; });
  t.choice(
      "havs.order", "Order on OpenGL", {"lists", "k-buffer", "none"},
      "Of the renderer havs: what is done about pixels whose cells were drawn in a wrong order. lists: their cells are "
      "sorted. k-buffer: they go through a buffer of k cells; what is further out of order stays wrong. none: nothing.",
      [](Parameters & p) -> auto& { return p.havs.order; });
  t.add(
      "havs.k", ParameterType::integer, "k of the k-buffer", "", 2, 64, "Cells of a pixel that the k-buffer keeps.",
      [](Parameters & p) -> auto& { return p.havs.k; });
  t.add(
      "havs.memory", ParameterType::integer, "Memory for order", "MB", 1, 65536,
      "What lists or k-buffers may take; with less the cells are drawn more often.",
      [](Parameters & p) -> auto& { return p.havs.memory; });
  t.choice(
      "havs.integration", "Integration on OpenGL", {"auto", "exact", "table"},
      "Of the renderer havs: how a ray's segment in a cell is integrated. exact: closed form, with every bend of the "
      "color map. table: looked up in a pre-integration table. auto: the table; on software drivers a sum over the "
      "map's bends, where it is as good, and else exact.",
      [](Parameters & p) -> auto& { return p.havs.integration; });
  t.real(
      "havs.table_error", "Error of the table", "", 1e-5, 0.1,
      "Of a segment's color and opacity. Where no table is so accurate (maps that jump), integration is exact.",
      [](Parameters & p) -> auto& { return p.havs.table_error; });
}

}  // namespace

const std::vector<ParameterEntry>& parameter_entries() {
  static const std::vector<ParameterEntry> entries = [] {
    Table table;
    add_display(table);
    add_lights(table);
    add_cut_planes(table);
    add_volume_surface(table);
    add_surface(table);
    add_volume(table);
    add_xray(table);
    add_atoms(table);
    add_view(table);
    add_quality(table);
    return std::move(table.entries);
  }();
  return entries;
}

}  // namespace atomesh
