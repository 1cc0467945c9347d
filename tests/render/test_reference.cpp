// The judge against closed forms: what judges the other renderers is itself judged by pencil and paper.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/parallel.h"
#include "render/cpu/reference.h"
#include "render/cpu/reference_exact.h"
#include "render/cpu/reference_modes.h"
#include "render/shared/materials.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace reference;
using namespace test;

std::vector<Index> all(std::size_t count) {
  std::vector<Index> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<Index>(i);
  return indices;
}

// A camera whose pixel (column, row) looks at image-plane multiples of `pixel`, (0, 0) in the middle: odd sizes put
// rays exactly onto the axis.
Camera axis_camera(const Scene& scene, const Parameters& parameters, int size, double pixel) {
  Camera camera = make_camera(parameters, scene.bounds, size, size);
  camera.pixel = pixel;
  return camera;
}

// ∫₀¹ (c0 + (c1-c0) u) σ(u) e^(-τ(u)) du for σ = l (a0 + (a1-a0) u), a1 > a0, in closed form: by parts
// c0 - c1 T(1) + (c1-c0) ∫ T du, and ∫ T is a difference of error functions.
long double closed_form(long double c0, long double c1, long double a0, long double a1, long double l) {
  const long double k = l * (a1 - a0) / 2;
  const long double b = l * a0;
  const long double root = std::sqrt(k);
  const long double shift = b / (2 * root);
  const long double integral = std::sqrt(std::numbers::pi_v<long double>) / (2 * root) * std::exp(shift * shift) *
                               (std::erf(root + shift) - std::erf(shift));
  return c0 - c1 * std::exp(-b - k) + (c1 - c0) * integral;
}

TEST(ReferenceOptics, LinearSegmentIsTheClosedForm) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double a0 = 0.5 * unit(random);
    const double a1 = a0 + 0.05 + 0.4 * unit(random);
    const double length = std::pow(10.0, 3.0 * unit(random) - 1.5);
    const Vec4 near(unit(random), 0.0, 1.0, a0);
    const Vec4 far(unit(random), 1.0, 0.0, a1);
    const Contribution c = integrate_linear(near, far, 1.0, length);
    // The closed form itself cancels like e^(shift²) · 2^-64.
    if (length * a0 * a0 / (2 * (a1 - a0)) > 8.0) continue;
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(c.color[channel], static_cast<double>(closed_form(near[channel], far[channel], a0, a1, length)),
                  2e-14)
          << a0 << ' ' << a1 << ' ' << length;
    }
    EXPECT_NEAR(c.transmittance, std::exp(-0.5 * length * (a0 + a1)), 1e-14);
  }
}

TEST(ReferenceOptics, FallingOpacityIsTheMirroredIntegral) {
  // Reversing a segment and its light: ∫ c σ T forward = T(1) ∫ c σ / T backward; checked through many small steps.
  const Vec4 near(0.2, 0.9, 0.4, 0.8);
  const Vec4 far(0.7, 0.1, 0.6, 0.1);
  Contribution steps;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const Vec4 middle = near + ((i + 0.5) / n) * (far - near);
    const double t = std::exp(-3.0 / n * middle.a);
    compose(steps, {(1.0 - t) * Vec3(middle), t});
  }
  const Contribution whole = integrate_linear(near, far, 1.0, 3.0);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(whole.color[channel], steps.color[channel], 1e-10);
  EXPECT_NEAR(whole.transmittance, steps.transmittance, 1e-10);
}

TEST(ReferenceOptics, ConstantSegmentOfAnyThickness) {
  for (const double depth : {0.0, 1e-12, 1e-3, 1.0, 37.0, 900.0, 1e5}) {
    const Contribution c = integrate_linear(Vec4(0.3, 0.6, 1.0, 0.5), Vec4(0.3, 0.6, 1.0, 0.5), 2.0, depth);
    EXPECT_NEAR(c.transmittance, std::exp(-depth), 1e-14) << depth;
    EXPECT_NEAR(c.color.y, 0.6 * -std::expm1(-depth), 1e-14) << depth;
  }
}

