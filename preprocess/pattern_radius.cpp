#include "preprocess/pattern_radius.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/circumsphere.h"
#include "core/parallel.h"
#include "preprocess/carve.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_check = 1 << 14;

double radius_of(const Tetrahedron& t, std::span<const Vec3> p) {
  return circumsphere(p[t[0]], p[t[1]], p[t[2]], p[t[3]]).radius;
}

// The value that a share of a crystal's atoms do not exceed, given one value for each atom of the cell.
double quantile_of_basis(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  return values[static_cast<std::size_t>(std::max(place, 0.0))];
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::uint64_t hash_vertex(Index v) {
  std::uint64_t h = (std::uint64_t{v} + 1) * 0x9E3779B97F4A7C15ULL;
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93ULL;
  return h ^ (h >> 32);
}

// What the tetrahedra around each vertex say of it.
struct Surroundings {
  std::vector<double> largest;          // Å, circumradius
  std::vector<double> nearest_squared;  // Å², edge
  // Faces inside are met twice and cancel: what is left at a vertex tells whether it is on the outside.
  std::vector<std::uint64_t> faces;

  explicit Surroundings(std::size_t vertices = 0)
      : largest(vertices, 0.0),
        nearest_squared(vertices, std::numeric_limits<double>::infinity()),
        faces(vertices, 0) {}

  void add(const Tetrahedron& t, double radius, std::span<const Vec3> points) {
    std::array<std::uint64_t, 4> hash;
    for (int f = 0; f < 4; ++f) hash[f] = hash_vertex(t[f]);
    for (int f = 0; f < 4; ++f) {
      // The same whatever the order of the corners.
      std::uint64_t sum = 0;
      std::uint64_t product = 1;
      for (const int corner : face_corners[f]) {
        sum += hash[corner];
        product *= hash[corner] | 1;
      }
      for (const int corner : face_corners[f]) faces[t[corner]] ^= sum ^ product;
      largest[t[f]] = std::max(largest[t[f]], radius);
      for (int g = f + 1; g < 4; ++g) {
        const Vec3 edge = points[t[f]] - points[t[g]];
        const double squared = glm::dot(edge, edge);
        nearest_squared[t[f]] = std::min(nearest_squared[t[f]], squared);
        nearest_squared[t[g]] = std::min(nearest_squared[t[g]], squared);
      }
    }
  }

  void add(const Surroundings& other, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      largest[v] = std::max(largest[v], other.largest[v]);
      nearest_squared[v] = std::min(nearest_squared[v], other.nearest_squared[v]);
      faces[v] ^= other.faces[v];
    }
  }
};

}  // namespace

PatternRadius pattern_radius(const LatticeTemplate& pattern, const Mat3& matrix) {
  const Mat3 strain = matrix * glm::inverse(pattern.cell.matrix());
  const std::size_t basis = pattern.cell.basis.size();
  std::vector<double> voids(basis, 0.0);
  std::vector<double> nearest(basis, std::numeric_limits<double>::infinity());
  for (const TemplatePolytope& polytope : pattern.polytopes) {
    double fattest = 0.0;
    double radius = polytope.radius;
    std::vector<Vec3> corners;
    for (const SiteOffset& s : polytope.corners) corners.push_back(strain * pattern.position(s));
    for (const auto& t : polytope.tetrahedra) {
      const double volume = signed_volume(corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]);
      if (volume <= fattest) continue;
      fattest = volume;
      radius = circumsphere(corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]).radius;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      double& largest = voids[polytope.corners[i].basis];
      largest = std::max(largest, radius);
      for (std::size_t j = 0; j < corners.size(); ++j) {
        double& edge = nearest[polytope.corners[i].basis];
        if (i != j) edge = std::min(edge, glm::distance(corners[i], corners[j]));
      }
    }
  }
  const auto [least, most] = std::minmax_element(voids.begin(), voids.end());
  PatternRadius result;
  result.certain = *most - *least <= 1e-9 * *most;
  result.radius = std::min(carve_void_factor * quantile_of_basis(voids, 0.25),
                           carve_neighbour_factor * quantile_of_basis(nearest, 0.5));
  return result;
}

RadiusBounds enclose_radius(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points, Progress& progress) {
  constexpr std::size_t most_parts = 4, vertices_per_range = 1 << 14;
  std::vector<double> radii(tetrahedra.size());
  // Each part looks at its own tetrahedra. How many parts there are has no say in the result.
  const std::size_t parts = std::clamp<std::size_t>(static_cast<std::size_t>(threads()), 1, most_parts);
  const std::size_t part_size = std::max<std::size_t>((tetrahedra.size() + parts - 1) / parts, 1);
  std::vector<Surroundings> around(parts);
  parallel_for(parts, 1, [&](std::size_t part, std::size_t) {
    around[part] = Surroundings(points.size());
    const std::size_t end = std::min(tetrahedra.size(), (part + 1) * part_size);
    for (std::size_t t = part * part_size; t < end; ++t) {
      if (t % tetrahedra_per_check == 0) progress.check();
      radii[t] = radius_of(tetrahedra[t], points);
      around[part].add(tetrahedra[t], radii[t], points);
    }
  });
  parallel_for(points.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = 1; part < parts; ++part) around[0].add(around[part], begin, end);
  });
  std::vector<double> largest = std::move(around[0].largest);
  std::vector<double> nearest = std::move(around[0].nearest_squared);
  const std::vector<std::uint64_t> faces = std::move(around[0].faces);
  around.clear();
  std::vector<double> enclosed = largest;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (faces[v] != 0 || largest[v] == 0.0) enclosed[v] = std::numeric_limits<double>::infinity();
  }
  std::erase(nearest, std::numeric_limits<double>::infinity());
  const double widest = carve_neighbour_factor * std::sqrt(quantile(nearest, 0.5));
  RadiusBounds bounds;
  bounds.least = std::min(carve_void_factor * quantile(largest, 0.25), widest);
  bounds.largest = std::min(carve_void_factor * quantile(enclosed, 0.25), widest);
  bounds.between = static_cast<std::size_t>(
      std::count_if(radii.begin(), radii.end(), [&](double r) { return r > bounds.least && r <= bounds.largest; }));
  return bounds;
}

}  // namespace atomesh
