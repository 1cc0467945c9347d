// The lit layers of mode volume_surface in the renderer "cpu": each entry into the surface counts exactly once, at its
// place among the cells. No pixel is exempt here, neither next to edges nor on outlines.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/error.h"
#include "preprocess/carve.h"
#include "preprocess/quantify_defects.h"
#include "preprocess/tetrahedralize.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "render/cpu/reference_modes.h"
#include "render/cpu/surface_layers.h"
#include "samples/samples.h"
#include "tests/render/fixtures.h"
#include "tests/support/lattices.h"

namespace atomesh::test {
namespace {

Material sample_material(std::string_view name, std::size_t atoms) {
  const Sample sample = make_sample(name, {atoms, 1});
  Material material;
  material.atoms = sample.atoms;
  material.unit_cell = sample.unit_cell;
  TetrahedralizeReport tetrahedralized;
  CarveReport carved;
  material.mesh = carve(tetrahedralize(material.atoms, {}, tetrahedralized), {}, carved);
  material.surface = extract_surface(material.mesh);
  if (material.unit_cell) {
    DefectReport report;
    material.defects = quantify_defects(material.atoms, *material.unit_cell, {}, report);
  }
  return material;
}

Material material_of(const Atoms& atoms) {
  Material material;
  material.atoms = atoms;
  TetrahedralizeReport report;
  material.mesh = tetrahedralize(atoms, {}, report);
  material.surface = extract_surface(material.mesh);
  add_defects(material, 17);
  return material;
}

const Material& cached_material(const std::string& name) {
  static std::map<std::string, Material> cache;
  const auto found = cache.find(name);
  if (found != cache.end()) return found->second;
  const auto make = [&name] {
    if (name == "nacl-cracked") return sample_material(name, 1500);
    if (name == "cacuo2-spiral") return sample_material(name, 8000);
    if (name == "sponge") return sample_material(name, 20000);
    if (name == "diamond ball") return material_of(cut_sphere(lattice("diamond").cell, 8.0));
    return material_of(random_atoms(400, 10.0, 3));
  };
  return cache.emplace(name, make()).first->second;
}

void expect_the_same(const Image& image, const Image& judge) {
  const ImageDifference difference = compare_images(image, judge, 2.0 / 255.0);
  EXPECT_EQ(difference.pixels_over, 0U) << "largest difference " << difference.max;
}

void expect_the_judges(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  expect_the_same(draw(cpu_renderer(), scene, camera, parameters).image,
                  draw(reference_renderer(), scene, camera, parameters).image);
}

// In a sample whose volume is invisible, n layers of opacity 1/4 cover 1 - (3/4)^n. Returns the number of entries.
int expect_every_entry_once(const Scene& scene, const Camera& camera, Parameters parameters) {
  parameters.volume_surface.alpha_length = 0.0;
  parameters.volume_surface.face_alpha = 0.25;
  const Image image = draw(cpu_renderer(), scene, camera, parameters).image;
  const reference::View view(scene, camera, parameters);
  const reference::Bins triangles(whole_picture(camera), scene.surface.size(), no_progress(), [&](std::size_t i) {
    return view.sight.extent_of_vertices(scene.surface[i].data(), 3);
  });
  int wrong = 0;
  int met = 0;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      int entries = 0;
      for (const reference::TriangleOnRay& hit :
           triangles_on_ray(view, view.sight.pixel_ray(column, row), triangles.at(column, row))) {
        entries += hit.crossing.entering ? 1 : 0;
      }
      met += entries;
      const double expected = 1.0 - std::pow(0.75, entries);
      if (std::abs(static_cast<double>(image.at(column, row).a) - expected) > 1e-5) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << met;
  return met;
}

using Case = std::tuple<const char*, const char*, Projection>;

class SurfaceLayers : public testing::TestWithParam<Case> {
 protected:
  Parameters parameters() const {
    return looking(Mode::volume_surface, std::get<1>(GetParam()), std::get<2>(GetParam()));
  }
  Scene scene() const { return make_scene(cached_material(std::get<0>(GetParam())), parameters()); }
  Camera camera(const Scene& of) const { return make_camera(parameters(), of.bounds, 120, 120); }
};

TEST_P(SurfaceLayers, CountEveryEntryOnce) {
  const Scene s = scene();
  EXPECT_GT(expect_every_entry_once(s, camera(s), parameters()), 1000);
}

TEST_P(SurfaceLayers, CountWhatIsBehindTheEyeNotAtAll) {
  const Scene s = scene();
  Camera inside = camera(s);
  inside.eye = s.center + 0.1 * s.bounds.diagonal() * Vec3(0.31, -0.17, 0.23);
  if (inside.projection == Projection::perspective) inside.pixel *= 2.5;
  expect_every_entry_once(s, inside, parameters());
}

// Two of these have pixels where a ray passes within 1e-5 of an edge between two triangles that face it (nacl-cracked,
// pixel 67, 26 of the view iso) or within a ray's shift of a pinch (cacuo2-spiral, pixel 65, 48).
TEST_P(SurfaceLayers, ArePicturedAsTheJudgeHasThem) {
  const Scene s = scene();
  expect_the_judges(s, camera(s), parameters());
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const auto& [material, view, projection] = info.param;
  std::string name =
      std::string(material) + "_" + view + (projection == Projection::parallel ? "_parallel" : "_perspective");
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Samples, SurfaceLayers,
    testing::Combine(testing::Values("nacl-cracked", "cacuo2-spiral", "sponge", "diamond ball", "random atoms"),
                     testing::Values("iso", "front"), testing::Values(Projection::perspective, Projection::parallel)),
    case_name);

TEST(SurfaceLayersOfBars, KeepTheirPlaceWhereCellsOverlapInACycle) {
  const Material material = ring_of_bars();
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    for (const double alpha_length : {0.5, 20.0}) {
      Parameters parameters = looking(Mode::volume_surface, "front", projection);
      parameters.volume_surface.base_color = Vec4f(1.0F, 0.3F, 0.1F, 0.8F);
      parameters.volume_surface.alpha_length = alpha_length;
      const Scene scene = make_scene(material, parameters);
      for (const int size : {4, 9, 64}) {
        expect_the_judges(scene, make_camera(parameters, scene.bounds, size, size), parameters);
      }
    }
  }
}

// Sheets in which a hundred-thousandth of an Å is opaque, so that floats hardly tell where: behind any volume a layer
// is lost.
TEST(SurfaceLayersOfSheets, ComeBeforeTheCellsBehindThem) {
  for (const double thickness : {1e-2, 1e-3}) {
    const Material material =
        box_material(3, 1, 3, 1.0, [thickness](const Vec3& p) { return Vec3(p.x, p.y * thickness, p.z); });
    for (const char* view : {"front", "iso", "12.3,-45.6"}) {
      for (const Projection projection : {Projection::parallel, Projection::perspective}) {
        Parameters parameters = looking(Mode::volume_surface, view, projection);
        parameters.volume_surface.base_color = Vec4f(1.0F, 0.3F, 0.1F, 1.0F);
        parameters.volume_surface.face_alpha = 0.5;
        parameters.volume_surface.alpha_length = 200.0 / thickness;
        const Scene scene = make_scene(material, parameters);
        const Camera camera = make_camera(parameters, scene.bounds, 32, 32);
        const Image judge = draw(reference_renderer(), scene, camera, parameters).image;
        for (const char* kernel : {"avx512", "avx2", "baseline"}) {
          try {
            cell_projection::set_kernel(kernel);
          } catch (const UnavailableError&) {
            continue;  // not on this processor
          }
          SCOPED_TRACE(std::string(kernel) + " " + view + " " + std::to_string(thickness));
          expect_the_same(draw(cpu_renderer(), scene, camera, parameters).image, judge);
        }
        cell_projection::set_kernel("");
      }
    }
  }
}

TEST(TileLayers, StandUnderTheirRaysNearestFirst) {
  using namespace cell_projection;
  TileLayers layers;
  for (int round = 0; round < 2; ++round) {  // a tile is used again
    layers.clear();
    layers.add(5, 6, {3.0, 3.0F, 0});
    layers.add(31, 31, {1.0, 1.0F, 1});
    layers.add(5, 6, {2.0, 2.0F, 2});
    layers.add(5, 6, {3.0, 3.0F, 3});
    layers.add(5, 6, {1.0, 1.0F, 4});
    layers.sort();
    // Pixel (5, 6) is column 1 and row 2 of the second block in the second row of blocks.
    const int block = blocks_per_side + 1;
    const std::uint32_t* begin = layers.begin_of(block) + 2 * block_side + 1;
    ASSERT_EQ(begin[1] - begin[0], 4U);
    const Index order[] = {4, 2, 0, 3};
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(layers.hits()[begin[0] + i].triangle, order[i]);
    EXPECT_TRUE(layers.any_in(block));
    EXPECT_FALSE(layers.any_in(0));
    const int last = blocks_per_side * blocks_per_side - 1;
    EXPECT_EQ(layers.hits()[layers.begin_of(last)[block_pixels - 1]].triangle, 1U);
    EXPECT_EQ(layers.begin_of(last)[block_pixels], 5U);
  }
}

}  // namespace
}  // namespace atomesh::test