TEST(ReferenceOptics, MappedSegmentSplitsAtEveryEntryAndJumps) {
  ColorMap map;
  map.entries = {{0.2, {1, 0, 0, 0.1F}}, {0.5, {0, 1, 0, 0.9F}}, {0.5, {0, 0, 1, 0.2F}}, {0.8, {1, 1, 1, 1.0F}}};
  for (const auto& [near, far] : {std::pair(0.0, 1.0), std::pair(1.0, 0.0), std::pair(0.3, 0.6), std::pair(0.5, 0.5)}) {
    Contribution steps;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const Vec4f color = map(near + ((i + 0.5) / n) * (far - near));
      const double t = std::exp(-2.0 / n * static_cast<double>(color.a));
      compose(steps, {(1.0 - t) * Vec3(color), t});
    }
    const Contribution whole = integrate_mapped(map, near, far, 1.0, 2.0);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(whole.color[channel], steps.color[channel], 2e-5) << near << ' ' << far;
    }
    EXPECT_NEAR(whole.transmittance, steps.transmittance, 2e-5) << near << ' ' << far;
  }
}

TEST(ReferenceExact, TiesBreakRightThenUpAndTurnRoundWithTheEdge) {
  const Vec3 a(0, 0, 1);
  const Vec3 b(0, 1, 1);
  const Vec3 c(1, 0, 1);
  EXPECT_EQ(side_of_line(0.0, 0.5, a, b), -side_of_line(0.0, 0.5, b, a));
  // On the upward line x = 0 the nudged point lies to its right, as (1, 0.5) does.
  EXPECT_EQ(side_of_line(0.0, 0.5, a, b), side_of_line(1.0, 0.5, a, b));
  // On the line y = 0 to the right only the second nudge decides: above, as (0.5, 1).
  EXPECT_EQ(side_of_line(0.5, 0.0, a, c), side_of_line(0.5, 1.0, a, c));
  EXPECT_EQ(side_of_line(0.5, 0.0, a, a), 0);
}

TEST(ReferenceExact, SignsAreThoseOfIntegerArithmetic) {
  __extension__ using Wide = __int128;
  std::mt19937_64 random(9);
  std::uniform_int_distribution<std::int64_t> digit(-3, 3);
  const std::int64_t big = std::int64_t{1} << 40;
  for (int i = 0; i < 20000; ++i) {
    // Nearly on the line: a, b and the point are multiples of one direction plus small change.
    const auto near_line = [&](std::int64_t t) {
      return std::array<std::int64_t, 2>{t * (big / 7) + digit(random), t * (big / 11) + digit(random)};
    };
    const auto p = near_line(2);
    const auto a = near_line(1);
    const auto b = near_line(5);
    const Wide exact = static_cast<Wide>(p[0]) * (a[1] - b[1]) + static_cast<Wide>(p[1]) * (b[0] - a[0]) +
                       (static_cast<Wide>(a[0]) * b[1] - static_cast<Wide>(a[1]) * b[0]);
    const int side = side_of_line(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                  Vec3(static_cast<double>(a[0]), static_cast<double>(a[1]), 1.0),
                                  Vec3(static_cast<double>(b[0]), static_cast<double>(b[1]), 1.0));
    if (exact == 0) continue;
    EXPECT_EQ(side, exact > 0 ? 1 : -1);
  }
}

// Every ray of a dense set, through vertices, along edges and inside faces, sees the cells as one gapless stretch
// between where it enters and leaves the sample, and the crossings of the surface say the same.
TEST(Reference, CellsJoinWithoutGapOrOverlapOnEveryRay) {
  const Material perfect = box_material(4, 4, 4, 1.0);
  const Material shaken = box_material(4, 4, 4, 1.0, shaking(0.12, 3));
  int met = 0;
  for (const Material* material : {&perfect, &shaken}) {
    for (const char* view_name : {"front", "top", "left", "45,0", "45,35.264389682754654", "30,20"}) {
      for (const Projection projection : {Projection::parallel, Projection::perspective}) {
        Parameters parameters = looking(Mode::volume_surface, view_name, projection);
        const Scene scene = make_scene(*material, parameters);
        const double pitch = projection == Projection::parallel ? 0.25 : 0.25 / 12.0;
        const View view(scene, axis_camera(scene, parameters, 33, pitch), parameters);
        const auto cells = all(scene.tetrahedra.size());
        const auto triangles = all(scene.surface.size());
        for (int row = 0; row < 33; ++row) {
          for (int column = 0; column < 33; ++column) {
            const PixelRay ray = view.sight.pixel_ray(column, row);
            const auto inside = cells_on_ray(view, ray, cells);
            double sum = 0.0;
            for (std::size_t i = 0; i < inside.size(); ++i) {
              EXPECT_LE(inside[i].segment.near_depth, inside[i].segment.far_depth + 1e-10);
              sum += inside[i].segment.far_depth - inside[i].segment.near_depth;
            }
            double signed_sum = 0.0;
            int open = 0;
            for (const auto& crossing : triangles_on_ray(view, ray, triangles)) {
              open += crossing.crossing.entering ? 1 : -1;
              EXPECT_TRUE(open == 0 || open == 1) << view_name;
              signed_sum += crossing.crossing.entering ? -crossing.crossing.depth : crossing.crossing.depth;
            }
            EXPECT_EQ(open, 0);
            EXPECT_NEAR(sum, signed_sum, 1e-11) << view_name << ' ' << column << ' ' << row;
            met += inside.empty() ? 0 : 1;
          }
        }
      }
    }
  }
  EXPECT_GT(met, 5000);
}

