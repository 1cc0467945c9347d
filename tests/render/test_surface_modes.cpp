// Modes surface and xray of the renderer "cpu": known answers. Agreement with the judge is test_agreement's.
#include <gtest/gtest.h>

#include <cmath>

#include "render/cpu/cpu_renderer.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

Drawn draw_scene(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  return draw(cpu_renderer(), scene, camera, parameters);
}

// A ball of triangles about the origin: an octahedron's faces cut into n × n and pushed out to the radius.
Scene ball_scene(Mode mode, double radius, int n) {
  Scene scene;
  scene.mode = mode;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const auto vertex = [&](int i, int j) {
      const Vec3 p = sign * radius * glm::normalize(Vec3(n - i - j, i, j));
      for (Index v = 0; v < scene.vertices.size(); ++v) {
        if (glm::length(Vec3(scene.vertices[v]) - p) < 1e-4 * radius) return v;
      }
      scene.vertices.emplace_back(p);
      scene.bounds.add(p);
      return static_cast<Index>(scene.vertices.size() - 1);
    };
    const auto add = [&](Index a, Index b, Index c) {
      const auto at = [&](Index v) { return Vec3(scene.vertices[v]); };
      if (glm::dot(glm::cross(at(b) - at(a), at(c) - at(a)), at(a)) < 0.0) std::swap(b, c);
      scene.surface.push_back({a, b, c});
      scene.face_normals.emplace_back(glm::normalize(glm::cross(at(b) - at(a), at(c) - at(a))));
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
        if (i + j + 1 < n) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
      }
    }
  }
  return scene;
}

TEST(Xray, ThicknessOfABallIsItsChord) {
  const double radius = 10.0;
  const Scene scene = ball_scene(Mode::xray, radius, 16);
  double longest_edge = 0.0;
  for (const Triangle& t : scene.surface) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = glm::length(scene.vertices[t[k]] - scene.vertices[t[(k + 1) % 3]]);
      longest_edge = std::max(longest_edge, edge);
    }
  }
  for (const char* view : {"front", "iso", "top"}) {
    const Parameters parameters = looking(Mode::xray, view, Projection::parallel);
    const Camera camera = make_camera(parameters, scene.bounds, 65, 65);
    const Drawn drawn = draw_scene(scene, camera, parameters);
    for (int row = 0; row < 65; ++row) {
      for (int column = 0; column < 65; ++column) {
        const double from_axis = std::hypot(camera.x_of(column), camera.y_of(row));
        const float thickness = drawn.thickness[static_cast<std::size_t>(row * 65 + column)];
        if (from_axis >= radius) {
          ASSERT_EQ(thickness, 0.0F);
        } else if (from_axis < 0.9 * radius) {
          const double half_chord = std::sqrt(radius * radius - from_axis * from_axis);
          // A triangle of edges at most e stands back from the ball by e²/6 of the radius at most.
          const double stand_back = longest_edge * longest_edge / (6.0 * radius);
          ASSERT_LE(thickness, 2.0 * half_chord + 1e-4);
          ASSERT_GE(thickness, 2.0 * half_chord - 2.1 * stand_back * radius / half_chord) << column << ' ' << row;
        }
      }
    }
  }
}

TEST(Xray, OpacityIsProportionalToThicknessAndStopsAtOne) {
  const Material cube = box_material(2, 2, 2, 5.0);
  Parameters parameters = looking(Mode::xray, "front");
  parameters.xray.alpha_length = 0.03;
  parameters.xray.color = Vec3f(0.2F, 0.4F, 0.8F);
  const Scene scene = make_scene(cube, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 33, 33);
  Drawn drawn = draw_scene(scene, camera, parameters);
  EXPECT_NEAR(drawn.thickness[16 * 33 + 16], 10.0F, 1e-5);
  EXPECT_NEAR(drawn.image.at(16, 16).a, 0.3F, 1e-6);
  EXPECT_NEAR(drawn.image.at(16, 16).b, 0.24F, 1e-6);
  parameters.xray.alpha_length = 1.0;
  drawn = draw_scene(scene, camera, parameters);
  EXPECT_EQ(drawn.image.at(16, 16).a, 1.0F);
}

