#include "preprocess/carve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;  // and per look whether to cancel

std::vector<double> circumradii(const TetMesh& mesh, Progress& progress) {
  std::vector<double> radii(mesh.tetrahedra.size());
  parallel_for(radii.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tetrahedra[t];
      radii[t] = circumsphere(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]).radius;
    }
  });
  return radii;
}

// The value that a fraction `q` of the values do not exceed; 0 when there are none.
double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// Of each vertex of a tetrahedron: the length of its shortest edge, which in a Delaunay mesh leads to its nearest
// neighbour, and the largest circumradius around it.
struct Surroundings {
  std::vector<double> nearest;
  std::vector<double> largest_void;
};

Surroundings look_around(const TetMesh& mesh, const std::vector<double>& radii, Progress& progress) {
  const double none = std::numeric_limits<double>::infinity();
  std::vector<double> nearest(mesh.vertices.size(), none);
  std::vector<double> largest(mesh.vertices.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (t % tetrahedra_per_range == 0) progress.check();
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int i = 0; i < 4; ++i) {
      largest[tet[i]] = std::max(largest[tet[i]], radii[t]);
      for (int j = i + 1; j < 4; ++j) {
        const Vec3 edge = mesh.vertices[tet[i]] - mesh.vertices[tet[j]];
        const double squared = glm::dot(edge, edge);
        nearest[tet[i]] = std::min(nearest[tet[i]], squared);
        nearest[tet[j]] = std::min(nearest[tet[j]], squared);
      }
    }
  }
  std::erase(nearest, none);
  std::erase(largest, 0.0);
  for (double& squared : nearest) squared = std::sqrt(squared);
  return {std::move(nearest), std::move(largest)};
}

}  // namespace

TetMesh carve(TetMesh mesh, const CarveOptions& options, CarveReport& report, Progress& progress) {
  if (!(options.radius >= 0.0) || !std::isfinite(options.radius)) {
    throw UsageError("the carving radius must be a length in Å, or 0 for automatic; got " +
                     std::to_string(options.radius));
  }
  report = {};
  const std::vector<double> radii = circumradii(mesh, progress);
  progress.update(0.6);
  Surroundings around = look_around(mesh, radii, progress);
  report.nearest_neighbour = quantile(std::move(around.nearest), 0.5);
  report.radius = options.radius > 0.0 ? options.radius
                                       : std::min(carve_void_factor * quantile(std::move(around.largest_void), 0.25),
                                                  carve_neighbour_factor * report.nearest_neighbour);
  progress.update(0.8);

  // In place: the mesh may be most of what the process holds.
  std::vector<bool> used(mesh.vertices.size(), false);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (t % tetrahedra_per_range == 0) progress.check();
    if (radii[t] > report.radius) continue;
    mesh.tetrahedra[kept++] = mesh.tetrahedra[t];
    for (const Index v : mesh.tetrahedra[t]) used[v] = true;
  }
  report.removed = mesh.tetrahedra.size() - kept;
  mesh.tetrahedra.resize(kept);
  report.bare_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  progress.update(1.0);
  return mesh;
}

}  // namespace atomesh
