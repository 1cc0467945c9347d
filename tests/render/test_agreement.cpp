// Every renderer against the judge, to 2/255 in every pixel: scenes × modes × views × projections, then what a user can
// turn on, one line each. Half the views put rays exactly through vertices, along edges and inside faces.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <ostream>

#include "preprocess/tetrahedralize.h"
#include "render/cpu/reference.h"
#include "tests/render/fixtures.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

using namespace test;

// Cubes of 1 Å whose outermost layer is stretched: rays on the lattice meet vertices, edges and faces inside, none runs
// along the hull, where inside and outside are a matter of the last bit.
Vec3 stretch_hull(const Vec3& p) {
  const auto stretch = [](double c) { return c < 0.5 ? c - 0.07 : c > 5.5 ? c + 0.07 : c; };
  return {stretch(p.x), stretch(p.y), stretch(p.z)};
}

Material mesh_of(const Atoms& atoms) {
  Material material;
  material.atoms = atoms;
  TetrahedralizeReport report;
  material.mesh = tetrahedralize(atoms, {}, report);
  material.surface = extract_surface(material.mesh);
  return material;
}

Material scene_material(const std::string& name) {
  if (name == "tetrahedron") return one_tetrahedron();
  if (name == "lattice") return box_material(6, 6, 6, 1.0, stretch_hull);
  if (name == "shaken") return box_material(6, 6, 6, 2.0, shaking(0.2, 7));
  if (name == "needle") return box_material(40, 1, 1, 1.0, shaking(0.05, 8));
  if (name == "random") return mesh_of(random_atoms(400, 10.0, 3));
  if (name == "diamond") return mesh_of(cut_sphere(lattice("diamond").cell, 8.0));
  if (name == "nacl") return mesh_of(cut_block(lattice("nacl").cell, 3, 3, 3));
  if (name == "atom") return atoms_material({{"Na", {5, 6, 7}}});
  Material far = box_material(4, 4, 4, 2.0, shaking(0.2, 9));  // "far"
  for (Vec3& p : far.mesh.vertices) p += Vec3(1e6, -1e6, 1e6);
  far.atoms.positions = far.mesh.vertices;
  return far;
}

const Material& cached_material(const std::string& name) {
  static std::map<std::string, Material> cache;
  const auto found = cache.find(name);
  if (found != cache.end()) return found->second;
  Material material = scene_material(name);
  add_defects(material, 17);
  return cache.emplace(name, std::move(material)).first->second;
}

std::vector<std::string> judged_renderers() {
  std::vector<std::string> names = renderer_names();
  std::erase(names, "reference");
  return names;
}

// What the judge sees through a pixel and around its centre, up to 1/4096 of a pixel away: lowest and highest of each
// channel. Where these differ the picture is not continuous (the ray grazes the hull or runs in a face of it) and any
// value between is right.
struct Range {
  Image low;
  Image high;
  Range(const Scene& scene, const Camera& camera, const Parameters& parameters) {
    for (const double columns : {0.0, -1.0, 1.0}) {
      for (const double rows : {0.0, -1.0, 1.0}) {
        const Image image =
            draw(reference_renderer(), scene, moved_beside(camera, columns / 4096, rows / 4096), parameters).image;
        if (low.pixels.empty()) low = high = image;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
          low.pixels[i] = glm::min(low.pixels[i], image.pixels[i]);
          high.pixels[i] = glm::max(high.pixels[i], image.pixels[i]);
        }
      }
    }
  }
  double distance(std::size_t pixel, const Vec4f& color) const {
    const Vec4f d = glm::max(low.pixels[pixel] - color, color - high.pixels[pixel]);
    return std::max({d.x, d.y, d.z, d.w});
  }
};

// In every pixel; only where `outline_on_rays` says that pixel centres lie exactly on the sample's outline may up to
// as many pixels as a column has be anything the judge sees around their centres.
void expect_agreement(const Material& material, const Parameters& parameters,
                      const std::function<void(Camera&, const Scene&)>& adjust = nullptr,
                      bool outline_on_rays = false) {
  if (judged_renderers().empty()) GTEST_SKIP() << "this build has no renderer beside the judge";
  const Scene scene = make_scene(material, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 47, 35);
  if (adjust) adjust(camera, scene);
  const Drawn judge = draw(reference_renderer(), scene, camera, parameters);
  for (const std::string& name : judged_renderers()) {
    const Drawn drawn = draw(find_renderer(name), scene, camera, parameters);
    const double tolerance = 2.0 / 255.0;
    const ImageDifference difference = compare_images(drawn.image, judge.image, tolerance);
    if (difference.pixels_over != 0) {
      EXPECT_LE(difference.pixels_over, outline_on_rays ? static_cast<std::size_t>(camera.height) : 0) << name;
      const Range range(scene, camera, parameters);
      for (std::size_t i = 0; i < judge.image.pixels.size(); ++i) {
        const Vec4f a = drawn.image.pixels[i];
        if (range.distance(i, a) <= tolerance) continue;
        const Vec4f b = judge.image.pixels[i];
        const auto width = static_cast<std::size_t>(camera.width);
        ADD_FAILURE() << name << ": pixel (" << i % width << ", " << i / width << ") is " << a.r << ' ' << a.g << ' '
                      << a.b << ' ' << a.a << ", the judge's " << b.r << ' ' << b.g << ' ' << b.b << ' ' << b.a
                      << "; largest difference " << difference.max;
        break;  // one is enough
      }
    }
    ASSERT_EQ(drawn.thickness.size(), judge.thickness.size()) << name;
    const double size = scene.bounds.diagonal();
    for (std::size_t i = 0; i < judge.thickness.size(); ++i) {
      EXPECT_NEAR(drawn.thickness[i], judge.thickness[i], 1e-4 * size) << name << " pixel " << i;
    }
  }
}

