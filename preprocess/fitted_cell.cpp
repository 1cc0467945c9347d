#include "preprocess/fitted_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/unit_cell.h"

namespace atomesh {

namespace {

// A site owns what lies within this share of the distance between sites.
constexpr double reach_of_site = 0.25;
constexpr std::size_t enough_atoms = 40000;

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Per-axis rms of three normal components whose length has this median.
double rms_from_median(double length) {
  return length / 1.5382;
}

struct Match {
  int site;
  Vec3 cell, position;
  double distance;
};

// Least squares of position = vectors·cell + site: the sites are the means, the vectors follow from the spread about
// them, pooled over the sites.
bool solve(const std::vector<Match>& matches, double limit, FittedCell& cell) {
  struct Sum {
    double count = 0.0;
    Vec3 cell{0.0}, position{0.0};
  };
  std::vector<Sum> sums(cell.sites.size());
  for (const Match& m : matches) {
    if (m.distance > limit) continue;
    Sum& sum = sums[static_cast<std::size_t>(m.site)];
    sum.count += 1.0;
    sum.cell += m.cell;
    sum.position += m.position;
  }
  std::size_t fitted = 0;
  for (Sum& sum : sums) {
    if (sum.count == 0.0) continue;
    sum.cell /= sum.count;
    sum.position /= sum.count;
    fitted += static_cast<std::size_t>(sum.count);
  }
  Mat3 spread(0.0);
  Mat3 cross(0.0);
  for (const Match& m : matches) {
    if (m.distance > limit) continue;
    const Sum& sum = sums[static_cast<std::size_t>(m.site)];
    spread += glm::outerProduct(m.cell - sum.cell, m.cell - sum.cell);
    cross += glm::outerProduct(m.position - sum.position, m.cell - sum.cell);
  }
  // Each axis must be spanned by a few cells.
  const double n = static_cast<double>(fitted);
  if (fitted < 3 * sums.size() + 9 || !(glm::determinant(spread) > 1e-4 * n * n * n)) return false;
  cell.vectors = cross * glm::inverse(spread);
  for (std::size_t j = 0; j < sums.size(); ++j) {
    if (sums[j].count > 0.0) cell.sites[j] = sums[j].position - cell.vectors * sums[j].cell;
  }
  cell.fitted = fitted;
  return true;
}

}  // namespace

double nearest_site_distance(const Mat3& vectors, std::span<const Vec3> sites) {
  const Mat3 to_fraction = glm::inverse(vectors);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    for (std::size_t j = i; j < sites.size(); ++j) {
      Vec3 f = to_fraction * (sites[j] - sites[i]);
      f -= glm::round(f);
      for (int n = 0; n < 27; ++n) {
        if (i == j && n == 13) continue;
        const Vec3 d = vectors * (f + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        best = std::min(best, glm::dot(d, d));
      }
    }
  }
  return std::sqrt(best);
}

SiteLookup::SiteLookup(const Mat3& vectors, std::span<const Vec3> sites, double tolerance)
    : vectors_(vectors), to_fraction_(glm::inverse(vectors)), tolerance2_(tolerance * tolerance) {
  const double longest = std::max({glm::length(vectors[0]), glm::length(vectors[1]), glm::length(vectors[2])});
  count_ = static_cast<std::size_t>(std::clamp(2.0 * longest / tolerance, 4.0, 16.0));
  last_ = static_cast<int>(count_) - 1;
  voxels_ = static_cast<double>(count_);
  for (const Vec3& site : sites) {
    const Vec3 f = to_fraction_ * site;
    Vec3 wrapped = f - glm::floor(f);
    for (int k = 0; k < 3; ++k) {
      if (wrapped[k] >= 1.0) wrapped[k] = 0.0;
    }
    fractions_.push_back(wrapped);
  }
  // Half the longest diagonal of a voxel.
  double half = 0.0;
  for (int n = 0; n < 4; ++n) {
    const Vec3 corner(1.0, n % 2 == 0 ? 1.0 : -1.0, n / 2 == 0 ? 1.0 : -1.0);
    half = std::max(half, glm::length(vectors * corner) / (2.0 * voxels_));
  }
  const double reach = tolerance + half;
  // Rounding fractions finds the nearest image within half the distance of the cell's faces; beyond, its neighbours are
  // asked too.
  const Mat3 rows = glm::transpose(to_fraction_);
  const double face = 1.0 / std::max({glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])});
  const auto touches = [&](const Vec3& d) {
    if (reach < 0.5 * face) return glm::dot(vectors * d, vectors * d) <= reach * reach;
    for (int n = 0; n < 27; ++n) {
      const Vec3 image = vectors * (d + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      if (glm::dot(image, image) <= reach * reach) return true;
    }
    return false;
  };
  start_.reserve(count_ * count_ * count_ + 1);
  start_.push_back(0);
  for (std::size_t z = 0; z < count_; ++z) {
    for (std::size_t y = 0; y < count_; ++y) {
      for (std::size_t x = 0; x < count_; ++x) {
        const Vec3 middle = (Vec3(x, y, z) + 0.5) / voxels_;
        for (std::size_t j = 0; j < fractions_.size(); ++j) {
          const Vec3 f = middle - fractions_[j];
          if (touches(f - glm::round(f))) entry_.push_back(static_cast<std::uint32_t>(j));
        }
        start_.push_back(static_cast<std::uint32_t>(entry_.size()));
      }
    }
  }
}

