// Cell projection: known answers on hard cases. Agreement with the judge in every mode is test_agreement's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "render/cpu/reference_modes.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

// Length of the ray's part in front of the eye inside the box.
double chord(const Vec3& low, const Vec3& high, const Ray& ray) {
  double from = 0.0;
  double to = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (std::abs(d) < 1e-14) {
      if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) return 0.0;
      continue;
    }
    const double a = (low[axis] - ray.origin[axis]) / d;
    const double b = (high[axis] - ray.origin[axis]) / d;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return std::max(0.0, to - from) * glm::length(ray.direction);
}

Parameters constant_density(double extinction, const char* view, Projection projection) {
  Parameters parameters = looking(Mode::volume_surface, view, projection);
  parameters.volume_surface.base_color = Vec4f(1.0F, 0.5F, 0.25F, 1.0F);
  parameters.volume_surface.alpha_length = extinction;
  parameters.volume_surface.face_alpha = 0.0;
  return parameters;
}

// Every pixel's optical depth is the extinction times the chord to 1e-5 of it, beside what a float resolves of a depth.
// Rays pass a hair beside the pixel's centre: near the hull's outline the chord is one of those within `margin` pixels.
void expect_beer_lambert(const Material& material, const Parameters& parameters, const Camera& camera) {
  const Scene scene = make_scene(material, parameters);
  const Bounds box = bounds_of(material.mesh.vertices);
  const Drawn drawn = draw(cpu_renderer(), scene, camera, parameters);
  const double extinction = parameters.volume_surface.alpha_length;
  const double margin = 1e-6;
  const double resolved = 4e-7 * box.diagonal();
  int met = 0;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      double low = HUGE_VAL;
      double high = 0.0;
      for (const double dx : {-margin, 0.0, margin}) {
        for (const double dy : {-margin, 0.0, margin}) {
          const double c = chord(box.min, box.max, ray(camera, camera.x_of(column + dx), camera.y_of(row + dy)));
          low = std::min(low, c);
          high = std::max(high, c);
        }
      }
      const Vec4f pixel = drawn.image.at(column, row);
      // Coverage is rounded to floats again and again, and rays are finished at a millionth of the light.
      const double finished = std::exp(-extinction * low) < 2e-6 ? 1e-6 : 0.0;
      const double least = -std::expm1(-extinction * (low - 1e-5 * low - resolved)) * (1.0 - 5e-7) - finished;
      const double most = -std::expm1(-extinction * (high + 1e-5 * high + resolved)) * (1.0 + 5e-7);
      ASSERT_GE(pixel.a, least) << "pixel " << column << ' ' << row << " chord " << low;
      ASSERT_LE(pixel.a, most) << "pixel " << column << ' ' << row << " chord " << high;
      ASSERT_NEAR(pixel.g, 0.5F * pixel.a, 2e-6);  // premultiplied
      if (high > 0.0) ++met;
    }
  }
  EXPECT_GT(met, 10);
}

void expect_beer_lambert(const Material& material, const Parameters& parameters, int size) {
  expect_beer_lambert(material, parameters, make_camera(parameters, bounds_of(material.mesh.vertices), size, size));
}

TEST(CellProjection, ConstantDensityIsBeersLaw) {
  const Material one_cube = box_material(1, 1, 1, 3.0);
  const Material lattice = box_material(5, 4, 6, 1.3);
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    for (const char* view : {"front", "iso", "top", "45,35.264389682754654", "12.3,-45.6", "170,3", "-60,89"}) {
      for (const double extinction : {0.01, 0.3, 5.0}) {
        expect_beer_lambert(one_cube, constant_density(extinction, view, projection), 40);
        expect_beer_lambert(lattice, constant_density(extinction, view, projection), 41);
      }
    }
  }
}

// Pixel centres on the lattice's vertices, edges and planes, seen along an axis: every ray is degenerate.
TEST(CellProjection, RaysThroughVerticesAlongEdgesAndInFacesMissNothing) {
  const Material lattice = box_material(6, 6, 6, 1.0);
  for (const char* view : {"front", "back", "left", "right", "top", "bottom"}) {
    for (const int per_step : {1, 2, 4, 8}) {
      const Parameters parameters = constant_density(0.2, view, Projection::parallel);
      const Scene scene = make_scene(lattice, parameters);
      Camera camera = make_camera(parameters, scene.bounds, 8 * per_step + 1, 8 * per_step + 1);
      camera.pixel = 1.0 / per_step;
      expect_beer_lambert(lattice, parameters, camera);
    }
  }
}