// Rays of a parallel view onto eighths of the lattice of cubes: every eighth ray meets vertices.
void align(Camera& camera, const Scene& scene) {
  camera.width = camera.height = 65;
  camera.pixel = 0.125;
  camera.eye = scene.center - 20.0 * camera.forward;
}

using SceneCase = std::tuple<const char*, Mode, const char*, Projection>;

class EveryScene : public testing::TestWithParam<SceneCase> {};

TEST_P(EveryScene, IsTheJudges) {
  const auto& [scene, mode, view, projection] = GetParam();
  // The eye is in the plane of symmetry, with the edge from (1,0,0) to (0,1,0): part of the outline is the middle
  // column of pixel centres, and along [111] in parallel others go through pixel centres too.
  const bool outline_on_rays =
      std::string_view(scene) == "tetrahedron" && std::string_view(view).starts_with("45,35.26");
  expect_agreement(cached_material(scene), looking(mode, view, projection), nullptr, outline_on_rays);
}

std::string case_name(const testing::TestParamInfo<SceneCase>& info) {
  const auto& [scene, mode, view, projection] = info.param;
  std::string name = std::string(scene) + "_" + std::string(mode_name(mode)) + "_" + view +
                     (projection == Projection::parallel ? "_parallel" : "_perspective");
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Agreement, EveryScene,
                         testing::Combine(testing::Values("tetrahedron", "lattice", "shaken", "needle", "random",
                                                          "diamond", "nacl", "far", "atom"),
                                          testing::Values(Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray,
                                                          Mode::atoms),
                                          testing::Values("front", "iso", "45,35.264389682754654"),
                                          testing::Values(Projection::parallel, Projection::perspective)),
                         case_name);

class AlignedView : public testing::TestWithParam<std::tuple<Mode, const char*>> {};

TEST_P(AlignedView, IsTheJudges) {
  const auto& [mode, view] = GetParam();
  expect_agreement(cached_material("lattice"), looking(mode, view), align);
}

INSTANTIATE_TEST_SUITE_P(Agreement, AlignedView,
                         testing::Combine(testing::Values(Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray,
                                                          Mode::atoms),
                                          testing::Values("front", "back", "left", "right", "top", "bottom")));

struct Variant {
  const char* name;
  Mode mode;
  void (*change)(Parameters&);
};
void PrintTo(const Variant& variant, std::ostream* out) {
  *out << variant.name;
}

class EveryOption : public testing::TestWithParam<Variant> {};

TEST_P(EveryOption, IsTheJudges) {
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    Parameters parameters = looking(GetParam().mode, "iso", projection);
    GetParam().change(parameters);
    expect_agreement(cached_material("shaken"), parameters);
  }
}

