#include "preprocess/file_rounding.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "preprocess/stamp_pattern.h"

namespace atomesh {

namespace {

constexpr std::size_t asked_points = 1000;
constexpr std::size_t points_per_range = 1 << 14;
// Multiples of the rounding: how far a corner is off its site at most (its cube's half diagonal and the fit's error),
// and how far it may then be off a sphere that four others, as much off, define.
constexpr double off_site = 1.5;
constexpr double off_sphere = 15.0;
constexpr double widest = 0.0099;

bool is_rounded_to(double value, double step) {
  // Coordinates as large as 1e4 Å keep 12 digits behind the point.
  return std::abs(value - std::round(value / step) * step) <= 1e-4 * step + 4e-16 * std::abs(value);
}

}  // namespace

double find_rounding(std::span<const Vec3> points) {
  if (points.empty()) return 0.0;
  const std::size_t stride = std::max<std::size_t>(points.size() / asked_points, 1);
  for (int digits = 2; digits <= 7; ++digits) {
    const double step = std::pow(10.0, -digits);
    bool all = true;
    for (std::size_t i = 0; all && i < points.size(); i += stride) {
      for (int k = 0; k < 3; ++k) all = all && is_rounded_to(points[i][k], step);
    }
    if (all) return step;
  }
  return 0.0;
}

double tolerance_of_rounding(std::span<const Vec3> points, const LatticeSites& sites, double rounding, double least,
                             Progress& progress) {
  if (!(rounding > 0.0) || sites.patches.empty()) return 0.0;
  double tolerance = 0.0;
  std::vector<std::vector<Vec3>> places;  // of each patch's basis, from the cell's origin
  for (const LatticePatch& patch : sites.patches) {
    const LatticeTemplate& pattern = sites.patterns[patch.pattern];
    if (pattern.polytopes.empty()) return 0.0;
    const PatchPattern fitted(pattern, patch, pattern.pulling_direction);
    for (const PatternPolytope& polytope : fitted.polytopes()) {
      if (polytope.spread > off_sphere * rounding) return 0.0;
      tolerance = std::max(tolerance, off_sphere * rounding / polytope.radius);
    }
    places.emplace_back();
    for (const Vec3& f : sites.fractional(patch.pattern)) places.back().push_back(patch.matrix * f);
  }
  if (!(tolerance < widest)) return 0.0;
  std::vector<std::size_t> near(points.size() / points_per_range + 1, 0);
  parallel_for(points.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const LatticeSite& site = sites.of[i];
      if (site.patch == no_patch) continue;
      const LatticePatch& patch = sites.patches[site.patch];
      const Vec3 cell(site.cell[0], site.cell[1], site.cell[2]);
      const Vec3 off = points[i] - (patch.origin + patch.matrix * cell + places[site.patch][site.basis]);
      if (glm::dot(off, off) <= off_site * off_site * rounding * rounding) ++near[begin / points_per_range];
    }
  });
  std::size_t all = 0;
  for (const std::size_t n : near) all += n;
  return static_cast<double>(all) >= least * static_cast<double>(points.size()) ? tolerance : 0.0;
}

}  // namespace atomesh
