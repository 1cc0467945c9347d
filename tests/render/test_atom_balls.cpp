// Atom balls: known answers, and every pixel against the judge.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/parallel.h"
#include "render/cpu/atom_balls.h"
#include "render/cpu/ball_hits.h"
#include "render/cpu/ball_traversal.h"
#include "render/cpu/reference.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

Drawn draw_balls(const Scene& scene, const Camera& camera, const Parameters& parameters,
                 BallSearch search = BallSearch::automatic) {
  Drawn drawn;
  const Channels channels{nullptr, &drawn.depth, &drawn.id};
  drawn.image = Image(camera.width, camera.height);
  prepare_atom_balls(scene, camera, parameters, whole_picture(camera), drawn.stats, no_progress(), search)
      ->draw({}, drawn.image, drawn.stats, channels, no_progress());
  return drawn;
}

void expect_agreement(const Scene& scene, const Camera& camera, const Parameters& parameters, const std::string& what) {
  const Drawn fast = draw_balls(scene, camera, parameters, BallSearch::projection);
  const Drawn other = draw_balls(scene, camera, parameters, BallSearch::hierarchy);
  EXPECT_EQ(fast.image.pixels, other.image.pixels) << what;
  EXPECT_EQ(fast.stats.steps, other.stats.steps) << what;
  const Drawn judge = draw(reference_renderer(), scene, camera, parameters);
  const ImageDifference difference = compare_images(fast.image, judge.image, 2.0 / 255.0);
  EXPECT_EQ(difference.pixels_over, 0U) << what << ", largest difference " << difference.max;
  EXPECT_EQ(fast.id, judge.id) << what;
  for (std::size_t i = 0; i < judge.depth.size(); ++i) {
    if (std::isinf(judge.depth[i])) {
      EXPECT_TRUE(std::isinf(fast.depth[i])) << what;
    } else {
      EXPECT_NEAR(fast.depth[i], judge.depth[i], 1e-5F * judge.depth[i]) << what;
    }
  }
}

// Balls that touch, overlap and hide each other: a crystal, displaced, of two species.
Material crystal(int n, double step, double shift) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> by(-shift, shift);
  std::vector<std::pair<std::string, Vec3>> atoms;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double x = by(random);
        const double y = by(random);
        atoms.emplace_back((i + j + k) % 2 == 0 ? "Na" : "Cl", step * Vec3(i, j, k) + Vec3(x, y, by(random)));
      }
    }
  }
  return atoms_material(atoms);
}

TEST(BallHits, KeepsWhatCanBeSeenInOrder) {
  BallHits hits(1e-3);
  hits.add(5.0, 1, 0.5);
  hits.add(3.0, 2, 0.5);
  hits.add(3.0, 2, 0.5);  // proposed twice
  EXPECT_EQ(hits.hits().size(), 2U);
  EXPECT_EQ(hits.hits()[0].ball, 2U);
  EXPECT_TRUE(std::isinf(hits.reach()));
  hits.add(4.0, 3, 1.0);
  EXPECT_EQ(hits.hits().size(), 2U);  // 5.0 is hidden now
  EXPECT_EQ(hits.reach(), 4.0);
  hits.add(4.5, 4, 1.0);
  EXPECT_EQ(hits.hits().size(), 2U);
  hits.add(4.0, 5, 1.0);
  EXPECT_EQ(hits.hits().size(), 2U);
  hits.add(4.0, 0, 1.0);  // at the same length the lower index is in front
  EXPECT_EQ(hits.hits().back().ball, 0U);
}

TEST(AtomBalls, TransparentBallsComposeInOrderAndOpaqueOnesEndIt) {
  // Along +y: a transparent H, a transparent He that overlaps it, an opaque Li, a Be behind.
  Material material = atoms_material({{"H", {0, 0, 0}}, {"He", {0, 0.4, 0}}, {"Li", {0, 3, 0}}, {"Be", {0, 6, 0}}});
  material.defects.positional = {0, 0, 1, 1};
  material.defects.vacancy.assign(4, 0.0F);
  material.defects.extra.assign(4, 0.0F);
  Parameters parameters = looking(Mode::atoms, "front");
  parameters.lights = {};
  parameters.atoms.regular_opacity = 0.5;
  for (const char* species : {"H", "He", "Li", "Be"}) parameters.atoms.radii[species] = 1.0;
  parameters.atoms.colors = {{"H", {1, 0, 0}}, {"He", {0, 1, 0}}, {"Li", {0, 0, 1}}, {"Be", {1, 1, 1}}};
  const Scene scene = make_scene(material, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 1, 1);
  const Drawn drawn = draw_balls(scene, camera, parameters);
  // Ambient light only: 0.3 of each colour.
  EXPECT_NEAR(drawn.image.at(0, 0).r, 0.3 * 0.5, 1e-6);
  EXPECT_NEAR(drawn.image.at(0, 0).g, 0.3 * 0.25, 1e-6);
  EXPECT_NEAR(drawn.image.at(0, 0).b, 0.3 * 0.25, 1e-6);
  EXPECT_NEAR(drawn.image.at(0, 0).a, 1.0, 1e-6);
  EXPECT_EQ(drawn.id[0], 0U);
  EXPECT_EQ(drawn.stats.steps, 3U);
}

