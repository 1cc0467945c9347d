#include "preprocess/find_grains.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "preprocess/match_orientation.h"

namespace atomesh {

namespace {

// Places without a grain that are tried before the rest is left.
constexpr std::size_t most_failures = 24;
constexpr std::size_t most_grains = 4096;
// Radians: a cell turned less than this from a grain is that grain, bent.
constexpr double same_orientation = 0.02;
constexpr double most_strain = 0.08;
// Atoms left in a block from which a grain is looked for.
constexpr std::size_t least_left = 10;

class GrainFinder {
 public:
  GrainFinder(const Atoms& atoms, const StrainBlocks& blocks, const LocalScale& scale, const FittedCell& first,
              const Claims& claims, std::size_t least)
      : atoms_(atoms), blocks_(blocks), scale_(scale), first_(first), least_(least), shells_(first) {
    grain_of_.assign(atoms.size(), no_grain);
    filled_.assign(blocks.size(), 0);
    symmetries_ = symmetry_rotations(first, 0.1 * first.nearest);
    accept(first, claims);
  }

  void find_all(Progress& progress) {
    std::vector<std::uint8_t> tried(blocks_.size(), 0);
    std::size_t failures = 0;
    while (failures < most_failures && cells_.size() < most_grains) {
      progress.check();
      const std::size_t block = most_left(tried);
      if (block == blocks_.size()) return;
      tried[block] = 1;
      const std::optional<FittedCell> cell = turned_cell(block, progress);
      if (!cell || !try_grain(*cell, progress)) ++failures;
    }
  }

  GrainSearch result(Progress& progress) {
    GrainSearch search;
    if (cells_.size() > 1) settle(progress);
    std::vector<std::size_t> size(cells_.size(), 0);
    for (const std::uint16_t g : grain_of_) {
      if (g != no_grain) ++size[g];
    }
    if (cells_.size() == 1) size[0] = atoms_.size();
    std::vector<std::size_t> order(cells_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
    if (cells_.size() > 1) std::erase_if(order, [&](std::size_t g) { return size[g] < least_; });
    std::vector<std::uint16_t> name(cells_.size(), no_grain);
    for (std::size_t n = 0; n < order.size(); ++n) {
      progress.check();
      const std::size_t g = order[n];
      name[g] = static_cast<std::uint16_t>(n);
      search.cells.push_back(cells_[g]);
      // Atoms that two grains claimed are in both sums; each counts once.
      const auto own = static_cast<std::size_t>(std::count_if(
          claims_[g].begin(), claims_[g].end(), [&](Index i) { return cells_.size() == 1 || grain_of_[i] == g; }));
      const Explained& sum = sums_[g];
      const double share = sum.atoms == 0 ? 0.0 : static_cast<double>(own) / static_cast<double>(sum.atoms);
      search.on_site += own;
      search.foreign += static_cast<std::size_t>(std::lround(share * static_cast<double>(sum.foreign)));
      search.squares += share * sum.squares;
    }
    if (search.cells.size() > 1) {
      search.grain_of = std::move(grain_of_);
      for (std::uint16_t& g : search.grain_of) {
        if (g != no_grain) g = name[g];
      }
    }
    return search;
  }

 private:
  void accept(const FittedCell& cell, const Claims& claims) {
    const auto grain = static_cast<std::uint16_t>(cells_.size());
    cells_.push_back(cell);
    sums_.push_back(claims.sum);
    std::vector<Index>& claimed = claims_.emplace_back();
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      if (claims.on_site[i] == 0) continue;
      claimed.push_back(static_cast<Index>(i));
      if (grain_of_[i] == no_grain) grain_of_[i] = grain;
    }
    claimed.shrink_to_fit();
    for (std::size_t b = 0; b < blocks_.size(); ++b) filled_[b] |= claims.filled[b];
  }

  // The untried block with the most atoms left in it and around it.
  std::size_t most_left(const std::vector<std::uint8_t>& tried) const {
    std::vector<std::size_t> left(blocks_.size(), 0);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (const Index i : blocks_.atoms(b)) left[b] += grain_of_[i] == no_grain ? 1 : 0;
    }
    std::size_t best = blocks_.size();
    std::size_t most = least_ / 2;
    std::vector<std::size_t> around;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (tried[b] != 0 || left[b] < least_left || 2 * left[b] < blocks_.atoms(b).size()) continue;
      blocks_.neighbours(b, around);
      std::size_t sum = left[b];
      for (const std::size_t n : around) sum += left[n];
      if (sum <= most) continue;
      most = sum;
      best = b;
    }
    return best;
  }

  // The crystal as it lies around the atoms left in a block.
  std::optional<FittedCell> turned_cell(std::size_t block, Progress& progress) const {
    std::vector<Index> left;
    Vec3 middle(0.0);
    for (const Index i : blocks_.atoms(block)) {
      if (grain_of_[i] != no_grain) continue;
      left.push_back(i);
      middle += atoms_.positions[i];
    }
    middle /= static_cast<double>(left.size());
    std::stable_sort(left.begin(), left.end(), [&](Index a, Index b) {
      return glm::length(atoms_.positions[a] - middle) < glm::length(atoms_.positions[b] - middle);
    });
    left.resize(std::min<std::size_t>(left.size(), 6));
    const double near = 3.0 * scale_.spacing;
    const LocalCluster cluster = collect_cluster(atoms_, atoms_.positions[left.front()], near + 2.0 * shells_.radius());
    const NeighbourGrid grid = grid_of(cluster, scale_);
    for (const Index i : left) {
      const Vec3 place = atoms_.positions[i] - cluster.center;
      const auto self = std::find(cluster.points.begin(), cluster.points.end(), place);
      if (self == cluster.points.end()) continue;
      const auto match = shells_.match(cluster, grid, static_cast<Index>(self - cluster.points.begin()));
      if (!match) continue;
      FittedCell cell = first_;
      cell.vectors = match->rotation * first_.vectors;
      cell.origin = atoms_.positions[i];
      for (Vec3& site : cell.sites) site = match->rotation * (site - first_.sites[match->site]);
      const CellFit fit = fit_cell(cluster, near, cell);
      if (fit.kept < 0.6) continue;
      FittedCell grown = grow_fit(atoms_, cluster.center, scale_, fit.cell, progress);
      if (sensible(grown)) return grown;
    }
    return std::nullopt;
  }

