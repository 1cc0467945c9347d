#include "core/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/compensated_sum.h"
#include "core/parallel.h"
#include "core/shared_faces.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;

}  // namespace

double volume(const TetMesh& mesh, Progress& progress) {
  const std::size_t count = mesh.tetrahedra.size();
  const auto& v = mesh.vertices;
  // By ranges of fixed size, so that the sum does not depend on the number of threads.
  std::vector<double> range_volume((count + tetrahedra_per_range - 1) / tetrahedra_per_range);
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    CompensatedSum sum;
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = mesh.tetrahedra[i];
      sum.add(signed_volume(v[t[0]], v[t[1]], v[t[2]], v[t[3]]));
    }
    range_volume[begin / tetrahedra_per_range] = sum.value();
  });
  CompensatedSum sum;
  for (const double part : range_volume) sum.add(part);
  return sum.value();
}

double min_dihedral_degrees(const TetMesh& mesh, Progress& progress) {
  if (mesh.tetrahedra.empty()) return 0.0;
  const std::size_t count = mesh.tetrahedra.size();
  struct Steepest {
    double key = -std::numeric_limits<double>::infinity();  // cot |cot| of the angle: falls from 0 to 180 degrees
    double sine = 0.0;
    double cosine = -1.0;
  };
  std::vector<Steepest> range_steepest((count + tetrahedra_per_range - 1) / tetrahedra_per_range);
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Steepest steepest;
    for (std::size_t i = begin; i < end; ++i) {
      std::array<Vec3, 4> normal;  // outward, twice the face's area long
      for (int f = 0; f < 4; ++f) {
        const Vec3& a = mesh.vertices[mesh.tetrahedra[i][face_corners[f][0]]];
        const Vec3& b = mesh.vertices[mesh.tetrahedra[i][face_corners[f][1]]];
        const Vec3& c = mesh.vertices[mesh.tetrahedra[i][face_corners[f][2]]];
        normal[f] = glm::cross(b - a, c - a);
      }
      for (int f = 0; f < 4; ++f) {
        for (int g = f + 1; g < 4; ++g) {
          // Compared by cotangents, which keep the small angles that cosines round away and need no arc functions.
          const Vec3 across = glm::cross(normal[f], normal[g]);
          const double squared_sine = glm::dot(across, across);
          const double cosine = -glm::dot(normal[f], normal[g]);
          const double key = squared_sine > 0.0 ? cosine * std::abs(cosine) / squared_sine
                                                : std::copysign(std::numeric_limits<double>::infinity(), cosine);
          if (key > steepest.key) steepest = {key, std::sqrt(squared_sine), cosine};
        }
      }
    }
    range_steepest[begin / tetrahedra_per_range] = steepest;
  });
  double smallest = std::numbers::pi;
  for (const Steepest& s : range_steepest) smallest = std::min(smallest, std::atan2(s.sine, s.cosine));
  return smallest * 180.0 / std::numbers::pi;
}

std::vector<std::array<Index, 4>> face_neighbours(const TetMesh& mesh, Progress& progress) {
  const SharedFaces faces(mesh, progress);
  std::vector<std::array<Index, 4>> neighbours(mesh.tetrahedra.size(), {no_index, no_index, no_index, no_index});
  faces.for_each(
      [&](std::size_t, Index v, std::span<const FaceEntry> sharing) {
        require_at_most_two(v, sharing);
        if (sharing.size() < 2) return;
        neighbours[sharing[0].tetrahedron][sharing[0].face] = sharing[1].tetrahedron;
        neighbours[sharing[1].tetrahedron][sharing[1].face] = sharing[0].tetrahedron;
      },
      progress);
  return neighbours;
}

}  // namespace atomesh