TEST(AtomBalls, EyeInsideABallDoesNotSeeIt) {
  Parameters parameters = looking(Mode::atoms, "front", Projection::perspective);
  for (const char* species : {"H", "He"}) parameters.atoms.radii[species] = 1.0;
  const Scene scene = make_scene(atoms_material({{"H", {0, 0, 0}}, {"He", {0, 5, 0}}}), parameters);
  Camera camera = make_camera(parameters, scene.bounds, 3, 3);
  camera.eye = Vec3(0.0, 0.2, 0.0);
  const Drawn drawn = draw_balls(scene, camera, parameters);
  EXPECT_EQ(drawn.id[4], 1U);
  EXPECT_NEAR(drawn.depth[4], 3.8F, 1e-5F);
  expect_agreement(scene, camera, parameters, "inside");
}

TEST(AtomBalls, NothingToDrawIsTransparent) {
  Parameters parameters = looking(Mode::atoms, "front");
  parameters.atoms.visible["H"] = false;
  const Scene scene = make_scene(atoms_material({{"H", {0, 0, 0}}}), parameters);
  const Drawn drawn = draw_balls(scene, make_camera(parameters, scene.bounds, 3, 2), parameters);
  for (const Vec4f& pixel : drawn.image.pixels) EXPECT_EQ(pixel, Vec4f(0.0F));
  EXPECT_EQ(drawn.id, std::vector<Index>(6, no_index));
}

TEST(AtomBalls, EveryPixelIsTheJudges) {
  for (const double step : {2.0, 2.82}) {
    for (const double opacity : {1.0, 0.3, 0.02}) {
      Material material = crystal(6, step, 0.3);
      add_defects(material, 4);
      for (std::size_t a = 0; a < material.atoms.size(); a += 2) {
        material.defects.positional[a] = material.defects.vacancy[a] = material.defects.extra[a] = 0.0F;
      }
      for (const char* view : {"front", "iso", "45,35.26438968"}) {
        for (const Projection projection : {Projection::parallel, Projection::perspective}) {
          Parameters parameters = looking(Mode::atoms, view, projection);
          parameters.atoms.regular_opacity = opacity;
          const Scene scene = make_scene(material, parameters);
          expect_agreement(scene, make_camera(parameters, scene.bounds, 121, 90), parameters,
                           std::string(view) + " opacity " + std::to_string(opacity));
        }
      }
    }
  }
}

TEST(AtomBalls, PerfectLatticeOnItsAxesIsTheJudges) {
  // Balls that touch exactly, rows behind one another exactly, rays exactly on rows.
  const Material material = crystal(5, 2.0, 0.0);
  for (const char* view : {"front", "top", "45,0"}) {
    for (const double radius : {0.5, 1.0, 1.2}) {
      Parameters parameters = looking(Mode::atoms, view);
      parameters.atoms.radii = {{"Na", radius}, {"Cl", radius}};
      const Scene scene = make_scene(material, parameters);
      Camera camera = make_camera(parameters, scene.bounds, 101, 101);
      camera.pixel = 0.125;
      expect_agreement(scene, camera, parameters, std::string(view) + " radius " + std::to_string(radius));
    }
  }
}

TEST(AtomBalls, FarAwayAndVeryDifferentSizesAreTheJudges) {
  Material material = crystal(4, 2.5, 0.2);
  material.atoms.positions.front() += Vec3(900, -700, 400);
  for (Vec3& p : material.atoms.positions) p += Vec3(1e6, -1e6, 1e6);
  Parameters parameters = looking(Mode::atoms, "iso", Projection::perspective);
  parameters.atoms.radii = {{"Na", 0.05}, {"Cl", 1.5}};
  const Scene scene = make_scene(material, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 160, 120);
  expect_agreement(scene, camera, parameters, "whole");
  // Close to the crystal, far from the centre of the scene.
  camera.eye = material.atoms.positions[40] - 20.0 * camera.forward;
  expect_agreement(scene, camera, parameters, "close");
}

TEST(AtomBalls, TooManyOverlapsAreLeftToTheHierarchy) {
  const Parameters parameters = looking(Mode::atoms, "iso");
  const Scene scene = make_scene(crystal(3, 2.5, 0.1), parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 64, 64);
  EXPECT_EQ(project_balls(scene, camera, whole_picture(camera), 20, no_progress()),
            nullptr);  // 27 balls, each in one tile at least
  EXPECT_NE(project_balls(scene, camera, whole_picture(camera), 27 * 16, no_progress()), nullptr);
}

TEST(AtomBalls, PictureIsTheSameForAnyNumberOfThreads) {
  const Parameters parameters = looking(Mode::atoms, "iso", Projection::perspective);
  const Scene scene = make_scene(crystal(8, 2.5, 0.3), parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 200, 150);
  set_threads(1);
  const Drawn one = draw_balls(scene, camera, parameters);
  set_threads(3);
  const Drawn three = draw_balls(scene, camera, parameters);
  set_threads(0);
  EXPECT_EQ(one.image.pixels, three.image.pixels);
  EXPECT_EQ(one.id, three.id);
  EXPECT_EQ(one.stats.steps, three.stats.steps);
}

}  // namespace
}  // namespace atomesh