// Down [110] and [111] rows of vertices lie behind one another; where a pixel's side divides their distance, rays meet
// them all along.
TEST(CellProjection, RaysDownEveryAxisOfALatticeMissNothing) {
  const Material lattice = box_material(7, 7, 7, 1.0);
  for (const char* view : {"front", "45,0", "45,35.264389682754654", "-45,35.264389682754654", "0,45"}) {
    for (const Projection projection : {Projection::parallel, Projection::perspective}) {
      for (const double pixel : {0.5, 0.25 * std::sqrt(2.0), 0.25 * std::sqrt(2.0 / 3.0), 0.1}) {
        const Parameters parameters = constant_density(0.05, view, projection);
        const Scene scene = make_scene(lattice, parameters);
        Camera camera = make_camera(parameters, scene.bounds, 61, 61);
        camera.pixel = projection == Projection::parallel ? pixel : pixel / 20.0;
        expect_beer_lambert(lattice, parameters, camera);
      }
    }
  }
}

TEST(CellProjection, FlatAndNearlyFlatCellsDoNoHarm) {
  for (const double height : {1e-9, 1e-6, 1e-3}) {
    // The layer between 1 and 1 + height; in float the thinnest is perfectly flat.
    const Material material = box_material(
        4, 4, 4, 1.0, [height](const Vec3& p) { return p.z < 1.5 ? p : Vec3(p.x, p.y, p.z - 1.0 + height); });
    for (const Projection projection : {Projection::parallel, Projection::perspective}) {
      for (const char* view : {"front", "iso", "top", "30,0.01"}) {
        expect_beer_lambert(material, constant_density(0.5, view, projection), 37);
      }
    }
  }
}

TEST(CellProjection, AnEyeInsideCountsFromItself) {
  const Material lattice = box_material(4, 4, 4, 1.0, shaking(0.0, 1));
  for (const Vec3& eye :
       {Vec3(1.3, 2.2, 1.7), Vec3(2, 2, 2), Vec3(2, 1.5, 2), Vec3(1.5, 1.25, 2), Vec3(0.5, 0.5, 0.5)}) {
    for (const char* view : {"front", "iso", "top"}) {
      const Parameters parameters = constant_density(0.4, view, Projection::perspective);
      const Scene scene = make_scene(lattice, parameters);
      Camera camera = make_camera(parameters, scene.bounds, 32, 24);
      camera.eye = eye;
      camera.pixel *= 4.0;
      expect_beer_lambert(lattice, parameters, camera);
    }
  }
}

TEST(CellProjection, AParallelEyeInsideCountsFromItsPlane) {
  const Material lattice = box_material(4, 4, 4, 1.0);
  const Parameters parameters = constant_density(0.4, "iso", Projection::parallel);
  const Scene scene = make_scene(lattice, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 32, 24);
  camera.eye = Vec3(2.0, 2.1, 1.9);
  expect_beer_lambert(lattice, parameters, camera);
}

TEST(CellProjection, OneCellMayFillTheViewOrHideBetweenTwoPixels) {
  const Material cube = box_material(1, 1, 1, 1000.0);
  Parameters parameters = constant_density(1e-3, "12,17", Projection::perspective);
  parameters.zoom = 30.0;
  expect_beer_lambert(cube, parameters, 64);
  // Cells of a fifth of a pixel: most meet no ray, and none is missed.
  const Material fine = box_material(20, 20, 20, 0.1);
  parameters = constant_density(0.5, "12,17", Projection::perspective);
  parameters.zoom = 0.2;
  expect_beer_lambert(fine, parameters, 33);
}

TEST(CellProjection, HugeImagesOfTinyPartsStayExact) {
  const Material lattice = box_material(8, 8, 8, 1.0);
  Parameters parameters = constant_density(0.3, "31,12", Projection::parallel);
  parameters.zoom = 1000.0;
  expect_beer_lambert(lattice, parameters, 64);
}

Image picture(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  return draw(cpu_renderer(), scene, camera, parameters).image;
}

// The judge's picture along cell projection's own rays, which pass a hair beside the pixels' centres.
Image judged(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  const Camera beside =
      moved_beside(camera, cell_projection::ray_shift, cell_projection::ray_shift * cell_projection::ray_lift);
  return draw(reference_renderer(), scene, beside, parameters).image;
}