void cut(Parameters& p) {
  p.cut_planes[0] = {true, {1, 0.3, 0.1}, CutPlane::Side::less_equal, 0.0};
  p.cut_planes[0].distance = 7.0;
  p.cut_planes[3] = {true, {0, 0, 1}, CutPlane::Side::greater_equal, 3.0};
}
void cut_all(Parameters& p) {
  p.cut_planes[0] = {true, {1, 0, 0}, CutPlane::Side::less_equal, -100.0};
}
void lights(Parameters& p) {
  p.lights = {};
  p.lights[0] = {true, {1, 1, 2}, {1, 0.2F, 0.2F}, 0.7F};
  p.lights[4] = {true, {-2, 0.5F, 0.5F}, {0.2F, 1, 0.3F}, 0.5F};
  p.lights[7] = {true, {0, -3, 1}, {0.2F, 0.3F, 1}, 0.9F};
}
void flat(Parameters& p) {
  p.shading = Shading::flat;
}
void near(Parameters& p) {
  p.zoom = 8.0;
}
void thick(Parameters& p) {
  p.volume_surface.alpha_length = p.volume.alpha_length = 30.0;
  p.xray.alpha_length = 1.0;
}
void thin(Parameters& p) {
  p.volume_surface.alpha_length = p.volume.alpha_length = p.xray.alpha_length = 1e-4;
}
void no_layer(Parameters& p) {
  p.volume_surface.face_alpha = 0.0;
}
void opaque_layer(Parameters& p) {
  p.volume_surface.face_alpha = 1.0;
}
void jumps(Parameters& p) {
  p.volume.alpha_length = 1.0;
  p.volume.color_map.entries = {{0.0, {0, 0, 0, 0}},      {0.2, {1, 0, 0, 0.5F}}, {0.2, {0, 1, 0, 0}},
                                {0.21, {1, 1, 1, 1}},     {0.22, {0, 0, 1, 0}},   {0.7, {0.5F, 0, 0.5F, 0.1F}},
                                {1.0, {1, 0.5F, 0, 1.0F}}};
}
void steep(Parameters& p) {
  p.volume.alpha_length = 5.0;
  p.volume.color_map.entries.clear();
  for (int i = 0; i < 32; ++i) {
    p.volume.color_map.entries.push_back({i / 31.0, i % 2 == 0 ? Vec4f(1, 0, 0, 0.01F) : Vec4f(0, 0, 1, 1)});
  }
}
void defect_balls(Parameters& p) {
  p.volume.solid = VolumeSolid::defects;
  p.atoms.regular_limit = 0.7;
  p.atoms.scale = 0.5;
}
void balls_cut(Parameters& p) {
  p.volume.solid = VolumeSolid::atoms;
  p.volume.alpha_length = 1.0;
  p.atoms.scale = 0.4;
  cut(p);
}
void walls(Parameters& p) {
  p.volume.solid = VolumeSolid::walls;
}
void walls_near(Parameters& p) {
  walls(p);
  near(p);
  p.shading = Shading::flat;
}
void glassy(Parameters& p) {
  p.atoms.regular_opacity = 0.2;
}
void big(Parameters& p) {
  p.atoms.scale = 3.0;
}

INSTANTIATE_TEST_SUITE_P(
    Agreement, EveryOption,
    testing::Values(
        Variant{"volume_surface_cut", Mode::volume_surface, cut}, Variant{"volume_cut", Mode::volume, cut},
        Variant{"surface_cut", Mode::surface, cut}, Variant{"xray_cut", Mode::xray, cut},
        Variant{"atoms_cut", Mode::atoms, cut}, Variant{"volume_surface_cut_all", Mode::volume_surface, cut_all},
        Variant{"atoms_cut_all", Mode::atoms, cut_all}, Variant{"volume_surface_lights", Mode::volume_surface, lights},
        Variant{"surface_lights", Mode::surface, lights}, Variant{"atoms_lights", Mode::atoms, lights},
        Variant{"volume_surface_flat", Mode::volume_surface, flat}, Variant{"surface_flat", Mode::surface, flat},
        Variant{"volume_surface_near", Mode::volume_surface, near}, Variant{"volume_near", Mode::volume, near},
        Variant{"surface_near", Mode::surface, near}, Variant{"xray_near", Mode::xray, near},
        Variant{"atoms_near", Mode::atoms, near}, Variant{"volume_surface_thick", Mode::volume_surface, thick},
        Variant{"volume_thick", Mode::volume, thick}, Variant{"xray_thick", Mode::xray, thick},
        Variant{"volume_surface_thin", Mode::volume_surface, thin}, Variant{"volume_thin", Mode::volume, thin},
        Variant{"volume_surface_no_layer", Mode::volume_surface, no_layer},
        Variant{"volume_surface_opaque_layer", Mode::volume_surface, opaque_layer},
        Variant{"volume_jumps", Mode::volume, jumps}, Variant{"volume_steep", Mode::volume, steep},
        Variant{"volume_defect_balls", Mode::volume, defect_balls},
        Variant{"volume_balls_cut", Mode::volume, balls_cut}, Variant{"volume_walls", Mode::volume, walls},
        Variant{"volume_walls_near", Mode::volume, walls_near}, Variant{"atoms_glassy", Mode::atoms, glassy},
        Variant{"atoms_big", Mode::atoms, big}),
    [](const auto& variant) { return variant.param.name; });

class EyeInside : public testing::TestWithParam<Mode> {};

TEST_P(EyeInside, IsTheJudges) {
  expect_agreement(cached_material("shaken"), looking(GetParam(), "iso", Projection::perspective),
                   [](Camera& camera, const Scene& scene) {
                     camera.eye = scene.center + Vec3(0.31, -0.17, 0.23);
                     camera.pixel *= 2.5;
                   });
}

INSTANTIATE_TEST_SUITE_P(Agreement, EyeInside,
                         testing::Values(Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms));

}  // namespace
}  // namespace atomesh