TEST(Xray, EveryRayOfAnAlignedLatticeLeavesAsOftenAsItEnters) {
  const Material cube = box_material(6, 6, 6, 1.0);
  for (const char* view : {"front", "back", "left", "right", "top", "bottom"}) {
    const Parameters parameters = looking(Mode::xray, view);
    const Scene scene = make_scene(cube, parameters);
    Camera camera = make_camera(parameters, scene.bounds, 33, 33);
    camera.pixel = 0.25;  // centres on vertices, edges and faces; the outermost on the hull itself
    const Drawn drawn = draw_scene(scene, camera, parameters);
    for (int row = 0; row < 33; ++row) {
      for (int column = 0; column < 33; ++column) {
        const double reach = std::max(std::abs(camera.x_of(column)), std::abs(camera.y_of(row)));
        const float thickness = drawn.thickness[static_cast<std::size_t>(row * 33 + column)];
        if (reach < 2.99) {
          ASSERT_NEAR(thickness, 6.0F, 1e-5) << view << ' ' << column << ' ' << row;
        } else if (reach > 3.01) {
          ASSERT_EQ(thickness, 0.0F) << view;
        } else {
          ASSERT_TRUE(thickness == 0.0F || std::abs(thickness - 6.0F) < 1e-5F) << view << ' ' << thickness;
        }
      }
    }
  }
}

TEST(Xray, AnEyeInsideCountsFromItself) {
  const Material cube = box_material(3, 3, 3, 2.0);
  const Parameters parameters = looking(Mode::xray, "front", Projection::perspective);
  const Scene scene = make_scene(cube, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 15, 15);
  for (const Vec3& eye : {Vec3(3.1, 2.9, 3.3), Vec3(3, 2, 3), Vec3(2, 2, 2)}) {
    camera.eye = eye;
    const Drawn drawn = draw_scene(scene, camera, parameters);
    EXPECT_NEAR(drawn.thickness[7 * 15 + 7], 6.0 - eye.y, 1e-5);
  }
}

TEST(Surface, DepthAndTriangleOfTheNearestHit) {
  const Material cube = box_material(3, 3, 3, 2.0);
  const Parameters parameters = looking(Mode::surface, "front", Projection::perspective);
  const Scene scene = make_scene(cube, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 41, 41);
  const Drawn drawn = draw_scene(scene, camera, parameters);
  int met = 0;
  for (int row = 0; row < 41; ++row) {
    for (int column = 0; column < 41; ++column) {
      const auto pixel = static_cast<std::size_t>(row * 41 + column);
      ASSERT_EQ(drawn.id[pixel] == no_index, std::isinf(drawn.depth[pixel]));
      ASSERT_EQ(drawn.image.pixels[pixel].a, drawn.id[pixel] == no_index ? 0.0F : 1.0F);
      if (drawn.id[pixel] == no_index) continue;
      ++met;
      // The front face is the plane y = 0.
      ASSERT_NEAR(scene.face_normals[drawn.id[pixel]].y, -1.0F, 1e-6);
      ASSERT_NEAR(drawn.depth[pixel], -camera.eye.y, 1e-4);
    }
  }
  EXPECT_GT(met, 200);
}

TEST(Surface, FlatShadingOfAFaceTowardsTheLightIsPhongsModel) {
  const Material cube = box_material(1, 1, 1, 4.0);
  Parameters parameters = looking(Mode::surface, "front", Projection::parallel);
  parameters.shading = Shading::flat;
  parameters.lights = {};
  parameters.lights[0] = {true, {0, 0, 1e6F}, {1, 1, 1}, 0.5F};
  parameters.surface.color = Vec3f(0.4F, 0.6F, 0.8F);
  parameters.surface.specular = Vec3f(0.1F);
  parameters.surface.emission = Vec3f(0.05F, 0.0F, 0.0F);
  const Scene scene = make_scene(cube, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 9, 9);
  const Vec4f seen = draw_scene(scene, camera, parameters).image.at(4, 4);
  // Light and eye stand straight before the face: all cosines are 1; shares of ambient and diffuse 0.3 and 0.7.
  EXPECT_NEAR(seen.r, 0.05F + 0.4F * (0.3F + 0.7F * 0.5F) + 0.05F, 1e-4);
  EXPECT_NEAR(seen.g, 0.6F * (0.3F + 0.7F * 0.5F) + 0.05F, 1e-4);
  EXPECT_NEAR(seen.b, 0.8F * (0.3F + 0.7F * 0.5F) + 0.05F, 1e-4);
}

TEST(Surface, SeenFromInsideItIsLitFromInside) {
  const Material cube = box_material(1, 1, 1, 4.0);
  Parameters parameters = looking(Mode::surface, "front", Projection::perspective);
  parameters.shading = Shading::flat;
  parameters.lights = {};
  parameters.lights[0] = {true, {0, 0, 0.1F}, {1, 1, 1}, 1.0F};  // inside, behind the eye
  parameters.surface.specular = Vec3f(0.0F);
  const Scene scene = make_scene(cube, parameters);
  Camera camera = make_camera(parameters, scene.bounds, 9, 9);
  camera.eye = Vec3(2.0);
  const Vec4f seen = draw_scene(scene, camera, parameters).image.at(4, 4);
  EXPECT_NEAR(seen.r, parameters.surface.color.r, 1e-3);
}

}  // namespace
}  // namespace atomesh::test