CellFit fit_cell(const LocalCluster& cluster, double radius, const FittedCell& start) {
  CellFit fit{start, 0.0};
  FittedCell& cell = fit.cell;
  const Vec3 shift = cell.origin - cluster.center;
  for (Vec3& site : cell.sites) site += shift;
  const double tolerance = reach_of_site * cell.nearest;
  const double inner = radius - tolerance;
  std::vector<Match> matches;
  std::vector<double> distances;
  // Five rounds let the limit settle: the first fit's error is gone, the rest is the crystal's own.
  double limit = tolerance;
  for (int round = 0; round < 5; ++round) {
    const SiteLookup lookup(cell.vectors, cell.sites, tolerance);
    matches.clear();
    distances.clear();
    std::size_t asked = 0;
    std::size_t met = 0;
    for (const Vec3& p : cluster.points) {
      if (glm::dot(p, p) > radius * radius) continue;
      ++asked;
      const SiteHit hit = lookup.find(p);
      if (hit.site < 0) continue;
      ++met;
      // Chosen by their sites: of those chosen by their places noise would have moved more in than out.
      if (glm::length(p - hit.offset) > inner) continue;
      // The lookup's fractions lie in [0,1): the cell is counted from the site as it is stored there.
      matches.push_back({hit.site, lookup.cell(p, hit), p, glm::length(hit.offset)});
      distances.push_back(matches.back().distance);
    }
    fit.kept = asked == 0 ? 0.0 : static_cast<double>(met) / static_cast<double>(asked);
    cell.rms = rms_from_median(median(distances));
    limit = std::clamp(5.0 * cell.rms, 1e-6 * cell.nearest, tolerance);
    FittedCell next = cell;
    if (!solve(matches, limit, next)) break;
    const double change = glm::length(next.vectors[0] - cell.vectors[0]) +
                          glm::length(next.vectors[1] - cell.vectors[1]) +
                          glm::length(next.vectors[2] - cell.vectors[2]);
    cell = next;
    if (change < 1e-12 * cell.nearest) break;
  }
  for (Vec3& site : cell.sites) site -= shift;
  return fit;
}

FittedCell grow_fit(const Atoms& atoms, const Vec3& center, const LocalScale& scale, const FittedCell& start,
                    Progress& progress) {
  FittedCell cell = start;
  double kept = 0.0;
  const double cells_radius = std::cbrt(20.0 * cell.volume());
  std::size_t before = 0;
  for (double radius = std::max(4.0 * scale.spacing, cells_radius);; radius *= 1.5) {
    progress.check();
    const LocalCluster cluster = collect_cluster(atoms, center, radius);
    // Nothing new: the whole of an open sample is in.
    if (cluster.points.size() <= before) break;
    before = cluster.points.size();
    CellFit fit = fit_cell(cluster, radius, cell);
    if (kept == 0.0) {
      kept = fit.kept;
    } else if (fit.kept < kept - 0.1 || fit.cell.rms > 1.3 * cell.rms + 0.005 * cell.nearest) {
      break;
    }
    cell = fit.cell;
    if (before >= enough_atoms || before > 3 * atoms.size()) break;
  }
  cell.nearest = nearest_site_distance(cell.vectors, cell.sites);
  return cell;
}

