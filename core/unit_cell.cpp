#include "core/unit_cell.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/error.h"

namespace atomesh {

namespace {

// Two basis atoms nearer than this (Å) are one site written twice.
constexpr double same_site = 0.01;
// Volume over the product of the lengths: what rounding to six digits leaves of three coplanar vectors.
constexpr double flatness = 1e-6;

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double square(const Vec3& v) {
  return glm::dot(v, v);
}

void check_basis_apart(const UnitCell& cell) {
  const Mat3 to_fraction = glm::inverse(cell.matrix());
  // A hash grid over the cell with boxes at least same_site thick between lattice planes, so that the whole test is
  // linear in the number of atoms.
  std::array<std::int64_t, 3> boxes;
  for (int k = 0; k < 3; ++k) {
    // Rows of the inverse are the reciprocal vectors; their length is one over the distance of the planes.
    const Vec3 reciprocal(to_fraction[0][k], to_fraction[1][k], to_fraction[2][k]);
    const double count = std::floor(1.0 / (same_site * glm::length(reciprocal)));
    boxes[k] = static_cast<std::int64_t>(std::clamp(count, 1.0, 1048576.0));
  }
  const auto key_of = [&boxes](std::array<std::int64_t, 3> box) {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = key << 21 | static_cast<std::uint64_t>((box[k] + boxes[k]) % boxes[k]);
    return key;
  };
  std::unordered_multimap<std::uint64_t, std::size_t> sites;
  sites.reserve(cell.basis.size());
  for (std::size_t i = 0; i < cell.basis.size(); ++i) {
    const Vec3 fraction = to_fraction * cell.basis[i].position;
    const Vec3 wrapped = fraction - glm::floor(fraction);
    std::array<std::int64_t, 3> box;
    for (int k = 0; k < 3; ++k) {
      box[k] = std::min(static_cast<std::int64_t>(wrapped[k] * static_cast<double>(boxes[k])), boxes[k] - 1);
    }
    for (int n = 0; n < 27; ++n) {
      const auto [first, last] =
          sites.equal_range(key_of({box[0] + n % 3 - 1, box[1] + n / 3 % 3 - 1, box[2] + n / 9 - 1}));
      for (auto site = first; site != last; ++site) {
        const Vec3 difference = to_fraction * (cell.basis[site->second].position - cell.basis[i].position);
        if (glm::length(cell.matrix() * (difference - glm::round(difference))) < same_site) {
          throw Error("unit cell: basis atoms " + std::to_string(site->second + 1) + " and " + std::to_string(i + 1) +
                      " are on the same site (modulo the primitive vectors)");
        }
      }
    }
    sites.emplace(key_of(box), i);
  }
}

// The shortest vector of v + Z·a + Z·b. The plane lattice (a, b) is Lagrange-reduced, so the best integers are next to
// the rounded real ones.
Vec3 shorten(const Vec3& v, const Vec3& a, const Vec3& b) {
  const double aa = square(a);
  const double bb = square(b);
  const double ab = glm::dot(a, b);
  const double determinant = aa * bb - ab * ab;
  const double va = glm::dot(v, a);
  const double vb = glm::dot(v, b);
  const double x = std::round((va * bb - vb * ab) / determinant);
  const double y = std::round((vb * aa - va * ab) / determinant);
  Vec3 best = v;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Vec3 candidate = v - (x + i) * a - (y + j) * b;
      // Strictly shorter beyond rounding, so that ties end the loop of reduce_lattice.
      if (square(candidate) < square(best) * (1.0 - 1e-12)) best = candidate;
    }
  }
  return best;
}

}  // namespace

double UnitCell::longest_primitive() const {
  return std::max({glm::length(primitive[0]), glm::length(primitive[1]), glm::length(primitive[2])});
}

void check_unit_cell(const UnitCell& cell) {
  double product = 1.0;
  for (int k = 0; k < 3; ++k) {
    const std::string which = "unit cell: primitive vector " + std::to_string(k + 1);
    if (!finite(cell.primitive[k])) throw Error(which + " is not finite");
    const double length = glm::length(cell.primitive[k]);
    if (!std::isfinite(length)) throw Error(which + " is too long");
    if (length == 0.0) throw Error(which + " is zero");
    product *= length;
  }
  // Written so that an overflow to infinity or an underflow to zero fails too.
  const double volume = cell.volume();
  if (!(volume > flatness * product) || !std::isfinite(product)) {
    throw Error("unit cell: the three primitive vectors lie in one plane (volume " + std::to_string(volume) +
                " Å³); expected three independent vectors");
  }
  if (cell.basis.empty()) throw Error("unit cell: no basis atom; expected at least one");
  for (std::size_t i = 0; i < cell.basis.size(); ++i) {
    if (!finite(cell.basis[i].position)) {
      throw Error("unit cell: basis atom " + std::to_string(i + 1) + " has a position that is not finite");
    }
  }
  check_basis_apart(cell);
}

// Greedy reduction in three dimensions: I. Semaev, "A 3-dimensional lattice reduction algorithm", CaLC 2001. Shorten
// the longest vector by the other two until that no longer helps.
std::array<Vec3, 3> reduce_lattice(const std::array<Vec3, 3>& primitive) {
  const double volume = glm::determinant(Mat3(primitive[0], primitive[1], primitive[2]));
  if (volume == 0.0 || !std::isfinite(volume)) {
    throw Error("lattice: the three primitive vectors span no volume; expected three independent vectors");
  }
  std::array<Vec3, 3> v = primitive;
  const auto by_length = [](const Vec3& p, const Vec3& q) { return square(p) < square(q); };
  for (;;) {
    std::stable_sort(v.begin(), v.end(), by_length);
    // Lagrange in the plane of the two shorter ones.
    for (;;) {
      const Vec3 shorter = v[1] - std::round(glm::dot(v[0], v[1]) / square(v[0])) * v[0];
      if (!(square(shorter) < square(v[1]) * (1.0 - 1e-12))) break;
      v[1] = shorter;
      if (square(v[1]) < square(v[0])) std::swap(v[0], v[1]);
    }
    const Vec3 shorter = shorten(v[2], v[0], v[1]);
    if (shorter == v[2]) break;
    v[2] = shorter;
  }
  if (glm::determinant(Mat3(v[0], v[1], v[2])) < 0.0) {
    for (Vec3& vector : v) vector = -vector;
  }
  return v;
}

}  // namespace atomesh