// From nearly nothing to opaque, against the judge.
TEST(CellProjection, ExtinctionFromAMillionthToAMillion) {
  Material material = box_material(4, 3, 5, 2.0, shaking(0.35, 7));
  add_defects(material, 3);
  for (const Mode mode : {Mode::volume_surface, Mode::volume}) {
    for (const double alpha_length : {1e-6, 1e-3, 1.0, 30.0, 1e3, 1e6}) {
      Parameters parameters = looking(mode, "iso", Projection::perspective);
      parameters.volume_surface.alpha_length = parameters.volume.alpha_length = alpha_length;
      const Scene scene = make_scene(material, parameters);
      const Camera camera = make_camera(parameters, scene.bounds, 16, 16);
      const Image judge = judged(scene, camera, parameters);
      EXPECT_LE(compare_images(judge, picture(scene, camera, parameters)).max, 1e-4) << alpha_length;
    }
  }
}

// Whether the three bars stand before one another in a circle on the rays of this picture.
bool cyclic(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  const reference::View view(scene, camera, parameters);
  const std::array<Index, 3> bars{0, 1, 2};
  bool before[3][3] = {};
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const auto met = cells_on_ray(view, view.sight.pixel_ray(column, row), bars);
      for (std::size_t i = 1; i < met.size(); ++i) before[met[i - 1].cell][met[i].cell] = true;
    }
  }
  return (before[0][1] && before[1][2] && before[2][0]) || (before[1][0] && before[2][1] && before[0][2]);
}

TEST(CellProjection, CyclicVisibilityIsRightOnEveryRay) {
  const Material material = ring_of_bars();
  for (const int size : {4, 6, 9, 16, 64}) {
    for (const Projection projection : {Projection::parallel, Projection::perspective}) {
      Parameters parameters = looking(Mode::volume_surface, "front", projection);
      parameters.volume_surface.alpha_length = 20.0;
      Scene scene = make_scene(material, parameters);
      scene.surface.clear();
      for (std::size_t v = 0; v < scene.colors.size(); ++v) {
        scene.colors[v] = Vec4f(v / 4 == 0 ? 1.0F : 0.1F, v / 4 == 1 ? 1.0F : 0.1F, v / 4 == 2 ? 1.0F : 0.1F, 0.8F);
      }
      const Camera camera = make_camera(parameters, bounds_of(material.mesh.vertices), size, size);
      // A picture of one block: no order is right for all of its rays.
      if (size == 4) {
        EXPECT_TRUE(cyclic(scene, camera, parameters));
      }
      const Image judge = judged(scene, camera, parameters);
      // Floats resolve depths to a few 1e-6 Å here, and extinction is 16/Å.
      EXPECT_LE(compare_images(judge, picture(scene, camera, parameters)).max, 1e-4) << size;
    }
  }
}

TEST(CellProjection, OrderOfTheCellsInTheFileDoesNotMatter) {
  Material material = box_material(5, 5, 5, 1.0, shaking(0.2, 5));
  add_defects(material, 6);
  const Parameters parameters = looking(Mode::volume_surface, "iso", Projection::perspective);
  Scene scene = make_scene(material, parameters);
  scene.surface.clear();
  const Camera camera = make_camera(parameters, scene.bounds, 64, 64);
  const Image image = picture(scene, camera, parameters);
  std::ranges::reverse(scene.tetrahedra.own());
  EXPECT_LE(compare_images(image, picture(scene, camera, parameters)).max, 2e-6);
  scene.delaunay = true;  // an order that is wrong for this mesh
  EXPECT_LE(compare_images(image, picture(scene, camera, parameters)).max, 2e-6);
}

TEST(CellProjection, EveryNumberOfThreadsDrawsTheSamePicture) {
  Material material = box_material(6, 6, 6, 1.0, shaking(0.2, 5));
  add_defects(material, 6);
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray}) {
    const Parameters parameters = looking(mode, "iso", Projection::perspective);
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 150, 110);
    set_threads(1);
    const Drawn one = draw(cpu_renderer(), scene, camera, parameters);
    for (const int count : {2, 5}) {
      set_threads(count);
      const Drawn many = draw(cpu_renderer(), scene, camera, parameters);
      EXPECT_EQ(std::memcmp(one.image.pixels.data(), many.image.pixels.data(), one.image.pixels.size() * 16), 0)
          << mode_name(mode);
      EXPECT_EQ(one.stats.steps, many.stats.steps);
      EXPECT_EQ(one.thickness, many.thickness);
      EXPECT_EQ(one.id, many.id);
    }
    set_threads(0);
  }
}

