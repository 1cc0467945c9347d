#include "render/gl/cell_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/tet_mesh.h"

namespace atomesh::gl {

namespace {

constexpr std::size_t cells_per_range = 1 << 13;
// How far from one another circumcentres of cells of one sphere are, and how far from it the corner of a flat cell: in
// edges, more than coordinates of files are rounded by; and in the sample's largest coordinate, as floats round.
constexpr double same_sphere = 3e-4;
constexpr double same_sphere_of_sample = 1e-6;
// Fewer share a sphere by chance: they have keys that tell them apart better than those of a cluster.
constexpr std::size_t least_of_cluster = 4;
// In edges; rounded corners turn the sphere of a flatter cell anywhere.
constexpr double flat_height = 1e-2;

struct Sphere {
  Vec3 center;
  double radius;
  double edge;  // of the cell
  bool flat;    // the cell is: center and radius say nothing
};

Sphere sphere_of(const std::array<Vec3, 4>& p) {
  const Vec3 a = p[1] - p[0];
  const Vec3 b = p[2] - p[0];
  const Vec3 c = p[3] - p[0];
  const Vec3 bc = glm::cross(b, c);
  const Vec3 ca = glm::cross(c, a);
  const Vec3 ab = glm::cross(a, b);
  const double volume6 = glm::dot(a, bc);
  const Vec3 to_center = (glm::dot(a, a) * bc + glm::dot(b, b) * ca + glm::dot(c, c) * ab) / (2.0 * volume6);
  const double largest =
      std::sqrt(std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca), glm::dot(ab + bc + ca, ab + bc + ca)}));
  Sphere sphere{p[0] + to_center, glm::length(to_center), glm::length(a), false};
  sphere.flat = !(volume6 > flat_height * sphere.edge * largest);
  return sphere;
}

// Sets of cells that grow together, up to most_of_cluster.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count), size_(count, 1) { std::iota(parent_.begin(), parent_.end(), 0U); }
  Index find(Index cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }
  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b || size_[a] + size_[b] > most_of_cluster) return;
    if (b < a) std::swap(a, b);  // the lowest cell stands for all
    parent_[b] = a;
    size_[a] = static_cast<std::uint8_t>(size_[a] + size_[b]);
  }
  std::size_t size(Index root) const { return size_[root]; }

 private:
  std::vector<Index> parent_;
  std::vector<std::uint8_t> size_;
};

}  // namespace

CellClusters find_cell_clusters(const Scene& scene, std::span<OrderPoint> points, Progress& progress) {
  CellClusters clusters;
  const std::size_t count = scene.tetrahedra.size();
  std::vector<std::array<Index, 4>> neighbours;
  try {
    TetMesh mesh;
    mesh.vertices.resize(scene.vertices.size());
    mesh.tetrahedra.assign(scene.tetrahedra.begin(), scene.tetrahedra.end());
    neighbours = face_neighbours(mesh, progress);
  } catch (const CancelledError&) {
    throw;
  } catch (const Error&) {
    return clusters;
  }
  const auto corner = [&](Index cell, int k) {
    return Vec3(scene.vertices[scene.tetrahedra[cell][static_cast<std::size_t>(k)]]);
  };
  std::vector<Sphere> spheres(count);
  parallel_for(count, cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = static_cast<Index>(i);
      spheres[i] = sphere_of({corner(cell, 0), corner(cell, 1), corner(cell, 2), corner(cell, 3)});
    }
  });
  float reach = 0.0F;
  for (const Vec3f& v : scene.vertices) reach = std::max({reach, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  const auto tolerance = [&](const Sphere& sphere) {
    return std::max(same_sphere * sphere.edge, same_sphere_of_sample * static_cast<double>(reach));
  };
  Sets sets(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (spheres[i].flat) continue;
    for (const Index other : neighbours[i]) {
      if (other == no_index || other < i || spheres[other].flat) continue;
      if (glm::distance(spheres[i].center, spheres[other].center) <= tolerance(spheres[i])) {
        sets.unite(static_cast<Index>(i), other);
      }
    }
  }
  // A flat cell between two clusters belongs to one of them, which it must not make one of.
  for (std::size_t i = 0; i < count; ++i) {
    if (!spheres[i].flat) continue;
    for (int f = 0; f < 4; ++f) {
      const Index other = neighbours[i][static_cast<std::size_t>(f)];
      if (other == no_index || spheres[other].flat) continue;
      const Sphere& sphere = spheres[other];
      const double beside = glm::distance(corner(static_cast<Index>(i), f), sphere.center) - sphere.radius;
      if (std::abs(beside) > tolerance(sphere)) continue;
      sets.unite(static_cast<Index>(i), other);
      break;
    }
  }

  // Places of cells in their clusters, which are numbered by their lowest cells.
  std::vector<Index> place(count, no_index);
  std::vector<Index> number(count, no_index);  // of the cluster a cell stands for
  for (std::size_t i = 0; i < count; ++i) {
    const auto cell = static_cast<Index>(i);
    if (sets.find(cell) != cell || sets.size(cell) < least_of_cluster) continue;
    number[i] = static_cast<Index>(clusters.starts.size());
    clusters.starts.push_back({static_cast<std::uint32_t>(clusters.cells.size()), 0});
    clusters.cells.resize(clusters.cells.size() + sets.size(cell), no_index);
  }
  if (clusters.starts.empty()) return clusters;
  std::vector<std::uint8_t> filled(clusters.starts.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Index cluster = number[sets.find(static_cast<Index>(i))];
    if (cluster == no_index) continue;
    place[i] = filled[cluster]++;
    clusters.cells[clusters.starts[cluster].cell + place[i]] = static_cast<Index>(i);
  }
  clusters.starts.push_back({static_cast<std::uint32_t>(clusters.cells.size()), 0});
  for (std::size_t n = 0; n < clusters.count(); ++n) {
    CellClusters::Start& start = clusters.starts[n];
    start.face = static_cast<std::uint32_t>(clusters.faces.size());
    const std::uint32_t end = clusters.starts[n + 1].cell;
    glm::dvec4 mean(0.0);
    double cells = 0.0;
    for (std::uint32_t at = start.cell; at < end; ++at) {
      const Index cell = clusters.cells[at];
      if (!spheres[cell].flat) {
        mean += glm::dvec4(Vec3(points[cell].p), points[cell].weight);
        cells += 1.0;
      }
      for (int f = 0; f < 4; ++f) {
        const Index other = neighbours[cell][static_cast<std::size_t>(f)];
        if (other == no_index || other < cell || sets.find(other) != sets.find(cell)) continue;
        const auto& [a, b, c] = face_corners[static_cast<std::size_t>(f)];
        const Vec3 normal =
            glm::normalize(glm::cross(corner(cell, b) - corner(cell, a), corner(cell, c) - corner(cell, a)));
        clusters.faces.push_back({Vec4f(glm::dvec4(normal, -glm::dot(normal, corner(cell, a)))),
                                  place[cell] | static_cast<std::uint32_t>(place[other]) << 16});
      }
    }
    mean /= cells;
    for (std::uint32_t at = start.cell; at < end; ++at) {
      points[clusters.cells[at]] = {Vec3f(mean), static_cast<float>(mean.w)};
    }
  }
  clusters.starts.back().face = static_cast<std::uint32_t>(clusters.faces.size());
  return clusters;
}

}  // namespace atomesh::gl
