#include "preprocess/lattice_sites.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/lattice_walk.h"

namespace atomesh {

namespace {

constexpr double default_tolerance = 0.3, largest_tolerance = 0.45;  // nearest-neighbour distances
constexpr std::size_t atoms_per_range = 1 << 15;

// Sites can be told without polytopes, so a cell that has too intricate ones still gives them.
LatticeTemplate pattern_of(const UnitCell& given) {
  check_unit_cell(given);
  try {
    return make_lattice_template(given);
  } catch (const Error&) {
  }
  LatticeTemplate pattern;
  pattern.cell.primitive = reduce_lattice(given.primitive);
  const Mat3 matrix = pattern.cell.matrix();
  const Mat3 to_fraction = glm::inverse(matrix);
  for (std::size_t b = 0; b < given.basis.size(); ++b) {
    const Vec3 fraction = to_fraction * given.basis[b].position;
    pattern.cell.basis.push_back(
        {given.basis[b].species, given.basis[b].position - matrix * glm::floor(fraction + 1e-9)});
    pattern.given_basis.push_back(static_cast<std::uint16_t>(b));
  }
  return pattern;
}

// Atoms by patch: those of patch p are order[first[p]] … order[first[p + 1] - 1], ascending.
struct ByPatch {
  std::vector<std::size_t> first;
  std::vector<Index> order;

  ByPatch(const std::vector<LatticeSite>& of, std::size_t patches) : first(patches + 1, 0) {
    for (const LatticeSite& site : of) {
      if (site.patch != no_patch) ++first[site.patch + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    order.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (of[i].patch != no_patch) order[next[of[i].patch]++] = static_cast<Index>(i);
    }
  }
  std::span<const Index> atoms(std::size_t patch) const {
    return std::span<const Index>(order).subspan(first[patch], first[patch + 1] - first[patch]);
  }
};

void span_cells(std::span<const Index> atoms, const std::vector<LatticeSite>& of, LatticePatch& patch) {
  struct Part {
    std::size_t atoms = 0;
    std::array<std::int32_t, 3> min{}, max{};
  };
  Part none;
  none.min.fill(std::numeric_limits<std::int32_t>::max());
  none.max.fill(std::numeric_limits<std::int32_t>::min());
  std::vector<Part> parts((atoms.size() + atoms_per_range - 1) / atoms_per_range, none);
  const auto widen = [](auto& all, const std::array<std::int32_t, 3>& min, const std::array<std::int32_t, 3>& max) {
    for (int k = 0; k < 3; ++k) {
      all.min[k] = std::min(all.min[k], min[k]);
      all.max[k] = std::max(all.max[k], max[k]);
    }
  };
  parallel_for(atoms.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
    Part part = none;
    for (const Index i : atoms.subspan(begin, end - begin)) {
      if (of[i].patch == no_patch) continue;
      ++part.atoms;
      widen(part, of[i].cell, of[i].cell);
    }
    parts[begin / atoms_per_range] = part;
  });
  patch.min = none.min;
  patch.max = none.max;
  patch.atoms = 0;
  for (const Part& part : parts) {
    patch.atoms += part.atoms;
    widen(patch, part.min, part.max);
  }
}

// Of two atoms on one site the nearer stays, the first of two equally near. Whether there were any.
bool part_sharers(std::span<const Index> atoms, const std::vector<float>& squared, const LatticePatch& patch,
                  std::size_t basis, std::vector<LatticeSite>& of, const Progress& progress) {
  SiteTable table(patch.min, patch.max, basis, atoms.size());
  bool any = false;
  std::size_t n = 0;
  for (const Index i : atoms) {
    if (n++ % atoms_per_range == 0) progress.check();
    const LatticeSite site = of[i];
    const Index other = table.atom(site.cell, site.basis);
    any = any || other != no_index;
    if (other != no_index && squared[other] <= squared[i]) {
      of[i] = {};
      continue;
    }
    if (other != no_index) of[other] = {};
    table.put(site.cell, site.basis, i);
  }
  return any;
}

// Sums over a patch's atoms of labels and offsets, about the middle of the patch.
struct Moments {
  double weight = 0.0;
  Vec3 s{0.0}, r{0.0};
  Mat3 ss{0.0}, rs{0.0};

