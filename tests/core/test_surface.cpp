#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/surface.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

bool never(int, int, int) {
  return false;
}
bool middle(int i, int j, int k) {
  return i == 1 && j == 1 && k == 1;
}
bool diagonal_pair(int i, int j, int k) {
  // Of the four cubes about the axis x = y = 1 only two remain, which touch along that axis.
  return k > 0 || i != j || i > 1;
}

struct Case {
  const char* name;
  TetMesh mesh;
  double area;
  double volume;
};

std::vector<Case> cases() {
  return {{"nothing", TetMesh{}, 0.0, 0.0},
          {"corner", test::corner_tetrahedron(), 1.5 + std::sqrt(3.0) / 2.0, 1.0 / 6.0},
          {"regular", test::regular_tetrahedron(), 8.0 * std::sqrt(3.0), 8.0 / 3.0},
          {"cube", test::cube_of_six(2.0), 24.0, 8.0},
          {"cube far away", test::cube_of_six(2.0, Vec3(1e6, -1e6, 1e6)), 24.0, 8.0},
          {"two at an edge", test::two_at_an_edge(), 3.0 + std::sqrt(3.0), 1.0 / 3.0},
          {"block", test::cubes(3, never), 54.0, 27.0},
          {"block with a cavity", test::cubes(3, middle), 60.0, 26.0},
          {"cubes that share an edge", test::cubes(2, diagonal_pair), 12.0, 2.0}};
}

TEST(Surface, AreaAndVolumeAreKnown) {
  for (const Case& c : cases()) {
    const Surface surface = extract_surface(c.mesh);
    EXPECT_NEAR(area(surface, c.mesh.vertices), c.area, 1e-9) << c.name;
    EXPECT_NEAR(enclosed_volume(surface, c.mesh.vertices), c.volume, 1e-9) << c.name;
    EXPECT_NEAR(volume(c.mesh), c.volume, 1e-9) << c.name;
  }
}

TEST(Surface, IsClosedAndOutward) {
  for (const Case& c : cases()) {
    const Surface surface = extract_surface(c.mesh);
    EXPECT_TRUE(is_closed(surface)) << c.name;
    EXPECT_EQ(validate(surface, c.mesh), std::vector<std::string>{}) << c.name;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      // The vertex behind the triangle lies on its inner side.
      const Tetrahedron& tet = c.mesh.tetrahedra[surface.tetrahedron[i]];
      const Triangle& t = surface.triangles[i];
      const auto& v = c.mesh.vertices;
      EXPECT_LT(signed_volume(v[t[0]], v[t[1]], v[t[2]], v[tet[surface.face[i]]]), 0.0);
    }
  }
}

TEST(Surface, NormalsOfACube) {
  const TetMesh cube = test::cube_of_six(2.0, Vec3(-1.0));
  const Surface surface = extract_surface(cube);
  const auto faces = face_normals(surface.triangles, cube.vertices);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Vec3 centre(0.0);
    for (const Index v : surface.triangles[i]) centre += cube.vertices[v] / 3.0;
    // The face's own plane is at distance 1 from the middle.
    EXPECT_NEAR(glm::dot(Vec3(faces[i]), centre), 1.0, 1e-6);
    EXPECT_NEAR(glm::length(faces[i]), 1.0F, 1e-6F);
  }
  // Weighted by angle, a corner of a cube does not feel how its faces are cut into triangles.
  const auto vertices = vertex_normals(surface.triangles, cube.vertices);
  ASSERT_EQ(vertices.size(), cube.vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_NEAR(glm::length(Vec3(vertices[v]) - glm::normalize(cube.vertices[v])), 0.0, 1e-6);
  }
}

TEST(Surface, VerticesInsideHaveNoNormal) {
  const TetMesh block = test::cubes(2, never);
  const auto normals = vertex_normals(extract_surface(block).triangles, block.vertices);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const bool inside = block.vertices[v] == Vec3(1.0);
    EXPECT_EQ(glm::length(normals[v]) == 0.0F, inside) << v;
  }
}

TEST(Surface, ComesInTheOrderOfItsTetrahedra) {
  const Surface surface = extract_surface(test::cubes(2, never));
  for (std::size_t i = 1; i < surface.triangles.size(); ++i) {
    EXPECT_LT(std::make_pair(surface.tetrahedron[i - 1], surface.face[i - 1]),
              std::make_pair(surface.tetrahedron[i], surface.face[i]));
  }
}

TEST(ValidateSurface, FindsEachFault) {
  const TetMesh cube = test::cube_of_six();
  const Surface good = extract_surface(cube);
  const auto complaint = [&](const Surface& surface) {
    const auto found = validate(surface, cube);
    return found.empty() ? std::string() : found.front();
  };

  Surface bad = good;
  bad.triangles.pop_back();
  EXPECT_NE(complaint(bad).find("differ in length"), std::string::npos);
  bad.tetrahedron.pop_back();
  bad.face.pop_back();
  EXPECT_FALSE(is_closed(bad));
  EXPECT_NE(complaint(bad).find("not closed"), std::string::npos);

  bad = good;
  std::swap(bad.triangles[3][0], bad.triangles[3][1]);
  EXPECT_NE(complaint(bad).find("triangle 3 points inward"), std::string::npos);

  bad = good;
  bad.tetrahedron[2] = 99;
  EXPECT_NE(complaint(bad).find("which the mesh does not have"), std::string::npos);

  bad = good;
  bad.face[1] = static_cast<std::uint8_t>((bad.face[1] + 1) % 4);
  EXPECT_NE(complaint(bad).find("is not the face it names"), std::string::npos);

  EXPECT_NE(complaint(Surface{}).find("not the boundary"), std::string::npos);
}

TEST(Surface, EveryPassCanBeCancelled) {
  const TetMesh mesh = test::cubes(3, never);
  const Surface surface = extract_surface(mesh);
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(extract_surface(mesh, progress), CancelledError);
  EXPECT_THROW(face_neighbours(mesh, progress), CancelledError);
  EXPECT_THROW(volume(mesh, progress), CancelledError);
  EXPECT_THROW(min_dihedral_degrees(mesh, progress), CancelledError);
  EXPECT_THROW(is_closed(surface, progress), CancelledError);
  EXPECT_THROW(validate(mesh, 10, progress), CancelledError);
  EXPECT_THROW(validate(surface, mesh, 10, progress), CancelledError);
}

}  // namespace
}  // namespace atomesh
