#include "preprocess/propose_cell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/unit_cell.h"
#include "preprocess/lattice_translations.h"

namespace atomesh {

namespace {

// Of the points near a proposal's centre.
constexpr double least_near = 0.6;

struct FoldedSite {
  Vec3 first, sum;  // Å, in the cell of the first
  std::map<std::uint16_t, std::size_t> species;
  std::size_t count = 0;
  Vec3 mean() const { return first + sum / static_cast<double>(count); }
};

Vec3 nearest_difference(const Mat3& vectors, const Mat3& to_fraction, const Vec3& d) {
  Vec3 f = to_fraction * d;
  f -= glm::round(f);
  return vectors * f;
}

std::uint16_t majority(const std::map<std::uint16_t, std::size_t>& counts) {
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// Share of the sites that hold an atom, in the cells that have cells with atoms all around; 1 where there are too few
// to tell.
double occupancy(const LocalCluster& cluster, double radius, const FittedCell& cell) {
  const SiteLookup lookup(cell.vectors, cell.sites, 0.25 * cell.nearest);
  using Cell = std::array<int, 3>;
  std::map<Cell, std::size_t> atoms;
  for (const Vec3& point : cluster.points) {
    if (glm::dot(point, point) > radius * radius) continue;
    const Vec3 p = point + cluster.center - cell.origin;
    const SiteHit hit = lookup.find(p);
    if (hit.site < 0) continue;
    const Vec3 c = lookup.cell(p, hit);
    ++atoms[{static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z)}];
  }
  std::size_t inner = 0;
  std::size_t taken = 0;
  for (const auto& [c, count] : atoms) {
    bool surrounded = true;
    for (int n = 0; n < 27 && surrounded; ++n) {
      surrounded = atoms.contains({c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1});
    }
    if (!surrounded) continue;
    ++inner;
    taken += count;
  }
  return inner < 8 ? 1.0 : static_cast<double>(taken) / static_cast<double>(inner * cell.sites.size());
}

}  // namespace

std::optional<FittedCell> collect_basis(const LocalCluster& cluster, double radius, const Mat3& lattice,
                                        const LocalScale& scale, std::size_t largest) {
  const Mat3 to_fraction = glm::inverse(lattice);
  const double same = 0.3 * scale.nearest;
  std::vector<Index> order;
  for (Index i = 0; i < cluster.points.size(); ++i) {
    if (glm::dot(cluster.points[i], cluster.points[i]) <= radius * radius) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return glm::dot(cluster.points[a], cluster.points[a]) < glm::dot(cluster.points[b], cluster.points[b]);
  });
  std::vector<FoldedSite> sites;
  for (const Index i : order) {
    const Vec3& p = cluster.points[i];
    FoldedSite* nearest = nullptr;
    double best = same * same;
    Vec3 offset(0.0);
    for (FoldedSite& site : sites) {
      const Vec3 d = nearest_difference(lattice, to_fraction, p - site.mean());
      if (glm::dot(d, d) > best) continue;
      best = glm::dot(d, d);
      nearest = &site;
      offset = d;
    }
    if (nearest == nullptr) {
      // Defects make places of their own, but where places never end nothing repeats.
      if (sites.size() > 8 * largest) return std::nullopt;
      sites.push_back({p, Vec3(0.0), {}, 0});
      nearest = &sites.back();
    }
    const Vec3 place = nearest->count == 0 ? p : nearest->mean() + offset;
    nearest->sum += place - nearest->first;
    ++nearest->count;
    ++nearest->species[cluster.species[i]];
  }
  std::size_t most = 0;
  for (const FoldedSite& site : sites) most = std::max(most, site.count);
  std::erase_if(sites, [most](const FoldedSite& site) { return 2 * site.count < most; });
  if (sites.empty() || sites.size() > largest) return std::nullopt;

  FittedCell cell;
  cell.vectors = lattice;
  cell.origin = cluster.center;
  for (const FoldedSite& site : sites) {
    cell.sites.push_back(site.mean());
    cell.species.push_back(majority(site.species));
  }
  cell.nearest = nearest_site_distance(cell.vectors, cell.sites);
  // Two sites in one place are none.
  if (cell.nearest < 0.5 * scale.nearest) return std::nullopt;
  return cell;
}

CellProposal propose_cell(const Atoms& atoms, const Vec3& center, const LocalScale& scale,
                          const ProposeOptions& options, Progress& progress) {
  CellProposal proposal;
  progress.check();
  const LocalCluster cluster = collect_cluster(atoms, center, (options.reach + 4.5) * scale.spacing);
  const NeighbourGrid grid = grid_of(cluster, scale);
  TranslationOptions search;
  search.reach = options.reach * scale.spacing;
  search.box = atoms.box;
  search.seeds = options.seeds;
  search.tell_species = options.tell_species;
  const TranslationSearch translations = find_translations(cluster, grid, scale, search);
  proposal.best_translation = translations.best;
  const std::optional<Mat3> lattice = lattice_of(translations.found, scale);
  if (!lattice) return proposal;
  progress.check();
  const double volume = std::abs(glm::determinant(*lattice));
  const double radius = std::max(5.0 * scale.spacing, std::cbrt(8.0 * volume));
  const LocalCluster region = collect_cluster(atoms, center, radius);
  std::optional<FittedCell> cell = collect_basis(region, radius, *lattice, scale, options.largest_basis);
  if (!cell) return proposal;
  const CellFit near = fit_cell(region, radius, *cell);
  if (near.kept < least_near) return proposal;
  proposal.occupancy = occupancy(region, radius, near.cell);
  FittedCell grown = grow_fit(atoms, center, scale, near.cell, progress);
  if (make_primitive(grown)) grown = grow_fit(atoms, center, scale, grown, progress);
  proposal.cell = grown;
  return proposal;
}

}  // namespace atomesh
