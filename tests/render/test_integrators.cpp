// The integrators of cell projection: what a ray gets of a cell, on every kernel this processor runs.
#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cpu_renderer.h"
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

}  // namespace
}  // namespace atomesh::test
