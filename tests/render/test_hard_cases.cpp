// The catalogue of hard cases: whatever a ray runs through, no cell is missed and none counted twice. Known answers
// first (the length of the ray inside the matter), then the judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/cli/hard_case_errors.h"
#include "core/error.h"
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

constexpr std::array<Integrator, 4> integrators{Integrator::exact, Integrator::linear, Integrator::preintegrated,
                                                Integrator::sampled};

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

constexpr int case_count = 31;

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
  for (const HardView& view : hard().views) {
    const KnownLengths known(hard(), view.camera, fast_beside);
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Scene scene = make_scene(hard().material, constant_density(mode, 1.0));
      for (const double extinction : hard().extinctions) {
        Parameters parameters = constant_density(mode, extinction);
        for (const Integrator integrator : integrators) {
          parameters.integrator = integrator;
          for (const std::string& kernel : kernels()) {
            cell_projection::set_kernel(kernel);
            const Image image = draw("cpu", scene, view.camera, parameters).image;
            expect_length(known.of_optical_depth(extinction, image), limit,
                          hard().name + ", " + view.name + ", " + std::string(mode_name(mode)) + ", integrator " +
                              std::to_string(static_cast<int>(integrator)) + ", " + kernel + ", extinction " +
                              std::to_string(extinction));
          }
          cell_projection::set_kernel("");
        }
      }
    }
  }
}

TEST_P(HardCases, TheJudgesOpticalDepthIsTheLengthInside) {
  for (const HardView& view : hard().views) {
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
  for (const HardView& view : hard().views) {
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
  for (const HardView& view : hard().views) {
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
    for (const HardView& view : hard().views) {
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

// Cells turned inside out are no mesh of ours: they may be left out, but nothing else may happen.
TEST(HardCaseCatalogue, CellsInsideOutDoNoHarm) {
  for (const HardCase& hard : catalogue()) {
    if (hard.known != HardCase::Known::nothing) continue;
    for (const Mode mode : {Mode::volume, Mode::volume_surface, Mode::surface, Mode::xray}) {
      const Parameters parameters = varying_density(mode, hard);
      const Scene scene = make_scene(hard.material, parameters);
      for (const HardView& view : hard.views) {
        const Drawn drawn = draw("cpu", scene, view.camera, parameters);
        for (const Vec4f& pixel : drawn.image.pixels) {
          for (int k = 0; k < 4; ++k) {
            ASSERT_GE(pixel[k], 0.0F) << hard.name << ' ' << mode_name(mode);
            ASSERT_LE(pixel[k], 1.0F + 1e-6F) << hard.name << ' ' << mode_name(mode);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace atomesh
