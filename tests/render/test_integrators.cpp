// The integrators of cell projection: what a ray gets of a cell, on every kernel this processor runs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "core/error.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "render/shared/preintegration.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

Image picture(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  return draw(cpu_renderer(), scene, camera, parameters).image;
}

// Runs `test` with each kernel.
template <class Test>
void on_every_kernel(Test test) {
  for (const char* name : {"baseline", "avx2", "avx512"}) {
    try {
      cell_projection::set_kernel(name);
    } catch (const UnavailableError&) {
      continue;  // not on this processor
    }
    SCOPED_TRACE(name);
    test();
  }
  cell_projection::set_kernel("");
}

// Adds those of the cells of `from` that `chosen` picks, with vertices of their own.
template <class Chosen>
void add_cells(const Scene& from, Chosen chosen, Scene& scene) {
  for (std::size_t t = 0; t < from.tetrahedra.size(); ++t) {
    if (!chosen(t)) continue;
    Tetrahedron corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = static_cast<Index>(scene.vertices.size());
      const Index v = from.tetrahedra[t][k];
      scene.vertices.push_back(from.vertices[v]);
      if (!from.colors.empty()) scene.colors.push_back(from.colors[v]);
      if (!from.scalars.empty()) scene.scalars.push_back(from.scalars[v]);
    }
    scene.tetrahedra.push_back(corners);
  }
}

// Pixels whose rays meet none of the cells that stand about them do not know of these, though they share blocks.
TEST(Integrators, ARaysLightDoesNotDependOnItsNeighbours) {
  Material material = box_material(7, 7, 7, 1.0, shaking(0.2, 11));
  add_defects(material, 4);
  for (const Mode mode : {Mode::volume_surface, Mode::volume}) {
    for (const Integrator integrator :
         {Integrator::exact, Integrator::linear, Integrator::preintegrated, Integrator::sampled}) {
      for (const double alpha_length : {0.02, 0.3, 3.0, 50.0}) {
        Parameters parameters = looking(mode, "iso", Projection::perspective);
        parameters.integrator = integrator;
        parameters.volume_surface.alpha_length = parameters.volume.alpha_length = alpha_length;
        parameters.volume_surface.face_alpha = 0.0;
        const Scene whole = make_scene(material, parameters);
        Scene thin = whole;
        for (Vec4f& color : thin.colors) color.a *= 0.05F;
        Scene few;
        few.mode = mode;
        few.center = whole.center;
        few.bounds = whole.bounds;
        Scene others = few;
        add_cells(
            thin, [](std::size_t t) { return t % 41 == 3; }, few);
        add_cells(
            whole, [](std::size_t t) { return t % 23 == 7; }, others);
        Scene both = few;
        add_cells(
            others, [](std::size_t) { return true; }, both);
        const Camera camera = make_camera(parameters, whole.bounds, 96, 96);
        on_every_kernel([&] {
          const Image alone = picture(few, camera, parameters);
          const Image around = picture(others, camera, parameters);
          const Image together = picture(both, camera, parameters);
          int compared = 0;
          for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
            if (around.pixels[i].a != 0.0F || alone.pixels[i].a == 0.0F) continue;
            ++compared;
            ASSERT_EQ(std::memcmp(&alone.pixels[i], &together.pixels[i], sizeof alone.pixels[i]), 0)
                << mode_name(mode) << ' ' << alpha_length << " pixel " << i;
          }
          EXPECT_GT(compared, 100);
        });
      }
    }
  }
}

// ψ by the midpoint rule in double, fine enough for 1e-7.
double psi(double near_density, double far_density) {
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps;
    sum += std::exp(-u * (near_density + 0.5 * u * (far_density - near_density)));
  }
  return sum / steps;
}

TEST(Integrators, TheTableOfPsiIsOffByLessThanItSays) {
  const float* const table = optics::psi_table();
  const auto density = [](double place) {
    const double bend = double{optics::psi_bend};
    const double gamma =
        place / (optics::psi_size - 1) * double{optics::psi_deepest} / (bend + double{optics::psi_deepest});
    return bend * gamma / (1.0 - gamma);
  };
  double worst = 0.0;
  for (int i = 0; i + 1 < optics::psi_size; i += 6) {
    for (int j = 0; j + 1 < optics::psi_size; j += 6) {
      const double near_density = density(i + 0.5);
      const double far_density = density(j + 0.5);
      if (near_density + far_density > double{optics::psi_deepest}) continue;
      const float* const at = table + i * optics::psi_size + j;
      const double between =
          0.25 * (double{at[0]} + double{at[1]} + double{at[optics::psi_size]} + double{at[optics::psi_size + 1]});
      worst = std::max(worst, std::abs(between - psi(near_density, far_density)));
    }
  }
  EXPECT_LE(worst, 6e-6);
}

// Knots and jumps, opaque and transparent.
ColorMap shells() {
  return {{{0.0, Vec4f(0, 0, 1, 0)},
           {0.5, Vec4f(0, 0, 1, 0)},
           {0.5, Vec4f(1, 0.5, 0, 1)},
           {0.51, Vec4f(1, 1, 0, 1)},
           {0.51, Vec4f(0, 1, 0, 0)},
           {1.0, Vec4f(1, 1, 1, 0.3)}}};
}