TEST(Reference, ConstantCubeIsTheExponential) {
  for (const Mode mode : {Mode::volume_surface, Mode::volume}) {
    Parameters parameters = looking(mode, "front");
    parameters.volume_surface.base_color = Vec4f(0.25F, 0.5F, 0.75F, 0.5F);
    parameters.volume_surface.face_alpha = 0.0;
    parameters.volume_surface.alpha_length = 0.125;
    parameters.volume.alpha_length = 0.125;
    parameters.volume.color_map.entries = {{0.0, {0.25F, 0.5F, 0.75F, 0.5F}}, {1.0, {0.25F, 0.5F, 0.75F, 0.5F}}};
    const Scene scene = make_scene(box_material(4, 4, 4, 2.0), parameters);
    const View view(scene, axis_camera(scene, parameters, 9, 0.9), parameters);
    const auto cells = all(scene.tetrahedra.size());
    for (int row = 0; row < 9; ++row) {
      for (int column = 0; column < 9; ++column) {
        const Seen seen = see_volume(view, view.sight.pixel_ray(column, row), cells, {});
        EXPECT_NEAR(seen.light.transmittance, std::exp(-0.0625 * 8.0), 1e-12);
        EXPECT_NEAR(seen.light.color.x, 0.25 * -std::expm1(-0.0625 * 8.0), 1e-12);
        EXPECT_NEAR(seen.light.color.z, 0.75 * -std::expm1(-0.0625 * 8.0), 1e-12);
      }
    }
  }
}

TEST(Reference, EyeInsideTheSampleStartsThere) {
  Parameters parameters = looking(Mode::volume_surface, "front", Projection::perspective);
  parameters.volume_surface.base_color = Vec4f(0.25F, 0.5F, 0.75F, 1.0F);
  parameters.volume_surface.alpha_length = 0.125;
  const Material material = box_material(4, 4, 4, 2.0);
  Scene scene = make_scene(material, parameters);
  Camera camera = axis_camera(scene, parameters, 3, 0.05);
  camera.eye = scene.center + Vec3(0.1, 0.3, 0.2);
  const View view(scene, camera, parameters);
  for (int column = 0; column < 3; ++column) {
    const PixelRay ray = view.sight.pixel_ray(column, 1);
    const double distance = (4.0 - 0.3) * view.sight.stretch(ray);
    const Seen seen = see_volume(view, ray, all(scene.tetrahedra.size()), all(scene.surface.size()));
    EXPECT_NEAR(seen.light.transmittance, std::exp(-0.125 * distance), 1e-12);  // no layer either
    const Seen xray = see_xray(view, ray, all(scene.surface.size()));
    EXPECT_NEAR(xray.thickness, distance, 1e-12);
  }
}

TEST(Reference, XrayThicknessOfASlabGrowsWithTheSlant) {
  Parameters parameters = looking(Mode::xray, "front", Projection::perspective);
  const Scene scene = make_scene(box_material(8, 2, 8, 1.5), parameters);
  const Camera camera = axis_camera(scene, parameters, 5, 0.02);
  const Drawn drawn = draw(reference_renderer(), scene, camera, parameters);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const double slant = std::hypot(1.0, 0.02 * (column - 2), 0.02 * (row - 2));
      const double thickness = 3.0 * slant;
      EXPECT_NEAR(drawn.thickness[static_cast<std::size_t>(row * 5 + column)], thickness, 1e-6);
      EXPECT_NEAR(drawn.image.at(column, row).a, 0.005 * thickness, 1e-7);
    }
  }
}

