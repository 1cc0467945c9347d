// The renderer "cpu" against the judge.
#include <gtest/gtest.h>

#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

constexpr int side = 64;

void expect_like_the_judge(const Material& material, const Parameters& parameters, double tolerance,
                           const std::string& what) {
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, side, side);
  const Drawn judge = draw(reference_renderer(), scene, camera, parameters);
  const Drawn ours = draw(cpu_renderer(), scene, camera, parameters);
  const ImageDifference difference = compare_images(judge.image, ours.image, tolerance);
  EXPECT_LE(difference.max, tolerance) << what << ": " << difference.pixels_over << " pixels over";
}

class AgainstTheJudge : public testing::TestWithParam<Mode> {};

TEST_P(AgainstTheJudge, RandomMeshesAgreeInBothProjections) {
  Material material = box_material(4, 3, 5, 2.0, shaking(0.35, 7));
  add_defects(material, 3);
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    for (const char* view : {"iso", "front", "-77,13", "200,-61"}) {
      Parameters parameters = looking(GetParam(), view, projection);
      expect_like_the_judge(material, parameters, 5e-4, std::string(view));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, AgainstTheJudge,
                         testing::Values(Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms),
                         [](const auto& tested) {
                           std::string name(mode_name(tested.param));
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace atomesh::test