  void add(const Moments& other) {
    weight += other.weight;
    s += other.s;
    r += other.r;
    ss += other.ss;
    rs += other.rs;
  }
};

// How far the patch's atoms are from its frame's sites.
struct Misfit {
  double weight = 0.0, squared = 0.0, largest = 0.0;

  void add(const Misfit& other) {
    weight += other.weight;
    squared += other.squared;
    largest = std::max(largest, other.largest);
  }
  double rms() const { return std::sqrt(squared / weight); }
};

// Fits the patch's frame: least squares, then again with little weight for what lies further off than most.
class PatchFit {
 public:
  PatchFit(std::span<const Index> atoms, const Atoms& all, const LatticeSites& sites, LatticePatch& patch)
      : atoms_(atoms),
        positions_(all.positions),
        of_(sites.of),
        fraction_(sites.fractional(patch.pattern)),
        patch_(patch) {
    for (int k = 0; k < 3; ++k)
      middle_[k] = std::floor(0.5 * (static_cast<double>(patch.min[k]) + static_cast<double>(patch.max[k])));
    patch.matrix = sites.patterns[patch.pattern].cell.matrix();
    const LatticeSite& first = of_[atoms[0]];
    patch.origin = positions_[atoms[0]] -
                   patch.matrix * (Vec3(first.cell[0], first.cell[1], first.cell[2]) + fraction_[first.basis]);
  }

  void run(const Progress& progress) {
    improve(moments(0.0));
    double scale = 0.0;  // of the weights that `now` was taken with
    Misfit now = misfit(scale);
    for (int round = 0; round < 2 && now.squared > 0.0; ++round) {
      // Rounding alone: nothing left to improve.
      if (now.rms() < 1e-12 * extent()) break;
      scale = now.rms();
      progress.check();
      improve(moments(scale));
      now = misfit(scale);
    }
    if (scale > 0.0) now = misfit(0.0);
    patch_.rms = now.rms();
    patch_.largest = std::sqrt(now.largest);
  }

 private:
  // Sums part(label, offset from the site, weight) over the atoms, range by range.
  template <class Sum, class Part>
  Sum sum(double scale, const Part& part) const {
    std::vector<Sum> parts((atoms_.size() + atoms_per_range - 1) / atoms_per_range);
    parallel_for(atoms_.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
      Sum own;
      const Vec3 origin = patch_.origin;
      const Mat3 matrix = patch_.matrix;
      const double inverse = scale > 0.0 ? 1.0 / (scale * scale) : 0.0;
      for (std::size_t n = begin; n < end; ++n) {
        const LatticeSite& site = of_[atoms_[n]];
        if (site.patch == no_patch) continue;
        const Vec3 label = Vec3(site.cell[0], site.cell[1], site.cell[2]) + fraction_[site.basis];
        const Vec3 r = positions_[atoms_[n]] - (origin + matrix * label);
        const double lighter = 1.0 + glm::dot(r, r) * inverse;
        part(own, label, r, 1.0 / (lighter * lighter));
      }
      parts[begin / atoms_per_range] = own;
    });
    Sum all;
    for (const Sum& own : parts) all.add(own);
    return all;
  }

  Misfit misfit(double scale) const {
    return sum<Misfit>(scale, [](Misfit& m, const Vec3&, const Vec3& r, double w) {
      const double squared = glm::dot(r, r);
      m.weight += w;
      m.squared += w * squared;
      m.largest = std::max(m.largest, squared);
    });
  }

  Moments moments(double scale) const {
    return sum<Moments>(scale, [middle = middle_](Moments& m, const Vec3& label, const Vec3& r, double w) {
      const Vec3 s = label - middle;
      m.weight += w;
      m.s += w * s;
      m.r += w * r;
      for (int k = 0; k < 3; ++k) {
        m.ss[k] += w * s[k] * s;
        m.rs[k] += w * s[k] * r;
      }
    });
  }

  // Å, about the size of the patch.
  double extent() const {
    Vec3 cells(0.0);
    for (int k = 0; k < 3; ++k)
      cells[k] = static_cast<double>(patch_.max[k]) - static_cast<double>(patch_.min[k]) + 1.0;
    return glm::length(patch_.matrix * cells);
  }