TEST(Integrators, ExactIsWithinAHundredThousandthOfTheJudge) {
  const Material material = box_material(3, 3, 3, 2.0, shaking(0.35, 7));
  for (const ColorMap& map : {preset_color_map("viridis"), shells()}) {
    for (const double alpha_length : {1e-6, 1e-2, 1.0, 10.0}) {
      Parameters parameters = looking(Mode::volume, "iso", Projection::perspective);
      parameters.volume.alpha_length = alpha_length;
      parameters.volume.color_map = map;
      Scene scene = make_scene(material, parameters);
      std::mt19937 random(3);
      for (float& scalar : scene.scalars) scalar = static_cast<float>(random()) * 0x1p-32F;
      const Camera camera = make_camera(parameters, scene.bounds, 12, 12);
      const Camera beside =
          moved_beside(camera, cell_projection::ray_shift, cell_projection::ray_shift * cell_projection::ray_lift);
      const Image judge = draw(reference_renderer(), scene, beside, parameters).image;
      on_every_kernel([&] {
        // Where extinction is small so is the light, and so must be the error.
        EXPECT_LE(compare_images(judge, picture(scene, camera, parameters)).max, 1e-5 * std::min(1.0, alpha_length))
            << alpha_length;
      });
    }
  }
}

TEST(Integrators, SamplesOfASmoothFieldConvergeAtSecondOrder) {
  Material material = box_material(3, 3, 3, 1.5, shaking(0.2, 5));
  add_defects(material, 6);
  Parameters parameters = looking(Mode::volume_surface, "iso", Projection::perspective);
  parameters.volume_surface.face_alpha = 0.0;
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 32, 32);
  const Image exact = picture(scene, camera, parameters);
  parameters.integrator = Integrator::sampled;
  double previous = 0.0;
  for (const int samples : {1, 2, 4, 8}) {
    parameters.samples_per_cell = samples;
    const double error = compare_images(exact, picture(scene, camera, parameters)).max;
    if (samples > 1) {
      EXPECT_NEAR(previous / error, 4.0, 0.6) << samples;
    }
    previous = error;
  }
}

// Where the light is linear in the map, straight between the cell's ends, the integrators that take it so are exact:
// linear up to rounding, preintegrated up to its table.
TEST(Integrators, LinearAndPreintegratedAreTheJudgesWhereTheMapHasNoKnots) {
  const Material material = box_material(3, 3, 3, 2.0, shaking(0.35, 7));
  for (const double alpha_length : {1e-2, 1.0, 10.0}) {
    Parameters parameters = looking(Mode::volume, "iso", Projection::perspective);
    parameters.volume.alpha_length = alpha_length;
    parameters.volume.color_map = {{{0.0, Vec4f(0.1, 0.9, 0.3, 0.2)}, {1.0, Vec4f(1, 0.2, 0, 1)}}};
    Scene scene = make_scene(material, parameters);
    std::mt19937 random(5);
    for (float& scalar : scene.scalars) scalar = static_cast<float>(random()) * 0x1p-32F;
    const Camera camera = make_camera(parameters, scene.bounds, 24, 24);
    const Camera beside =
        moved_beside(camera, cell_projection::ray_shift, cell_projection::ray_shift * cell_projection::ray_lift);
    const Image judge = draw(reference_renderer(), scene, beside, parameters).image;
    for (const auto& [integrator, most] :
         {std::pair{Integrator::linear, 1e-5}, std::pair{Integrator::preintegrated, 1e-5}}) {
      parameters.integrator = integrator;
      on_every_kernel([&] {
        const double off = compare_images(judge, picture(scene, camera, parameters)).max;
        EXPECT_LE(off, most) << alpha_length << " integrator " << static_cast<int>(integrator);
      });
    }
  }
}

// Order of the mean error of the sampled integrator, from 8 to 64 samples a cell, with this colour map.
double order_of_samples(const ColorMap& map) {
  const Material material = box_material(2, 2, 2, 2.0, shaking(0.3, 9));
  Parameters parameters = looking(Mode::volume, "iso", Projection::perspective);
  parameters.volume.alpha_length = 0.3;
  parameters.volume.color_map = map;
  Scene scene = make_scene(material, parameters);
  std::mt19937 random(13);
  for (float& scalar : scene.scalars) scalar = static_cast<float>(random()) * 0x1p-32F;
  const Camera camera = make_camera(parameters, scene.bounds, 96, 96);
  const Image exact = picture(scene, camera, parameters);
  parameters.integrator = Integrator::sampled;
  std::vector<double> errors;
  for (const int samples : {8, 64}) {
    parameters.samples_per_cell = samples;
    errors.push_back(compare_images(exact, picture(scene, camera, parameters)).rmse);
  }
  return std::log(errors[0] / errors[1]) / std::log(8.0);
}

TEST(Integrators, SamplesConvergeAtSecondOrderWhereTheMapBendsAndAtFirstWhereItJumps) {
  const Vec4f dark(0.1, 0.2, 0.9, 0.2);
  const Vec4f bright(1.0, 0.8, 0.1, 0.9);
  EXPECT_NEAR(order_of_samples({{{0.0, dark}, {0.45, bright}, {1.0, dark}}}), 2.0, 0.2);
  EXPECT_NEAR(order_of_samples({{{0.0, dark}, {0.45, dark}, {0.45, bright}, {1.0, bright}}}), 1.0, 0.2);
}

}  // namespace
}  // namespace atomesh::test