TEST(Reference, LayerLiesInFrontOfTheCellBehindIt) {
  Parameters parameters = looking(Mode::volume_surface, "front");
  parameters.shading = Shading::flat;
  parameters.lights = {};
  parameters.volume_surface.face_alpha = 0.25;
  parameters.volume_surface.ambient = 0.5;
  parameters.volume_surface.alpha_length = 1e4;  // opaque behind the layer
  parameters.volume_surface.base_color = Vec4f(0.25F, 0.5F, 0.75F, 1.0F);
  const Scene scene = make_scene(box_material(2, 2, 2, 1.0), parameters);
  const Drawn drawn = draw(reference_renderer(), scene, axis_camera(scene, parameters, 3, 0.5), parameters);
  for (const Vec4f& pixel : drawn.image.pixels) {
    EXPECT_NEAR(pixel.g, 0.25 * 0.5 * 0.5 + 0.75 * 0.5, 1e-6);
    EXPECT_NEAR(pixel.a, 1.0, 1e-6);
  }
}

TEST(Reference, PhongAtNormalIncidence) {
  // A light behind the viewer's head: n·l = r·v = 1 in the middle of a face seen head on.
  Parameters parameters = looking(Mode::surface, "front");
  parameters.shading = Shading::flat;
  parameters.lights = {};
  parameters.lights[0] = {true, {0, 0, 5}, {1.0F, 0.5F, 0.25F}, 0.5F};
  parameters.surface.color = Vec3f(0.4F, 0.6F, 0.8F);
  parameters.surface.specular = Vec3f(0.1F, 0.2F, 0.3F);
  parameters.surface.emission = Vec3f(0.05F, 0.0F, 0.0F);
  const Scene scene = make_scene(box_material(2, 2, 2, 1.0), parameters);
  const Camera camera = axis_camera(scene, parameters, 1, 0.5);
  const Drawn drawn = draw(reference_renderer(), scene, camera, parameters);
  const Vec4f pixel = drawn.image.at(0, 0);
  const float a = optics::ambient_share;
  const float d = optics::diffuse_share;
  EXPECT_NEAR(pixel.r, 0.05F + a * 0.4F + (d * 0.4F + 0.1F) * 0.5F, 1e-6);
  EXPECT_NEAR(pixel.g, a * 0.6F + (d * 0.6F + 0.2F) * 0.25F, 1e-6);
  EXPECT_NEAR(pixel.b, a * 0.8F + (d * 0.8F + 0.3F) * 0.125F, 1e-6);
  EXPECT_NEAR(drawn.depth[0], glm::dot(scene.center - camera.eye, camera.forward) - 1.0, 1e-5);
  EXPECT_LT(drawn.id[0], scene.surface.size());
}

TEST(Reference, BallCoversTheAreaOfItsDiscAndIsNearestInItsMiddle) {
  Parameters parameters = looking(Mode::atoms, "iso");
  parameters.atoms.radii["C"] = 2.0;
  const Scene scene = make_scene(atoms_material({{"C", {1, 2, 3}}}), parameters);
  const Camera camera = axis_camera(scene, parameters, 101, 0.05);
  const Drawn drawn = draw(reference_renderer(), scene, camera, parameters);
  double covered = 0.0;
  for (const Vec4f& pixel : drawn.image.pixels) covered += static_cast<double>(pixel.a);
  EXPECT_NEAR(covered * 0.05 * 0.05, std::numbers::pi * 4.0, 0.05);
  const double distance = glm::dot(scene.center - camera.eye, camera.forward);
  EXPECT_NEAR(drawn.depth[50 * 101 + 50], distance - 2.0, 1e-5);
  EXPECT_EQ(drawn.id[50 * 101 + 50], 0U);
  EXPECT_EQ(drawn.id[0], no_index);
  EXPECT_TRUE(std::isinf(drawn.depth[0]));
}

TEST(Reference, PictureIsTheSameForAnyNumberOfThreads) {
  Material material = box_material(3, 3, 3, 1.0, shaking(0.1, 1));
  add_defects(material, 2);
  const Parameters parameters = looking(Mode::volume_surface, "iso", Projection::perspective);
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 40, 30);
  set_threads(1);
  const Drawn one = draw(reference_renderer(), scene, camera, parameters);
  set_threads(3);
  const Drawn three = draw(reference_renderer(), scene, camera, parameters);
  set_threads(0);
  EXPECT_EQ(one.image.pixels, three.image.pixels);
  EXPECT_EQ(one.stats.steps, three.stats.steps);
}

}  // namespace
}  // namespace atomesh