  void improve(const Moments& m) {
    const Vec3 s = m.s / m.weight;
    const Vec3 r = m.r / m.weight;
    Mat3 spread = m.ss - m.weight * glm::outerProduct(s, s);
    // A patch that is flat leaves a direction open; there the cell given stands.
    const double least = 1e-9 * (spread[0][0] + spread[1][1] + spread[2][2]) + 1e-9;
    for (int k = 0; k < 3; ++k) spread[k][k] += least;
    const Mat3 change = (m.rs - m.weight * glm::outerProduct(r, s)) * glm::inverse(spread);
    patch_.matrix += change;
    patch_.origin += r - change * (s + middle_);
  }

  std::span<const Index> atoms_;
  const std::vector<Vec3>& positions_;
  const std::vector<LatticeSite>& of_;
  std::vector<Vec3> fraction_;
  LatticePatch& patch_;
  Vec3 middle_{0.0};
};

}  // namespace

std::vector<Vec3> LatticeSites::fractional(std::size_t pattern) const {
  const UnitCell& cell = patterns[pattern].cell;
  const Mat3 to_fraction = glm::inverse(cell.matrix());
  std::vector<Vec3> result;
  for (const BasisAtom& atom : cell.basis) result.push_back(to_fraction * atom.position);
  return result;
}

LatticeSites assign_lattice_sites(const Atoms& atoms, const Crystal& crystal, const LatticeSiteOptions& options,
                                  Progress& progress) {
  LatticeSites sites;
  sites.of.resize(atoms.size());
  if (!crystal.known() || atoms.size() == 0) return sites;
  std::vector<WalkPattern> walk_patterns;
  for (const UnitCell& cell : crystal.grains) {
    sites.patterns.push_back(pattern_of(cell));
    const UnitCell& reduced = sites.patterns.back().cell;
    const double nearest = shortest_distance(reduced);
    const double tolerance = std::min(options.tolerance > 0.0 ? options.tolerance : default_tolerance * nearest,
                                      largest_tolerance * nearest);
    walk_patterns.push_back({SiteFinder(reduced, tolerance), reduced, tolerance});
  }

  std::vector<LatticeWalk::Patch> begun;
  std::vector<LatticePatch> spans;
  bool changed = false;  // since the atoms were gathered by patch
  std::optional<ByPatch> by_patch;
  {
    LatticeWalk walk(atoms, crystal, walk_patterns, options.smallest_patch, sites.of, progress);
    begun = walk.run(progress);
    by_patch.emplace(sites.of, begun.size());
    for (std::size_t p = 0; p < begun.size(); ++p) {
      progress.check();
      LatticePatch& patch = spans.emplace_back();
      span_cells(by_patch->atoms(p), sites.of, patch);
      const std::size_t basis = sites.patterns[begun[p].pattern].cell.basis.size();
      if (patch.atoms > 0 && part_sharers(by_patch->atoms(p), walk.squared(), patch, basis, sites.of, progress)) {
        changed = true;
        span_cells(by_patch->atoms(p), sites.of, patch);
      }
    }
  }

  // Most atoms first; those of small patches are let go.
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < begun.size(); ++p) {
    if (spans[p].atoms >= std::max<std::size_t>(options.smallest_patch, 1)) order.push_back(p);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return spans[a].atoms > spans[b].atoms; });
  std::vector<std::uint16_t> renamed(begun.size(), no_patch);
  for (std::size_t n = 0; n < order.size(); ++n) renamed[order[n]] = static_cast<std::uint16_t>(n);
  bool same_names = true;
  for (std::size_t p = 0; p < begun.size(); ++p) same_names = same_names && renamed[p] == p;
  if (!same_names) {
    changed = true;
    for (LatticeSite& site : sites.of) {
      if (site.patch == no_patch) continue;
      site.patch = renamed[site.patch];
      if (site.patch == no_patch) site = {};
    }
  }
  if (changed) by_patch.emplace(sites.of, order.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    progress.check();
    LatticePatch& patch = sites.patches.emplace_back(spans[order[n]]);
    patch.pattern = begun[order[n]].pattern;
    patch.seams = begun[order[n]].seams;
    PatchFit(by_patch->atoms(n), atoms, sites, patch).run(progress);
  }
  progress.update(1.0);
  return sites;
}

}  // namespace atomesh
