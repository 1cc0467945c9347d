// Defects gathered into clusters.
#include "core/error.h"
#include "preprocess/cluster_defects.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

Material material_of(const Atoms& atoms, const UnitCell& cell) {
  Material material;
  material.atoms = atoms;
  material.unit_cell = cell;
  material.defects = quantify(atoms, cell).defects;
  return material;
}

const UnitCell& copper() {
  return lattice("fcc").cell;
}

double edge() {
  return copper().primitive[0].x;
}

TEST(ClusterDefects, PerfectCrystalHasNone) {
  EXPECT_TRUE(cluster_defects(material_of(cut_block(copper(), 5, 5, 5), copper())).empty());
  EXPECT_TRUE(cluster_defects(Material{}).empty());
}

TEST(ClusterDefects, EachKindIsNamedAndPlaced) {
  Atoms atoms = cut_block(copper(), 16, 6, 6);
  const Vec3 hole = remove_nearest(atoms, Vec3(3.0, 3.0, 3.0) * edge());
  const Index interstitial = static_cast<Index>(atoms.size());
  atoms.positions.push_back(Vec3(8.5, 3.5, 3.5) * edge());
  atoms.species.push_back(0);
  const Index pulled = nearest_atom(atoms, Vec3(13.0, 3.0, 3.0) * edge());
  atoms.positions[pulled] += Vec3(0.2, 0.3, -0.1);
  const Material material = material_of(atoms, copper());
  const std::vector<DefectCluster> clusters = cluster_defects(material);
  ASSERT_EQ(clusters.size(), 3u);
  for (const DefectCluster& cluster : clusters) {
    EXPECT_TRUE(std::is_sorted(cluster.atoms.begin(), cluster.atoms.end()));
    for (const Index atom : cluster.atoms) {
      EXPECT_LE(glm::distance(atoms.positions[atom], cluster.centre), cluster.radius + 1e-9);
    }
    if (cluster.kind == DefectKind::vacancy) {
      EXPECT_NEAR(glm::distance(cluster.centre, hole), 0.0, 1e-6);
      EXPECT_EQ(cluster.atoms.size(), 18u);
      EXPECT_EQ(cluster.vacancies, std::vector<Index>{0});
      EXPECT_NEAR(cluster.radius, edge(), 1e-6);
      EXPECT_EQ(cluster.peak, 1.0F);
    } else if (cluster.kind == DefectKind::extra) {
      EXPECT_NEAR(glm::distance(cluster.centre, atoms.positions[interstitial]), 0.0, 1e-6);
      EXPECT_EQ(cluster.extras, std::vector<Index>{0});
      EXPECT_EQ(cluster.atoms.size(), 15u);  // 6 + 8 neighbours within the edge, and itself
    } else {
      EXPECT_EQ(cluster.kind, DefectKind::positional);
      EXPECT_TRUE(std::binary_search(cluster.atoms.begin(), cluster.atoms.end(), pulled));
      EXPECT_EQ(cluster.peak, material.defects.positional[pulled]);
    }
  }
  EXPECT_GE(clusters[0].atoms.size(), clusters[1].atoms.size());
  EXPECT_GE(clusters[1].atoms.size(), clusters[2].atoms.size());
  // A distance that spans the gaps joins all.
  const std::vector<DefectCluster> joined = cluster_defects(material, 4.0 * edge());
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_EQ(joined[0].kind, DefectKind::mixed);
}

TEST(ClusterDefects, HangTogetherThroughPeriodicFaces) {
  const Atoms full = periodic_block(copper(), 6, 6, 6);
  for (const Index hole : {Index{0}, Index{400}}) {
    const Atoms atoms = without_atoms(full, {hole});
    const std::vector<DefectCluster> clusters = cluster_defects(material_of(atoms, copper()));
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_EQ(clusters[0].kind, DefectKind::vacancy);
    EXPECT_EQ(clusters[0].atoms.size(), 18u);
    EXPECT_NEAR(clusters[0].radius, edge(), 1e-6);
    EXPECT_NEAR(box_distance(clusters[0].centre, full.positions[hole], atoms.box), 0.0, 1e-6);
  }
}

TEST(ClusterDefects, ForeignAtomOnASiteIsASubstitution) {
  Atoms atoms = cut_block(copper(), 6, 6, 6);
  atoms.species[nearest_atom(atoms, Vec3(3.0) * edge())] = atoms.add_species("Au");
  std::vector<DefectCluster> clusters = cluster_defects(material_of(atoms, copper()));
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].kind, DefectKind::substitution);
  EXPECT_EQ(clusters[0].substitutions, std::vector<Index>{0});
  // With a vacancy beside it the cluster is both.
  remove_nearest(atoms, Vec3(3.5, 3.5, 3.0) * edge());
  clusters = cluster_defects(material_of(atoms, copper()));
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].kind, DefectKind::mixed);
  EXPECT_EQ(clusters[0].vacancies.size(), 2u);
  EXPECT_EQ(clusters[0].substitutions.size(), 1u);
}

TEST(ClusterDefects, ScalarFromAFileIsPositional) {
  Material material;
  material.atoms = cut_block(copper(), 4, 4, 4);
  material.defects.positional.assign(material.atoms.size(), 0.0F);
  material.defects.vacancy = material.defects.extra = material.defects.positional;
  material.defects.positional[5] = 7.5F;
  const std::vector<DefectCluster> clusters = cluster_defects(material);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].kind, DefectKind::positional);
  EXPECT_EQ(clusters[0].atoms, std::vector<Index>{5});
  EXPECT_EQ(clusters[0].radius, 0.0);
  EXPECT_EQ(clusters[0].peak, 7.5F);
}

TEST(ClusterDefects, KindsHaveNames) {
  for (const DefectKind kind :
       {DefectKind::vacancy, DefectKind::extra, DefectKind::positional, DefectKind::mixed, DefectKind::substitution}) {
    EXPECT_EQ(defect_kind_from_name(defect_kind_name(kind)), kind);
  }
  try {
    defect_kind_from_name("vacency");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"vacancy\""), std::string::npos) << error.what();
  }
  EXPECT_THROW(cluster_defects(Material{}, -1.0), UsageError);
}

}  // namespace
}  // namespace atomesh::test
