#include "preprocess/reduce_atoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

// Points in order of the cubic cell that holds them; cells in order of z, then y, then x, so that three neighbours
// along x are one stretch.
class CellOrder {
 public:
  CellOrder(const std::vector<Vec3>& points, double edge) : points_(points) {
    const Bounds bounds = bounds_of(points);
    const Vec3 extent = bounds.extent();
    // 20 bits an axis, with a free cell on both sides.
    edge_ = std::max(edge, std::max({extent.x, extent.y, extent.z}) / 1048000.0);
    low_ = bounds.min;
    keyed_.resize(points.size());
    parallel_for(points.size(), 65536, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::array<std::int64_t, 3> c = cell(points[i]);
        keyed_[i] = {key(c[0], c[1], c[2]), static_cast<Index>(i)};
      }
    });
    std::sort(keyed_.begin(), keyed_.end());
  }

  // True when `wanted(j)` holds for a point j (other than i) at most the edge length away from point i.
  template <class Wanted>
  bool any_near(std::size_t i, double distance, Wanted&& wanted) const {
    const Vec3& p = points_[i];
    const std::array<std::int64_t, 3> c = cell(p);
    for (std::int64_t dz = -1; dz <= 1; ++dz) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const std::uint64_t last = key(c[0] + 1, c[1] + dy, c[2] + dz);
        auto entry =
            std::lower_bound(keyed_.begin(), keyed_.end(), std::pair(key(c[0] - 1, c[1] + dy, c[2] + dz), Index{0}));
        for (; entry != keyed_.end() && entry->first <= last; ++entry) {
          const Index j = entry->second;
          if (j == i || !wanted(j)) continue;
          const Vec3 d = points_[j] - p;
          if (glm::dot(d, d) <= distance * distance) return true;
        }
      }
    }
    return false;
  }

 private:
  std::array<std::int64_t, 3> cell(const Vec3& p) const {
    std::array<std::int64_t, 3> c;
    for (int k = 0; k < 3; ++k) c[k] = static_cast<std::int64_t>((p[k] - low_[k]) / edge_) + 1;
    return c;
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(z << 42 | y << 21 | x);
  }

  const std::vector<Vec3>& points_;
  double edge_ = 1.0;
  Vec3 low_{0.0};
  std::vector<std::pair<std::uint64_t, Index>> keyed_;
};

// The median over some of the atoms, spread through the file, of the distance to the nearest other atom. Few enough
// for comparing each with all; a median of these few is as good as one of all.
double nearest_neighbour_distance(const std::vector<Vec3>& points) {
  const std::size_t samples = std::min<std::size_t>(points.size(), 64);
  std::vector<double> nearest(samples, std::numeric_limits<double>::infinity());
  parallel_for(samples, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::size_t i = s * points.size() / samples;
      for (std::size_t j = 0; j < points.size(); ++j) {
        const Vec3 d = points[j] - points[i];
        const double square = glm::dot(d, d);
        // Two species may share a site.
        if (square < nearest[s] && square > 0.0) nearest[s] = square;
      }
    }
  });
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(samples / 2), nearest.end());
  return std::sqrt(nearest[samples / 2]);
}

// Which points lie within `distance` of a face of the tightest parallelepiped along the edges of the box.
std::vector<bool> at_boundary(const std::vector<Vec3>& points, const Box& box, double distance) {
  Mat3 edges(1.0);
  if (box.present() && box.volume() != 0.0) edges = box.matrix();
  const Mat3 inverse = glm::inverse(edges);
  std::vector<bool> result(points.size(), false);
  for (int k = 0; k < 3; ++k) {
    // Distance from the plane through the origin spanned by the other two edges.
    const Vec3 normal = glm::normalize(Vec3(inverse[0][k], inverse[1][k], inverse[2][k]));
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& p : points) {
      low = std::min(low, glm::dot(normal, p));
      high = std::max(high, glm::dot(normal, p));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double height = glm::dot(normal, points[i]);
      if (height - low <= distance || high - height <= distance) result[i] = true;
    }
  }
  return result;
}

// Every third bit of the result is one of the low 21 of `value`.
std::uint64_t spread_bits(std::uint64_t value) {
  value = (value | value << 32) & 0x001F00000000FFFFu;
  value = (value | value << 16) & 0x001F0000FF0000FFu;
  value = (value | value << 8) & 0x100F00F00F00F00Fu;
  value = (value | value << 4) & 0x10C30C30C30C30C3u;
  return (value | value << 2) & 0x1249249249249249u;
}

