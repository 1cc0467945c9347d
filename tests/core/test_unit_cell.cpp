// Unit cells: what is refused, and lattices reduced.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/unit_cell.h"
#include "tests/support/lattices.h"

namespace atomesh::test {
namespace {

UnitCell cubic(double a, std::vector<BasisAtom> basis = {{"Na", Vec3(0)}, {"Cl", Vec3(0.5)}}) {
  return {{Vec3(a, 0, 0), Vec3(0, a, 0), Vec3(0, 0, a)}, std::move(basis)};
}

std::string refusal(const UnitCell& cell) {
  try {
    check_unit_cell(cell);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(UnitCell, GoodOnes) {
  for (const Lattice& l : lattices()) EXPECT_EQ(refusal(l.cell), "") << l.name;
  UnitCell left = cubic(4.0);
  std::swap(left.primitive[0], left.primitive[1]);
  EXPECT_EQ(refusal(left), "");
  EXPECT_EQ(left.volume(), 64.0);
  UnitCell needle = cubic(4.0);
  needle.primitive[2] = Vec3(0, 0, 4e5);
  EXPECT_EQ(refusal(needle), "");
  EXPECT_EQ(needle.longest_primitive(), 4e5);
}

TEST(UnitCell, SingularOnesAreRefused) {
  UnitCell cell = cubic(4.0);
  cell.primitive[1] = Vec3(0.0);
  EXPECT_NE(refusal(cell).find("primitive vector 2 is zero"), std::string::npos) << refusal(cell);
  cell.primitive[1] = Vec3(8, 0, 0);
  EXPECT_NE(refusal(cell).find("in one plane"), std::string::npos) << refusal(cell);
  cell.primitive[1] = Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_NE(refusal(cell).find("not finite"), std::string::npos) << refusal(cell);
  // Coplanar but for the rounding of a file with six digits.
  cell.primitive = {Vec3(1.234567, 0.5, 0.25), Vec3(0.3, 0.7, 0.1), Vec3(1.534567, 1.2, 0.350001)};
  EXPECT_NE(refusal(cell).find("in one plane"), std::string::npos) << refusal(cell);
  for (const double extreme : {1e300, 1e-300}) EXPECT_NE(refusal(cubic(extreme)), "") << extreme;
}

TEST(UnitCell, BasisAtomsMustBeApart) {
  EXPECT_NE(refusal(cubic(4.0, {})).find("no basis"), std::string::npos);
  EXPECT_NE(refusal(cubic(4.0, {{"Na", Vec3(1)}, {"Cl", Vec3(2)}, {"Na", Vec3(1.001)}})).find("atoms 1 and 3"),
            std::string::npos);
  // The same site modulo the lattice, across each kind of face.
  for (const Vec3 shift : {Vec3(4, 0, 0), Vec3(0, -8, 4), Vec3(4.004, -4, 0), Vec3(-0.004, 0, 0), Vec3(-0.004)}) {
    EXPECT_NE(refusal(cubic(4.0, {{"Na", Vec3(0)}, {"Cl", shift}})), "") << shift.x;
  }
  EXPECT_EQ(refusal(cubic(4.0, {{"Na", Vec3(0)}, {"Cl", Vec3(-0.02, 0, 0)}})), "");
  EXPECT_NE(refusal(cubic(4.0, {{"Na", Vec3(0)}, {"Cl", Vec3(0, std::nan(""), 0)}})).find("not finite"),
            std::string::npos);
}

TEST(UnitCell, TheBasisTestAgreesWithComparingAllPairs) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    UnitCell cell{{Vec3(0.5, 0, 0), Vec3(0.2, 0.4, 0), Vec3(-0.1, 0.15, 0.3)}, {}};
    for (int i = 0; i < 40; ++i)
      cell.basis.push_back({"C", cell.matrix() * Vec3(unit(random), unit(random), unit(random))});
    bool near = false;
    for (std::size_t i = 0; i < cell.basis.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (int n = 0; n < 27; ++n) {
          const Vec3 image = cell.matrix() * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
          near = near || glm::length(cell.basis[i].position - cell.basis[j].position + image) < 0.01;
        }
      }
    }
    refused += near;
    EXPECT_EQ(!refusal(cell).empty(), near) << round;
  }
  EXPECT_GT(refused, 3);
  EXPECT_LT(refused, 297);
}

// |a| <= |b| <= |c| and no vector can be shortened by small multiples of the others: Minkowski's conditions in 3-D.
void expect_minkowski(const std::array<Vec3, 3>& v) {
  const double slack = 1.0 + 1e-9;
  EXPECT_LE(glm::length(v[0]), glm::length(v[1]) * slack);
  EXPECT_LE(glm::length(v[1]), glm::length(v[2]) * slack);
  for (int i = -1; i <= 1; ++i) {
    EXPECT_LE(glm::length(v[1]), glm::length(v[1] + double(i) * v[0]) * slack);
    for (int j = -1; j <= 1; ++j) {
      EXPECT_LE(glm::length(v[2]), glm::length(v[2] + double(i) * v[0] + double(j) * v[1]) * slack);
    }
  }
  EXPECT_GT(glm::determinant(Mat3(v[0], v[1], v[2])), 0.0);
}

TEST(ReduceLattice, KnownLattices) {
  // Face-centred cubic from its conventional description by long vectors: all three of length a/√2.
  const std::array<Vec3, 3> fcc = reduce_lattice({Vec3(2, 2, 0), Vec3(4, 2, 2), Vec3(4, 4, 4)});
  for (const Vec3& v : fcc) EXPECT_NEAR(glm::length(v), std::sqrt(8.0), 1e-12);
  expect_minkowski(fcc);
  const std::array<Vec3, 3> left = reduce_lattice({Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)});
  expect_minkowski(left);
  EXPECT_EQ(glm::determinant(Mat3(left[0], left[1], left[2])), 1.0);
}

