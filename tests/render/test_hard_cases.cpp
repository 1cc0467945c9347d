// The catalogue of hard cases: whatever a ray runs through, no cell is missed and none counted twice. Known answers
// first (the length of the ray inside the matter), then the judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "app/cli/hard_case_errors.h"
#include "core/error.h"
#include "preprocess/simplify.h"
#include "preprocess/tetrahedralize.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/renderer.h"
#include "samples/hard_cases.h"

namespace atomesh {
namespace {

using namespace cli;

constexpr double limit = 1e-5;

const std::vector<HardCase>& catalogue() {
  static const std::vector<HardCase> cases =
      hard_cases([](std::span<const Vec3> points) { return delaunay_cgal(points, no_progress()); });
  return cases;
}

constexpr double fast_beside = fast_rays_beside;
static_assert(fast_beside > cell_projection::ray_shift);
// The judge's pass by an infinitely small way, but the known answer is computed in double.
constexpr double judge_beside = 0x1p-30;

// Under the sanitizers, which look at what the code does and not at what comes out, a view of each case has to do:
// there the whole catalogue would take minutes.
#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t most_views = 1;
#else
constexpr std::size_t most_views = std::numeric_limits<std::size_t>::max();
#endif
std::span<const HardView> views_of(const HardCase& hard) {
  return std::span(hard.views).first(std::min(hard.views.size(), most_views));
}

struct Setting {
  Integrator integrator;
  int samples;  // per cell, of Integrator::sampled
};
constexpr std::array<Setting, 5> settings{{{Integrator::exact, 4},
                                           {Integrator::linear, 4},
                                           {Integrator::preintegrated, 4},
                                           {Integrator::sampled, 4},
                                           {Integrator::sampled, 16}}};

std::vector<std::string> kernels() {
  std::vector<std::string> names;
  for (const char* name : {"baseline", "avx2", "avx512"}) {
    try {
      cell_projection::set_kernel(name);
      names.emplace_back(name);
    } catch (const UnavailableError&) {  // not on this processor
    }
  }
  cell_projection::set_kernel("");
  return names;
}

struct Drawn {
  Image image;
  std::vector<float> thickness, depth;
};
Drawn draw(const char* renderer, const Scene& scene, const Camera& camera, const Parameters& parameters) {
  Drawn drawn;
  RenderStats stats;
  drawn.image = find_renderer(renderer).draw(scene, camera, parameters, stats,
                                             {&drawn.thickness, &drawn.depth, nullptr}, no_progress());
  return drawn;
}

void expect_length(const LengthError& error, double most, const std::string& where) {
  EXPECT_TRUE(error.relative <= most && error.granted <= std::max(1.0, most / limit) && error.color <= limit)
      << where << ": relative error " << error.relative << ", of short lengths " << error.granted
      << " of what is granted, of colours " << error.color << "; at pixel " << error.column << ' ' << error.row
      << " expected " << error.expected << " found " << error.found;
}

class HardCases : public testing::TestWithParam<int> {
 protected:
  const HardCase& hard() const { return catalogue()[static_cast<std::size_t>(GetParam())]; }
  void SetUp() override {
    if (hard().known == HardCase::Known::nothing) GTEST_SKIP() << "nothing is known of it";
  }
};

constexpr int case_count = 33;

TEST(HardCaseCatalogue, IsComplete) {
  EXPECT_EQ(catalogue().size(), case_count);
  for (const HardCase& hard : catalogue()) {
    EXPECT_FALSE(hard.views.empty()) << hard.name;
    if (hard.known == HardCase::Known::nothing) continue;
    EXPECT_EQ(validate(hard.material.mesh), std::vector<std::string>{}) << hard.name;
    EXPECT_EQ(validate(hard.material.surface, hard.material.mesh), std::vector<std::string>{}) << hard.name;
  }
}

// The known answers are the meshes': their cells fill the solid.
TEST(HardCaseCatalogue, CellsFillTheSolid) {
  for (const HardCase& hard : catalogue()) {
    const TetMesh& mesh = hard.material.mesh;
    if (hard.known == HardCase::Known::nothing || mesh.tetrahedra.size() > 2000) continue;
    const Camera& camera = hard.views.front().camera;
    for (const double row : {7.3, 11.7, 15.2}) {
      for (const double column : {9.1, 14.6, 18.9}) {
        const Ray line = ray(camera, camera.x_of(column), camera.y_of(row));
        double sum = 0.0;
        for (const Tetrahedron& t : mesh.tetrahedra) {
          const auto& p = mesh.vertices;
          sum += Solid{{tetrahedron_body(p[t[0]], p[t[1]], p[t[2]], p[t[3]])}, {}}.chord(line);
        }
        EXPECT_NEAR(sum, hard.solid.chord(line), 1e-6 * (1.0 + sum)) << hard.name;
      }
    }
  }
}

TEST_P(HardCases, OpticalDepthIsTheLengthInside) {
  for (const HardView& view : views_of(hard())) {
    const KnownLengths known(hard(), view.camera, fast_beside);
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Scene scene = make_scene(hard().material, constant_density(mode, 1.0));
      for (const double extinction : hard().extinctions) {
        Parameters parameters = constant_density(mode, extinction);
        for (const Setting& setting : settings) {
          parameters.integrator = setting.integrator;
          parameters.samples_per_cell = setting.samples;
          for (const std::string& kernel : kernels()) {
            cell_projection::set_kernel(kernel);
            const Image image = draw("cpu", scene, view.camera, parameters).image;
            expect_length(known.of_optical_depth(extinction, image), limit,
                          hard().name + ", " + view.name + ", " + std::string(mode_name(mode)) + ", integrator " +
                              std::to_string(static_cast<int>(setting.integrator)) + " of " +
                              std::to_string(setting.samples) + " samples, " + kernel + ", extinction " +
                              std::to_string(extinction));
          }
          cell_projection::set_kernel("");
        }
      }
    }
  }
}

// Cells that rays run through, a sum over a picture's pixels: those they must meet, and those they may as rays beside
// the pixels' centres do. Faces that two cells share have one depth for both, so that where they fall together in
// floats the neighbours take over what is between them: a cell that is run through by less than is granted to a length
// need not be met.
struct CellsMet {
  std::uint64_t least = 0, most = 0;
  std::uint64_t short_ones = 0;  // of `least`, run through by less than the lengths that are held to 1e-5
};
CellsMet cells_met(const HardCase& hard, const Camera& camera) {
  const double granted = granted_length(hard, camera.projection);
  const auto& p = hard.material.mesh.vertices;
  CellsMet met;
  for (const Tetrahedron& t : hard.material.mesh.tetrahedra) {
    const Solid cell{{tetrahedron_body(p[t[0]], p[t[1]], p[t[2]], p[t[3]])}, {}};
    const Vec3 middle = 0.25 * (p[t[0]] + p[t[1]] + p[t[2]] + p[t[3]]);
    double radius = 0.0;
    for (const Index v : t) radius = std::max(radius, glm::length(p[v] - middle));
    for (int row = 0; row < camera.height; ++row) {
      for (int column = 0; column < camera.width; ++column) {
        const Ray centre = ray(camera, camera.x_of(column), camera.y_of(row));
        const double beside = glm::length(glm::cross(middle - centre.origin, centre.direction));
        if (beside > 1.01 * radius * glm::length(centre.direction)) continue;
        double shortest = cell.chord(centre);
        double longest = shortest;
        for (const double right : {-fast_beside, fast_beside}) {
          for (const double down : {-fast_beside, fast_beside}) {
            const double chord = cell.chord(ray(camera, camera.x_of(column + right), camera.y_of(row + down)));
            shortest = std::min(shortest, chord);
            longest = std::max(longest, chord);
          }
        }
        met.most += longest > 0.0 ? 1 : 0;
        met.least += shortest > granted ? 1 : 0;
        met.short_ones += shortest > granted && longest < 1e5 * granted ? 1 : 0;
      }
    }
  }
  return met;
}

TEST_P(HardCases, SliversAreMetOnce) {
  if (hard().group != "slivers" && hard().group != "needles and plates") GTEST_SKIP() << "no slivers";
  const Parameters parameters = constant_density(Mode::volume, 1e-6);
  const Scene scene = make_scene(hard().material, parameters);
  std::uint64_t short_ones = 0;
  for (const HardView& view : hard().views) {
    // One tile, all of whose rays are counted. The rays are the view's own.
    Camera camera = moved_beside(view.camera, view.camera.width % 2 == 1 ? 0.5 : 0.0, 0.0);
    camera = moved_beside(camera, 0.0, view.camera.height % 2 == 1 ? 0.5 : 0.0);
    camera.width = camera.height = 32;
    const CellsMet known = cells_met(hard(), camera);
    short_ones += known.short_ones;
    for (const std::string& kernel : kernels()) {
      cell_projection::set_kernel(kernel);
      RenderStats stats;
      find_renderer("cpu").draw(scene, camera, parameters, stats, {}, no_progress());
      EXPECT_TRUE(stats.steps >= known.least && stats.steps <= known.most)
          << hard().name << ", " << view.name << ", " << kernel << ": met " << stats.steps << " cells of "
          << known.least << " to " << known.most;
    }
    cell_projection::set_kernel("");
  }
  EXPECT_GT(short_ones, 1000U) << "nothing was tried";
}

TEST_P(HardCases, TheJudgesOpticalDepthIsTheLengthInside) {
  for (const HardView& view : views_of(hard())) {
    const KnownLengths known(hard(), view.camera, judge_beside);
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Scene scene = make_scene(hard().material, constant_density(mode, 1.0));
      for (const double extinction : hard().extinctions) {
        const Image image = draw("reference", scene, view.camera, constant_density(mode, extinction)).image;
        expect_length(known.of_optical_depth(extinction, image), limit,
                      hard().name + ", " + view.name + ", " + std::string(mode_name(mode)) + ", extinction " +
                          std::to_string(extinction));
      }
    }
  }
}