// One of every `keep_every` of the candidates: along a Morton curve consecutive atoms fill compact regions, so that
// every region loses the same share.
std::vector<Index> thinned(const std::vector<Vec3>& points, const std::vector<Index>& candidates,
                           std::size_t keep_every) {
  Bounds bounds;
  for (const Index i : candidates) bounds.add(points[i]);
  const Vec3 extent = bounds.extent();
  const double scale = 2097151.0 / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::vector<std::pair<std::uint64_t, Index>> curve;
  curve.reserve(candidates.size());
  for (const Index i : candidates) {
    const Vec3 p = (points[i] - bounds.min) * scale;
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) code |= spread_bits(static_cast<std::uint64_t>(std::max(p[k], 0.0))) << k;
    curve.emplace_back(code, i);
  }
  std::sort(curve.begin(), curve.end());
  std::vector<Index> kept;
  for (std::size_t c = 0; c < curve.size(); c += keep_every) kept.push_back(curve[c].second);
  return kept;
}

// The species that stay, by index.
std::vector<bool> unmasked_species(const Atoms& atoms, const std::vector<std::string>& mask) {
  std::vector<std::string> names;
  for (const Species& species : atoms.species_table) names.push_back(species.name);
  std::vector<bool> stays(names.size(), true);
  for (const std::string& name : mask) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      std::string list;
      for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
      const std::string nearest = nearest_name(name, names);
      throw UsageError("species \"" + name + "\" cannot be masked: the atoms are " + list +
                       (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
    }
    stays[static_cast<std::size_t>(found - names.begin())] = false;
  }
  return stays;
}

double checked_distance(double distance, const char* name) {
  if (!(distance >= 0.0) || !std::isfinite(distance)) {
    throw UsageError(std::string(name) + " " + std::to_string(distance) +
                     ": expected a finite length, 0 or more, in Å");
  }
  return distance;
}

// Indices, ascending, of the atoms that thinning keeps.
std::vector<Index> thin_out(const Atoms& atoms, const ReduceOptions& options, ReduceReport& report,
                            Progress& progress) {
  const std::vector<Vec3>& points = atoms.positions;
  double transition = options.transition_distance;
  if (transition == 0.0) transition = 1.1 * nearest_neighbour_distance(points);
  // A single site has no neighbour at any distance.
  if (!std::isfinite(transition)) transition = 0.0;
  const double boundary = options.boundary_distance > 0.0 ? options.boundary_distance : transition;
  progress.update(0.2);

  const std::vector<bool> outside = at_boundary(points, atoms.box, boundary);
  std::vector<char> near_other(points.size(), 0);  // not vector<bool>: written in parallel
  const CellOrder cells(points, transition > 0.0 ? transition : 1.0);
  progress.update(0.5);
  parallel_for(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      if (outside[i]) continue;
      near_other[i] = cells.any_near(i, transition, [&](Index j) { return atoms.species[j] != atoms.species[i]; });
    }
  });
  progress.update(0.8);

  std::vector<Index> kept;
  std::vector<Index> rest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (outside[i]) {
      ++report.kept_boundary;
    } else if (near_other[i] != 0) {
      ++report.kept_transition;
    } else {
      rest.push_back(static_cast<Index>(i));
      continue;
    }
    kept.push_back(static_cast<Index>(i));
  }
  const std::vector<Index> sample = thinned(points, rest, options.keep_every);
  report.kept_sample = sample.size();
  report.dropped = rest.size() - sample.size();
  kept.insert(kept.end(), sample.begin(), sample.end());
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

Atoms reduce_atoms(const Atoms& atoms, const ReduceOptions& options, ReduceReport& report, Progress& progress) {
  progress.stage("reduce_atoms");
  report = {};
  if (options.keep_every == 0) throw UsageError("keep_every 0: expected 1 (no thinning) or more");
  checked_distance(options.transition_distance, "transition_distance");
  checked_distance(options.boundary_distance, "boundary_distance");
  const std::vector<bool> stays = unmasked_species(atoms, options.mask);
  std::vector<Index> unmasked;
  unmasked.reserve(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (stays[atoms.species[i]]) unmasked.push_back(static_cast<Index>(i));
  }
  report.masked = atoms.size() - unmasked.size();
  if (unmasked.empty() && atoms.size() > 0)
    throw UsageError("every atom is of a masked species; expected some to stay");
  Atoms result = atoms.subset(unmasked);
  if (options.keep_every == 1) {
    report.kept_sample = result.size();
  } else if (result.size() > 0) {
    result = result.subset(thin_out(result, options, report, progress));
  }
  progress.update(1.0);
  return result;
}

}  // namespace atomesh
