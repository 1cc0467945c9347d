#include <gtest/gtest.h>

#include "core/vertex_defects.h"

namespace atomesh {
namespace {

struct Sample {
  Atoms atoms;
  TetMesh mesh;
  Defects defects;
};

// Atoms 0 to 3 have a vertex each, atom 4 sits on atom 1, atom 5 lost its vertex.
Sample sample() {
  Sample s;
  s.atoms.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0.1, 0.1, 0.1}};
  s.mesh.vertices.assign(s.atoms.positions.begin(), s.atoms.positions.begin() + 4);
  s.mesh.vertex_atom = {0, 1, 2, 3};
  s.defects.positional = {0.0F, 1.0F, 2.0F, 0.0F, 3.0F, 0.0F};
  s.defects.extra = {0.0F, 5.0F, 0.0F, 0.0F, 4.0F, 0.0F};
  s.defects.vacancy = {0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F};
  return s;
}

TEST(VertexDefects, AtomsOnOnePlaceGiveTheLargestOfEachValue) {
  const Sample s = sample();
  const std::vector<DefectValues> values = vertex_defects(s.mesh, s.atoms, s.defects);
  ASSERT_EQ(values.size(), 4U);
  EXPECT_FALSE(values[0].any());
  EXPECT_EQ(values[1].positional, 3.0F);
  EXPECT_EQ(values[1].extra, 5.0F);
  EXPECT_EQ(values[1].vacancy, 1.0F);
  EXPECT_EQ(values[2].positional, 2.0F);
  EXPECT_FALSE(values[3].any());
}

TEST(VertexDefects, NothingWithoutDefectsOrAtoms) {
  Sample s = sample();
  s.mesh.vertex_atom[2] = no_index;
  EXPECT_FALSE(vertex_defects(s.mesh, s.atoms, s.defects)[2].any());
  for (const DefectValues& value : vertex_defects(s.mesh, s.atoms, {})) EXPECT_FALSE(value.any());
  EXPECT_TRUE(vertex_defects({}, {}, {}).empty());
}

}  // namespace
}  // namespace atomesh