TEST(ReduceLattice, HiddenLatticesAreFoundAgain) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  std::uniform_int_distribution<int> multiple(-4, 4);
  for (int round = 0; round < 500; ++round) {
    std::array<Vec3, 3> v;
    do {
      for (Vec3& vector : v) vector = Vec3(coordinate(random), coordinate(random), coordinate(random));
    } while (std::abs(glm::determinant(Mat3(v[0], v[1], v[2]))) < 0.5);
    const std::array<Vec3, 3> reference = reduce_lattice(v);
    std::array<Vec3, 3> hidden = v;
    for (int step = 0; step < 6; ++step) {
      const int to = step % 3;
      hidden[to] += double(multiple(random)) * hidden[(to + 1) % 3] + double(multiple(random)) * hidden[(to + 2) % 3];
    }
    const std::array<Vec3, 3> reduced = reduce_lattice(hidden);
    expect_minkowski(reduced);
    // The same lattice: integer coordinates, and the same volume.
    const Mat3 inverse = glm::inverse(Mat3(v[0], v[1], v[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 coordinates = inverse * reduced[k];
      EXPECT_LT(glm::length(coordinates - glm::round(coordinates)), 1e-7);
      // Successive minima do not depend on the description.
      EXPECT_NEAR(glm::length(reduced[k]), glm::length(reference[k]), 1e-7);
    }
    EXPECT_NEAR(glm::determinant(Mat3(reduced[0], reduced[1], reduced[2])),
                std::abs(glm::determinant(Mat3(v[0], v[1], v[2]))), 1e-7);
  }
}

TEST(ReduceLattice, RefusesAPlane) {
  EXPECT_THROW(reduce_lattice({Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}), Error);
  EXPECT_THROW(reduce_lattice({Vec3(1, 0, 0), Vec3(0, std::nan(""), 0), Vec3(0, 0, 1)}), Error);
}

}  // namespace
}  // namespace atomesh::test