TEST(CellProjection, EveryInstructionSetDrawsTheSamePicture) {
  Material material = box_material(5, 5, 5, 1.0, shaking(0.2, 5));
  add_defects(material, 6);
  for (const Integrator integrator : {Integrator::exact, Integrator::sampled}) {
    for (const Mode mode : {Mode::volume_surface, Mode::volume}) {
      for (const double alpha_length : {0.2, 20.0}) {
        Parameters parameters = looking(mode, "iso", Projection::perspective);
        parameters.integrator = integrator;
        parameters.volume_surface.alpha_length = parameters.volume.alpha_length = alpha_length;
        const Scene scene = make_scene(material, parameters);
        const Camera camera = make_camera(parameters, scene.bounds, 64, 64);
        cell_projection::set_kernel("baseline");
        const Image baseline = picture(scene, camera, parameters);
        for (const char* name : {"avx2", "avx512"}) {
          try {
            cell_projection::set_kernel(name);
          } catch (const UnavailableError&) {
            continue;  // not on this processor
          }
          EXPECT_LE(compare_images(baseline, picture(scene, camera, parameters)).max, 1e-5) << name;
        }
        cell_projection::set_kernel("");
      }
    }
  }
  EXPECT_THROW(cell_projection::set_kernel("mmx"), UnavailableError);
}

TEST(CellProjection, SamplesConvergeToTheExactIntegralAtSecondOrder) {
  Material material = box_material(4, 4, 4, 1.5, shaking(0.3, 5));
  add_defects(material, 6);
  Parameters parameters = looking(Mode::volume_surface, "iso", Projection::perspective);
  parameters.volume_surface.alpha_length = 2.0;
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 48, 48);
  const Image exact = picture(scene, camera, parameters);
  parameters.integrator = Integrator::sampled;
  double previous = 1.0;
  for (const int samples : {1, 4, 16}) {
    parameters.samples_per_cell = samples;
    const double error = compare_images(exact, picture(scene, camera, parameters)).max;
    EXPECT_LE(error, previous / 8.0) << samples;
    previous = error;
  }
}

TEST(CellProjection, SamplesOfAColourMapConverge) {
  Material material = box_material(4, 4, 4, 1.5, shaking(0.3, 5));
  add_defects(material, 6);
  Parameters parameters = looking(Mode::volume, "iso", Projection::perspective);
  parameters.volume.alpha_length = 2.0;
  parameters.integrator = Integrator::sampled;
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 48, 48);
  parameters.samples_per_cell = 256;
  const Image sampled = picture(scene, camera, parameters);
  parameters.integrator = Integrator::exact;
  EXPECT_LE(compare_images(sampled, picture(scene, camera, parameters)).max, 2e-4);
}

TEST(CellProjection, TransparentCellsTakeNoSteps) {
  Material material = box_material(4, 4, 4, 1.0);
  add_defects(material, 6);
  Parameters parameters = constant_density(1.0, "iso", Projection::perspective);
  parameters.volume_surface.base_color.a = 0.0F;
  parameters.volume_surface.positional_multiplier = 0.0;
  parameters.volume_surface.extra_multiplier = 0.0;
  parameters.volume_surface.vacancy_multiplier = 0.0;
  const Scene scene = make_scene(material, parameters);
  const Drawn drawn = draw(cpu_renderer(), scene, make_camera(parameters, scene.bounds, 32, 32), parameters);
  EXPECT_EQ(drawn.stats.steps, 0U);
  for (const Vec4f& pixel : drawn.image.pixels) EXPECT_EQ(pixel, Vec4f(0.0F));
}

TEST(CellProjection, CancelsAndReports) {
  Material material = box_material(6, 6, 6, 1.0);
  for (const Mode mode : {Mode::volume_surface, Mode::surface, Mode::xray}) {
    const Parameters parameters = looking(mode, "iso", Projection::perspective);
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 256, 256);
    RenderStats stats;
    double last = 0.0;
    Progress followed([&](std::string_view, double fraction) { last = fraction; });
    cpu_renderer().draw(scene, camera, parameters, stats, {}, followed);
    EXPECT_EQ(last, 1.0);
    Progress cancelled;
    cancelled.request_cancel();
    EXPECT_THROW(cpu_renderer().draw(scene, camera, parameters, stats, {}, cancelled), CancelledError);
  }
}

}  // namespace
}  // namespace atomesh::test
