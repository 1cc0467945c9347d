#include "preprocess/remove_slivers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/compensated_sum.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/predicates.h"
#include "core/tet_mesh.h"
#include "preprocess/gather_polytopes.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;

using Neighbours = std::vector<std::array<Index, 4>>;

std::vector<Index> ranks_by_position(std::span<const Vec3> points, const Progress& progress) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::size_t compared = 0;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (++compared % (1 << 20) == 0) progress.check();
    const Vec3 &p = points[a], &q = points[b];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  });
  std::vector<Index> rank(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<Index>(i);
  return rank;
}

// Twice the area of the faces with nothing behind them.
double outside_area(const TetMesh& mesh, const Neighbours& neighbours, const Progress& progress) {
  CompensatedSum sum;
  for (std::size_t t = 0; t < neighbours.size(); ++t) {
    if (t % tetrahedra_per_range == 0) progress.check();
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int f = 0; f < 4; ++f) {
      if (neighbours[t][f] != no_index) continue;
      const Vec3& a = mesh.vertices[tet[face_corners[f][0]]];
      sum.add(glm::length(
          glm::cross(mesh.vertices[tet[face_corners[f][1]]] - a, mesh.vertices[tet[face_corners[f][2]]] - a)));
    }
  }
  return sum.value();
}

bool all_positive(const TetMesh& mesh, const Progress& progress) {
  std::atomic<bool> positive{true};
  parallel_for(mesh.tetrahedra.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tetrahedra[t];
      if (orientation(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]) <= 0) positive = false;
    }
  });
  return positive;
}

// Whether `after` fills what `before` fills. Two polytopes that disagreed about a face would leave a slit, with the
// face twice on the outside.
bool fills_the_same(const TetMesh& before, const Neighbours& neighbours, const TetMesh& after, Progress& progress) {
  constexpr double same = 1e-9;
  const double volume_before = volume(before, progress);
  if (!all_positive(after, progress)) return false;
  if (std::abs(volume(after, progress) - volume_before) > same * volume_before) return false;
  const double area_before = outside_area(before, neighbours, progress);
  try {
    const double area_after = outside_area(after, face_neighbours(after, progress), progress);
    return std::abs(area_after - area_before) <= same * area_before;
  } catch (const CancelledError&) {
    throw;
  } catch (const Error&) {
    return false;  // a face of three
  }
}

}  // namespace

std::size_t remove_slivers(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points, Progress& progress) {
  constexpr PolytopeTolerance tolerance{sliver_thickness, sliver_sphere_tolerance};
  const std::vector<std::uint8_t> sliver = find_slivers(tetrahedra, points, tolerance, progress);
  const auto slivers = static_cast<std::size_t>(std::count(sliver.begin(), sliver.end(), 1));
  if (slivers == 0) return 0;

  TetMesh before;
  before.vertices.assign(points.begin(), points.end());
  before.tetrahedra = tetrahedra;
  const Neighbours neighbours = face_neighbours(before, progress);
  const auto members = gather_polytopes(tetrahedra, points, neighbours, sliver, tolerance, progress);
  TetMesh after;
  after.vertices = before.vertices;
  const std::vector<Index> rank = ranks_by_position(points, progress);
  if (!cut_polytopes(tetrahedra, points, members, rank, tolerance, after.tetrahedra, progress)) return 0;
  if (!fills_the_same(before, neighbours, after, progress)) return 0;
  tetrahedra = std::move(after.tetrahedra);
  return slivers;
}

}  // namespace atomesh