bool make_primitive(FittedCell& cell) {
  bool any = false;
  for (;;) {
    const std::size_t count = cell.sites.size();
    // A site is a mean: its error is the noise over the root of the atoms in it.
    const double cells = static_cast<double>(std::max<std::size_t>(cell.fitted, 1)) / static_cast<double>(count);
    const double tolerance = std::min(0.2 * cell.nearest, 6.0 * cell.rms / std::sqrt(cells) + 2e-3 * cell.nearest);
    const SiteLookup lookup(cell.vectors, cell.sites, tolerance);
    const auto holds = [&](const Vec3& t) {
      for (std::size_t k = 0; k < count; ++k) {
        const SiteHit hit = lookup.find(cell.sites[k] + t);
        if (hit.site < 0 || cell.species[static_cast<std::size_t>(hit.site)] != cell.species[k]) return false;
      }
      return true;
    };
    std::size_t found = 0;
    for (std::size_t i = 1; i < count && found == 0; ++i) {
      if (cell.species[i] == cell.species[0] && holds(cell.sites[i] - cell.sites[0])) found = i;
    }
    if (found == 0) return any;
    any = true;
    // The translation's multiples close on the lattice after `order` steps; of the lattice with it, the vector that it
    // divides is replaced.
    Vec3 f = glm::inverse(cell.vectors) * (cell.sites[found] - cell.sites[0]);
    f -= glm::round(f);
    std::array<Vec3, 4> generators{cell.vectors[0], cell.vectors[1], cell.vectors[2], cell.vectors * f};
    std::array<Vec3, 3> best{};
    double smallest = std::numeric_limits<double>::infinity();
    const double flat = 0.4 * cell.volume() / static_cast<double>(count);
    for (int leave = 0; leave < 3; ++leave) {
      for (int i = -1; i <= 1; ++i) {
        std::array<Vec3, 3> triple{generators[0], generators[1], generators[2]};
        triple[static_cast<std::size_t>(leave)] = generators[3] + static_cast<double>(i) * generators[leave];
        const double volume = std::abs(glm::determinant(Mat3(triple[0], triple[1], triple[2])));
        if (volume > flat && volume < smallest * (1.0 - 1e-6)) {
          smallest = volume;
          best = triple;
        }
      }
    }
    if (!(smallest < 0.9 * cell.volume())) return any;
    const std::array<Vec3, 3> reduced = reduce_lattice(best);
    const Mat3 vectors(reduced[0], reduced[1], reduced[2]);
    const Mat3 to_fraction = glm::inverse(vectors);
    // Sites that the new lattice makes one are averaged.
    FittedCell smaller = cell;
    smaller.vectors = vectors;
    smaller.sites.clear();
    smaller.species.clear();
    std::vector<double> weights;
    for (std::size_t j = 0; j < count; ++j) {
      bool merged = false;
      for (std::size_t s = 0; s < smaller.sites.size() && !merged; ++s) {
        Vec3 d = to_fraction * (cell.sites[j] - smaller.sites[s]);
        d -= glm::round(d);
        const Vec3 offset = vectors * d;
        if (glm::length(offset) > 0.4 * cell.nearest) continue;
        weights[s] += 1.0;
        smaller.sites[s] += offset / weights[s];
        merged = true;
      }
      if (merged) continue;
      smaller.sites.push_back(cell.sites[j]);
      smaller.species.push_back(cell.species[j]);
      weights.push_back(1.0);
    }
    cell = smaller;
  }
}

// Newton's iteration towards the orthogonal factor: N. Higham, "Computing the polar decomposition", 1986.
Mat3 rotation_of(const Mat3& map) {
  Mat3 r = map;
  for (int round = 0; round < 60; ++round) {
    const Mat3 next = 0.5 * (r + glm::transpose(glm::inverse(r)));
    double change = 0.0;
    for (int k = 0; k < 3; ++k) change += glm::length(next[k] - r[k]);
    r = next;
    if (change < 1e-15) break;
  }
  return r;
}

}  // namespace atomesh