  // Turned, hardly strained, and no grain already.
  bool sensible(const FittedCell& cell) const {
    const Mat3 map = cell.vectors * glm::inverse(first_.vectors);
    const Mat3 rotation = rotation_of(map);
    const Mat3 strain = glm::transpose(rotation) * map - Mat3(1.0);
    for (int k = 0; k < 3; ++k) {
      if (!(glm::length(strain[k]) < most_strain)) return false;
    }
    return std::none_of(cells_.begin(), cells_.end(), [&](const FittedCell& other) {
      const Mat3 r = rotation_of(other.vectors * glm::inverse(first_.vectors));
      return angle_of(smallest_rotation(glm::transpose(r) * rotation, symmetries_)) < same_orientation;
    });
  }

  bool try_grain(const FittedCell& cell, Progress& progress) {
    const Claims claims = explain_atoms(atoms_, blocks_, cell, filled_, grain_of_, progress);
    std::size_t fresh = 0;
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      fresh += claims.on_site[i] != 0 && grain_of_[i] == no_grain ? 1 : 0;
    }
    if (fresh < least_) return false;
    accept(cell, claims);
    return true;
  }

  // Each atom to the grain that claims most of its neighbours, of those that claim the atom itself; then the strays go
  // with their surroundings.
  void settle(Progress& progress) {
    const double radius = scale_.glance;
    const NeighbourGrid grid(atoms_.positions, atoms_.box, radius, radius);
    const std::span<const Index> home = grid.home_slots();
    // Few atoms are claimed twice, so the claims are asked grain by grain only there.
    for (int round = 0; round < 3; ++round) {
      std::vector<std::uint16_t> next = grain_of_;
      parallel_for(home.size(), 4096, [&](std::size_t begin, std::size_t end) {
        progress.check();
        std::vector<Index> slots;
        std::vector<std::uint16_t> near;
        for (std::size_t n = begin; n < end; ++n) {
          const Index atom = grid.point(home[n]);
          grid.find(grid.position(home[n]), radius, slots, home[n]);
          near.clear();
          bool mixed = false;
          for (const Index s : slots) {
            near.push_back(grain_of_[grid.point(s)]);
            mixed = mixed || near.back() != grain_of_[atom];
          }
          if (mixed) next[atom] = round == 0 ? claimed(atom, grid, slots) : among(grain_of_[atom], near);
        }
      });
      grain_of_ = std::move(next);
    }
  }

  bool claims(std::size_t grain, Index atom) const {
    return std::binary_search(claims_[grain].begin(), claims_[grain].end(), atom);
  }

  // Of the grains that claim the atom, the one that claims most of its neighbours.
  std::uint16_t claimed(Index atom, const NeighbourGrid& grid, const std::vector<Index>& slots) const {
    std::uint16_t best = no_grain;
    std::size_t most = 0;
    for (std::size_t g = 0; g < claims_.size(); ++g) {
      if (!claims(g, atom)) continue;
      std::size_t count = 1;
      for (const Index s : slots) count += claims(g, grid.point(s)) ? 1 : 0;
      if (count <= most) continue;
      most = count;
      best = static_cast<std::uint16_t>(g);
    }
    return best;
  }

  // What an atom of grain `own` belongs to among neighbours of these grains.
  static std::uint16_t among(std::uint16_t own, std::vector<std::uint16_t>& near) {
    std::sort(near.begin(), near.end());
    std::size_t most = 0;
    std::size_t mine = 0;
    std::uint16_t common = no_grain;
    for (std::size_t n = 0; n < near.size();) {
      std::size_t end = n;
      while (end < near.size() && near[end] == near[n]) ++end;
      if (near[n] == own) mine = end - n;
      if (near[n] != no_grain && end - n > most) {
        most = end - n;
        common = near[n];
      }
      n = end;
    }
    if (common == own || most == 0) return 4 * mine < near.size() ? no_grain : own;
    // Nearly all around belong to one grain: so does this one, on a site or not.
    if (4 * most >= 3 * near.size()) return common;
    return 4 * mine < near.size() ? no_grain : own;
  }

  const Atoms& atoms_;
  const StrainBlocks& blocks_;
  const LocalScale& scale_;
  const FittedCell& first_;
  std::size_t least_;
  NeighbourShells shells_;
  std::vector<Mat3> symmetries_;
  std::vector<FittedCell> cells_;
  std::vector<Explained> sums_;
  // Of each grain: the atoms that sit on its sites, ascending. Grains share few atoms, so that all of them together
  // take little more than 4 bytes an atom, however many grains there are.
  std::vector<std::vector<Index>> claims_;
  std::vector<std::uint16_t> grain_of_;
  std::vector<std::uint8_t> filled_;  // of each block, by any grain
};

}  // namespace

GrainSearch find_grains(const Atoms& atoms, const StrainBlocks& blocks, const LocalScale& scale,
                        const FittedCell& first, const Claims& claims, std::size_t least, Progress& progress) {
  GrainFinder finder(atoms, blocks, scale, first, claims, least);
  finder.find_all(progress);
  return finder.result(progress);
}

}  // namespace atomesh
