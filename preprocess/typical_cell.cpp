#include "preprocess/typical_cell.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t most_blocks = 4096;
constexpr std::size_t fewest_blocks = 24;
constexpr std::size_t fewest_atoms = 24;  // of a block
constexpr double significant = 6.0;       // standard errors
constexpr double negligible = 1e-6;       // strain

struct Deformed {
  Mat3 map{1.0};            // of the cell into the block
  std::vector<Vec3> sites;  // Å, how far each site's atoms are off their place beside the first site's, map undone
  std::vector<std::uint8_t> has_site;
  double residual = 0.0;  // Å, rms from the mapped sites
  Vec3 error{0.0};        // of the map's columns, what the residuals explain
  bool known = false;
};

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Typical {
  double median = 0.0;
  double width = 0.0;  // standard deviation of a normal distribution with this median deviation
  double error = 0.0;  // of the median
};

Typical typical_of(std::vector<double>& values) {
  Typical typical;
  typical.median = median_of(values);
  for (double& value : values) value = std::abs(value - typical.median);
  typical.width = 1.4826 * median_of(values);
  typical.error = 1.2533 * typical.width / std::sqrt(static_cast<double>(values.size()));
  return typical;
}

// Least squares of ideal = map⁻¹·place + shift over the block's atoms on sites; where the atoms allow, with a shift for
// each site, so that a cell whose sites are wrong gives the right map all the same.
Deformed deformed(const Atoms& atoms, std::span<const Index> block, const FittedCell& cell, const SiteLookup& lookup,
                  const Vec3& origin) {
  struct Pair {
    Vec3 place, ideal;
    std::size_t site;
  };
  struct Mean {
    Vec3 place{0.0}, ideal{0.0};
    double count = 0.0;
  };
  Deformed result;
  std::vector<Pair> pairs;
  std::vector<Mean> means(cell.sites.size());
  Mean all;
  for (const Index i : block) {
    const Vec3 place = atoms.positions[i] - cell.origin - origin;
    const SiteHit hit = lookup.find(place);
    if (hit.site < 0) continue;
    pairs.push_back({place, place - hit.offset, static_cast<std::size_t>(hit.site)});
    for (Mean* mean : {&all, &means[pairs.back().site]}) {
      mean->place += place;
      mean->ideal += place - hit.offset;
      mean->count += 1.0;
    }
  }
  if (pairs.size() < fewest_atoms) return result;
  const double count = all.count;
  const bool apart = pairs.size() >= 6 * cell.sites.size();
  // A block holds the atoms that are in it now: those that noise moved out are missing, those it moved in are there. So
  // the ideal places are regressed on the real ones; the other way round the cell would come out too small.
  Mat3 cross(0.0);
  Mat3 spread(0.0);
  for (const Pair& p : pairs) {
    const Mean& mean = apart ? means[p.site] : all;
    cross += glm::outerProduct(p.ideal - mean.ideal / mean.count, p.place - mean.place / mean.count);
    spread += glm::outerProduct(p.place - mean.place / mean.count, p.place - mean.place / mean.count);
  }
  // A flat block (a border's) tells nothing across.
  if (!(glm::determinant(spread) > std::pow(0.5 * cell.nearest * cell.nearest * count, 3))) return result;
  const Mat3 undo = cross * glm::inverse(spread);
  if (!(glm::determinant(undo) > 0.5)) return result;
  result.map = glm::inverse(undo);
  result.known = true;
  double squares = 0.0;
  for (const Pair& p : pairs) {
    const Mean& mean = apart ? means[p.site] : all;
    const Vec3 d = p.ideal - mean.ideal / mean.count - undo * (p.place - mean.place / mean.count);
    squares += glm::dot(d, d);
  }
  result.residual = std::sqrt(squares / (count - (apart ? static_cast<double>(means.size()) : 1.0) - 3.0));
  const Mat3 variance = glm::inverse(spread);
  for (int k = 0; k < 3; ++k) result.error[k] = result.residual * std::sqrt(variance[k][k] / 3.0);
  // A site's shift from the first site's: of an atom's own the block's origin is part.
  for (std::size_t j = 0; j < means.size(); ++j) {
    const bool known = means[j].count > 0.0 && means[0].count > 0.0;
    result.has_site.push_back(known ? 1 : 0);
    result.sites.push_back(known ? undo * (means[j].place / means[j].count - means[0].place / means[0].count) -
                                       (means[j].ideal / means[j].count - means[0].ideal / means[0].count)
                                 : Vec3(0.0));
  }
  return result;
}

}  // namespace

std::optional<FittedCell> typical_cell(const Atoms& atoms, const StrainBlocks& blocks, const FittedCell& cell,
                                       const Claims& claims, Progress& progress) {
  std::vector<std::size_t> asked;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (claims.has_origin[b] != 0) asked.push_back(b);
  }
  const std::size_t step = (asked.size() + most_blocks - 1) / most_blocks;
  std::vector<Deformed> maps(step == 0 ? 0 : (asked.size() + step - 1) / step);
  const SiteLookup lookup(cell.vectors, cell.sites, 0.25 * cell.nearest);
  parallel_for(maps.size(), 64, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t b = asked[n * step];
      maps[n] = deformed(atoms, blocks.atoms(b), cell, lookup, claims.origin[b]);
    }
  });
  std::erase_if(maps, [](const Deformed& d) { return !d.known; });
  if (maps.size() < fewest_blocks) return std::nullopt;
  // A block that a slid plane or a defect crosses is no deformed crystal: the half that fits best speaks.
  std::stable_sort(maps.begin(), maps.end(),
                   [](const Deformed& a, const Deformed& b) { return a.residual < b.residual; });
  maps.resize(std::max(fewest_blocks, maps.size() / 2));

  bool differs = false;   // from the fit, beyond doubt
  bool strained = false;  // here more than there, beyond what noise does
  std::vector<double> values;
  FittedCell typical = cell;
  for (std::size_t j = 1; j < cell.sites.size(); ++j) {
    for (int k = 0; k < 3; ++k) {
      values.clear();
      for (const Deformed& d : maps) {
        if (d.has_site[j] != 0) values.push_back(d.sites[j][k]);
      }
      if (values.size() < fewest_blocks) continue;
      const Typical shift = typical_of(values);
      differs = differs || std::abs(shift.median) > significant * shift.error + negligible * cell.nearest;
      typical.sites[j][k] += shift.median;
    }
  }
  Mat3 median(1.0);
  for (int column = 0; column < 3; ++column) {
    values.clear();
    for (const Deformed& d : maps) values.push_back(d.error[column]);
    const double noise = median_of(values);
    for (int row = 0; row < 3; ++row) {
      values.clear();
      for (const Deformed& d : maps) values.push_back(d.map[column][row]);
      const Typical entry = typical_of(values);
      differs =
          differs || std::abs(entry.median - (row == column ? 1.0 : 0.0)) > significant * entry.error + negligible;
      strained = strained || entry.width > 2.0 * noise + negligible;
      median[column][row] = entry.median;
    }
  }
  // A fit to most of the sample is an average over its strain already.
  const bool partial = 2 * cell.fitted < atoms.size();
  if (!differs && !(strained && partial)) return std::nullopt;
  typical.vectors = median * typical.vectors;
  for (Vec3& site : typical.sites) site = median * site;
  typical.nearest = nearest_site_distance(typical.vectors, typical.sites);
  return typical;
}

}  // namespace atomesh