TEST_P(HardCases, ThicknessIsTheLengthInside) {
  const Parameters parameters = constant_density(Mode::xray, 1.0);
  const Scene scene = make_scene(hard().material, parameters);
  for (const HardView& view : views_of(hard())) {
    for (const char* renderer : {"reference", "cpu"}) {
      const KnownLengths known(hard(), view.camera, renderer[0] == 'c' ? fast_beside : judge_beside);
      expect_length(known.of_thickness(draw(renderer, scene, view.camera, parameters).thickness), limit,
                    hard().name + ", " + view.name + ", " + renderer);
    }
  }
}

TEST_P(HardCases, DepthIsThatOfTheNearestCrossing) {
  const Parameters parameters = constant_density(Mode::surface, 1.0);
  const Scene scene = make_scene(hard().material, parameters);
  for (const HardView& view : views_of(hard())) {
    for (const char* renderer : {"reference", "cpu"}) {
      const KnownLengths known(hard(), view.camera, renderer[0] == 'c' ? fast_beside : judge_beside);
      expect_length(known.of_crossing(draw(renderer, scene, view.camera, parameters).depth), limit,
                    hard().name + ", " + view.name + ", " + renderer);
    }
  }
}

TEST_P(HardCases, VaryingValuesAreTheJudges) {
  if (hard().known != HardCase::Known::values) GTEST_SKIP() << "which of its cells comes first nobody has laid down";
  for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
    Parameters parameters = varying_density(mode, hard());
    const Scene scene = make_scene(hard().material, parameters);
    for (const HardView& view : views_of(hard())) {
      JudgedRays judge(scene, view.camera, parameters, fast_beside);
      for (const std::string& kernel : kernels()) {
        cell_projection::set_kernel(kernel);
        const VariedError error = judge.error(draw("cpu", scene, view.camera, parameters).image);
        // Where a value is not resolved it is one between those of the cells about.
        EXPECT_LE(error.nearest, view.values_unresolved ? 0.2 : limit)
            << hard().name << ", " << view.name << ", " << mode_name(mode) << ", " << kernel << ": at pixel "
            << error.column << ' ' << error.row << "; from the pixel's own centre " << error.centre;
      }
      cell_projection::set_kernel("");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, testing::Range(0, case_count));

TEST(HardCaseCatalogue, WhatIsNotANumberIsWrong) {
  const HardCase& hard = catalogue().front();
  const Camera& camera = hard.views.front().camera;
  const KnownLengths known(hard, camera, fast_beside);
  const double extinction = hard.extinctions.front();
  const Parameters parameters = constant_density(Mode::volume, extinction);
  const Scene scene = make_scene(hard.material, parameters);
  const Image image = draw("cpu", scene, camera, parameters).image;
  JudgedRays judge(scene, camera, parameters, fast_beside);
  for (int k = 0; k < 4; ++k) {
    Image wrong = image;
    wrong.pixels[40][k] = std::numeric_limits<float>::quiet_NaN();
    const LengthError error = known.of_optical_depth(extinction, wrong);
    EXPECT_GT(std::max({error.relative, error.granted, error.color}), 0.5) << k;
    EXPECT_GT(judge.error(wrong).nearest, 0.5) << k;
    EXPECT_GT(outside_of_colors(wrong), 0.5) << k;
  }
  std::vector<float> thickness(image.pixels.size(), std::numeric_limits<float>::quiet_NaN());
  const LengthError error = known.of_thickness(thickness);
  EXPECT_TRUE(std::isinf(error.relative) || std::isinf(error.granted));
}

// A perfect crystal of which preprocessing left as few cells as it can.
TEST(HardCaseCatalogue, ASimplifiedLatticeIsStillFilled) {
  const auto whole = std::find_if(catalogue().begin(), catalogue().end(),
                                  [](const HardCase& hard) { return hard.name == "fcc, Delaunay"; });
  ASSERT_NE(whole, catalogue().end());
  HardCase hard = *whole;
  const std::size_t before = hard.material.mesh.tetrahedra.size();
  SimplifyReport report;
  simplify(hard.material.mesh, hard.material.surface, hard.material.atoms, Defects{}, {}, report);
  EXPECT_LT(hard.material.mesh.tetrahedra.size(), before);
  EXPECT_TRUE(report.surface_identical);
  for (const HardView& view : views_of(hard)) {
    const KnownLengths known(hard, view.camera, fast_beside);
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Parameters parameters = constant_density(mode, hard.extinctions.front());
      const Scene scene = make_scene(hard.material, parameters);
      expect_length(known.of_optical_depth(hard.extinctions.front(), draw("cpu", scene, view.camera, parameters).image),
                    limit, "simplified, " + view.name + ", " + std::string(mode_name(mode)));
    }
  }
}

// Cells turned inside out are no mesh of ours: they may be left out, but nothing else may happen.
TEST(HardCaseCatalogue, CellsInsideOutDoNoHarm) {
  for (const HardCase& hard : catalogue()) {
    if (hard.known != HardCase::Known::nothing) continue;
    for (const Mode mode : {Mode::volume, Mode::volume_surface, Mode::surface, Mode::xray}) {
      const Parameters parameters = varying_density(mode, hard);
      const Scene scene = make_scene(hard.material, parameters);
      for (const HardView& view : views_of(hard)) {
        for (const char* renderer : {"cpu", "reference"}) {
          EXPECT_LE(outside_of_colors(draw(renderer, scene, view.camera, parameters).image), 1e-6)
              << hard.name << ' ' << mode_name(mode) << ' ' << renderer;
        }
      }
    }
  }
}

}  // namespace
}  // namespace atomesh
