#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/circumsphere.h"
#include "core/error.h"
#include "preprocess/lattice_template.h"
#include "tests/support/lattices.h"
#include "tests/support/meshes.h"

namespace atomesh::test {
namespace {

UnitCell cell_of(std::array<Vec3, 3> vectors, const std::vector<Vec3>& fractions) {
  UnitCell cell;
  cell.primitive = vectors;
  for (const Vec3& f : fractions) cell.basis.push_back({"X", cell.matrix() * f});
  return cell;
}

UnitCell box(double a, double b, double c, const std::vector<Vec3>& fractions = {Vec3(0.0)}) {
  return cell_of({Vec3(a, 0, 0), Vec3(0, b, 0), Vec3(0, 0, c)}, fractions);
}

// Crystals beyond those every test uses: hexagonal, tetragonal and low-symmetric ones.
std::vector<std::pair<std::string, UnitCell>> more_cells() {
  const auto hexagonal = [](double a, double c) {
    return std::array<Vec3, 3>{Vec3(a, 0, 0), Vec3(-a / 2, a * std::sqrt(3.0) / 2, 0), Vec3(0, 0, c)};
  };
  const double t = 1.0 / 3.0, u = 0.3053;
  std::vector<Vec3> fluorite{{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}};
  for (int n = 0; n < 8; ++n)
    fluorite.emplace_back(0.25 + 0.5 * (n & 1), 0.25 + 0.5 * (n >> 1 & 1), 0.25 + 0.5 * (n >> 2));
  return {
      {"hcp", cell_of(hexagonal(2.95, 2.95 * std::sqrt(8.0 / 3.0)), {{t, 2 * t, .25}, {2 * t, t, .75}})},
      {"hcp, real", cell_of(hexagonal(2.95, 4.686), {{t, 2 * t, .25}, {2 * t, t, .75}})},
      {"wurtzite", cell_of(hexagonal(3.81, 6.23), {{t, 2 * t, 0}, {2 * t, t, .5}, {t, 2 * t, .375}, {2 * t, t, .875}})},
      {"rutile",
       box(4.594, 4.594, 2.959,
           {{0, 0, 0}, {.5, .5, .5}, {u, u, 0}, {1 - u, 1 - u, 0}, {.5 + u, .5 - u, .5}, {.5 - u, .5 + u, .5}})},
      {"fluorite", box(5.463, 5.463, 5.463, fluorite)},
      {"CaCuO2", box(3.853, 3.853, 3.177, {{.5, .5, .5}, {0, 0, 0}, {.5, 0, 0}, {0, .5, 0}})},
      {"plate", box(1, 7, 35)},
      {"needle", box(3, 3, 15)},
      {"monoclinic", cell_of({Vec3(3.1, 0, 0), Vec3(0.4, 4.7, 0), Vec3(1.9, 0.3, 5.2)}, {{0, 0, 0}, {.31, .22, .47}})},
      {"skew", cell_of({Vec3(3, 0, 0), Vec3(30.1, 3, 0), Vec3(-64, 47.3, 3)}, {{0, 0, 0}, {.5, .5, .5}})},
  };
}

std::vector<std::pair<std::string, UnitCell>> all_cells() {
  auto cells = more_cells();
  for (const Lattice& l : lattices()) cells.emplace_back(l.name, l.cell);
  return cells;
}

// The template's tetrahedra of n³ cells as one mesh.
TetMesh stack(const LatticeTemplate& pattern, int n) {
  std::map<std::array<int, 4>, Index> number;
  std::vector<Vec3> vertices;
  std::vector<Tetrahedron> tetrahedra;
  for (int c = 0; c < n * n * n; ++c) {
    const std::array<int, 3> anchor{c % n, c / n % n, c / n / n};
    for (const TemplatePolytope& p : pattern.polytopes) {
      std::vector<Index> corner;
      for (const SiteOffset& s : p.corners) {
        const std::array<int, 4> key{anchor[0] + s.cell[0], anchor[1] + s.cell[1], anchor[2] + s.cell[2], s.basis};
        const auto [place, added] = number.emplace(key, static_cast<Index>(vertices.size()));
        if (added) {
          vertices.push_back(pattern.cell.matrix() * Vec3(key[0], key[1], key[2]) +
                             pattern.cell.basis[s.basis].position);
        }
        corner.push_back(place->second);
      }
      for (const auto& t : p.tetrahedra) tetrahedra.push_back({corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]});
    }
  }
  return mesh_of(vertices, tetrahedra);
}

void expect_sound(const LatticeTemplate& pattern, const UnitCell& cell, const std::string& what) {
  EXPECT_GT(glm::determinant(pattern.cell.matrix()), 0.0) << what;
  ASSERT_EQ(pattern.cell.basis.size(), cell.basis.size()) << what;
  const Mat3 inverse = glm::inverse(pattern.cell.matrix());
  for (std::size_t b = 0; b < cell.basis.size(); ++b) {
    EXPECT_EQ(pattern.cell.basis[b].species, cell.basis[pattern.given_basis[b]].species) << what;
    const Vec3 f = inverse * (pattern.cell.basis[b].position - cell.basis[pattern.given_basis[b]].position);
    EXPECT_LT(glm::length(f - glm::round(f)), 1e-9) << what;
  }
  double volume_of_all = 0.0;
  double largest = 0.0;
  for (const TemplatePolytope& p : pattern.polytopes) {
    ASSERT_GE(p.corners.size(), 4u) << what;
    EXPECT_EQ(p.corners[0].cell, (std::array<std::int8_t, 3>{})) << what;
    largest = std::max(largest, p.radius);
    for (const SiteOffset& s : p.corners) {
      EXPECT_NEAR(glm::distance(pattern.position(s), p.center), p.radius, 1e-5 * p.radius) << what;
    }
    for (const auto& t : p.tetrahedra) {
      volume_of_all += signed_volume(pattern.position(p.corners[t[0]]), pattern.position(p.corners[t[1]]),
                                     pattern.position(p.corners[t[2]]), pattern.position(p.corners[t[3]]));
    }
  }
  EXPECT_NEAR(volume_of_all, cell.volume(), 1e-6 * cell.volume()) << what;
  EXPECT_EQ(pattern.largest_void, largest) << what;
  TetMesh mesh = stack(pattern, 3);
  mesh.delaunay = true;
  EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << what;
  EXPECT_NEAR(volume(mesh), 27.0 * cell.volume(), 1e-5 * cell.volume()) << what;
}

TEST(LatticeTemplate, FillsSpaceAndIsDelaunayForEveryCrystal) {
  for (const auto& [name, cell] : all_cells()) {
    expect_sound(make_lattice_template(cell), cell, name);
    UnitCell turned = cell;
    for (Vec3& v : turned.primitive) v = odd_rotation() * v;
    for (BasisAtom& b : turned.basis) b.position = odd_rotation() * b.position + Vec3(0.3, -0.2, 11.0);
    expect_sound(make_lattice_template(turned), turned, name + ", turned");
  }
}

TEST(LatticeTemplate, KnownPolytopes) {
  const auto sizes = [](const LatticeTemplate& pattern) {
    std::map<std::size_t, int> count;
    for (const TemplatePolytope& p : pattern.polytopes) ++count[p.corners.size()];
    return count;
  };
  using Count = std::map<std::size_t, int>;
  EXPECT_EQ(sizes(make_lattice_template(lattice("sc").cell)), (Count{{8, 1}}));
  // Per atom one octahedron and two tetrahedra; four atoms in the cubic cell.
  EXPECT_EQ(sizes(make_lattice_template(lattice("fcc").cell)), (Count{{4, 8}, {6, 4}}));
  EXPECT_EQ(sizes(make_lattice_template(lattice("bcc").cell)), (Count{{4, 12}}));
  EXPECT_EQ(sizes(make_lattice_template(lattice("nacl").cell)), (Count{{8, 8}}));
  // The tetrahedral interstice is as far from its atoms as they are from each other.
  const LatticeTemplate diamond = make_lattice_template(lattice("diamond").cell);
  EXPECT_NEAR(diamond.largest_void, lattice("diamond").nearest_neighbour, 1e-9);
  EXPECT_NEAR(make_lattice_template(lattice("fcc").cell).largest_void, 0.5 * 3.615, 1e-9);
}

TEST(LatticeTemplate, DoesNotDependOnTheCellsVectors) {
  for (const Lattice& l : lattices()) {
    const LatticeTemplate plain = make_lattice_template(l.cell);
    UnitCell skew = l.cell;
    skew.primitive[0] += 3.0 * skew.primitive[1] - 2.0 * skew.primitive[2];
    skew.primitive[2] = -skew.primitive[2] + 5.0 * skew.primitive[0];
    const LatticeTemplate other = make_lattice_template(skew);
    EXPECT_EQ(plain.polytopes.size(), other.polytopes.size()) << l.name;
    EXPECT_NEAR(plain.largest_void, other.largest_void, 1e-9) << l.name;
    expect_sound(other, skew, l.name);
  }
}

TEST(LatticeTemplate, CellsGivenToSixDigitsHaveThePolytopesOfExactOnes) {
  for (const auto& [name, cell] : all_cells()) {
    UnitCell rounded = cell;
    for (Vec3& v : rounded.primitive) v = glm::round(odd_rotation() * v * 1e6) / 1e6;
    for (BasisAtom& b : rounded.basis) b.position = glm::round(odd_rotation() * b.position * 1e6) / 1e6;
    const LatticeTemplate exact = make_lattice_template(cell);
    const LatticeTemplate given = make_lattice_template(rounded);
    if (name == "skew") continue;  // long vectors: rounding them is a strain a hundred times larger
    EXPECT_EQ(exact.polytopes.size(), given.polytopes.size()) << name;
  }
}

TEST(LatticeTemplate, CornersOfAPolytopeStandWellApartAlongThePull) {
  for (const Lattice& l : lattices()) {
    const LatticeTemplate pattern = make_lattice_template(l.cell);
    double separation = 1e9;
    for (const TemplatePolytope& p : pattern.polytopes) {
      if (p.corners.size() < 5) continue;
      for (std::size_t i = 0; i < p.corners.size(); ++i) {
        for (std::size_t j = i + 1; j < p.corners.size(); ++j) {
          separation =
              std::min(separation, std::abs(glm::dot(pattern.pulling_direction,
                                                     pattern.position(p.corners[i]) - pattern.position(p.corners[j]))));
        }
      }
    }
    EXPECT_GT(separation, 0.02 * l.nearest_neighbour) << l.name;
  }
}

TEST(LatticeTemplate, CellsItCannotHandleAreErrors) {
  EXPECT_THROW(make_lattice_template(UnitCell{}), Error);
  EXPECT_THROW(make_lattice_template(box(1, 1, 0)), Error);
  EXPECT_THROW(make_lattice_template(box(1, 3000, 3000)), Error);
}

}  // namespace
}  // namespace atomesh::test
