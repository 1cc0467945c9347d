#include "preprocess/lattice_walk.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace atomesh {

namespace {

// Enough atoms that noise averages out of a block's frame, few enough that strain bends little inside it.
constexpr double atoms_per_block = 80.0;
// What a predicted frame weighs against the block's own atoms, as a number of atoms.
constexpr double trust_in_prediction = 3.0;
// Places without any order hit a site within the tolerance for every sixth or seventh atom.
constexpr double least_share = 0.5, least_seed_share = 0.6, least_share_beyond_gap = 0.75;
// ... and are then 0.6 tolerance² from it in the mean.
constexpr double least_order = 0.45, least_seed_order = 0.35, least_order_beyond_gap = 0.2;
constexpr int widest_gap = 4;  // blocks
// Share of a seed's atoms that must be of the site's species, for interstitials may repeat the crystal too.
constexpr double least_of_species = 0.3;
constexpr std::size_t seeds_at_once = 24, most_failures = 480;
constexpr std::size_t seed_atoms = 6;
constexpr std::size_t blocks_per_range = 4;

double block_edge(std::span<const WalkPattern> patterns) {
  double edge = 0.0;
  for (const WalkPattern& pattern : patterns) {
    const double room = pattern.cell.volume() / static_cast<double>(pattern.cell.basis.size());
    edge = std::max(edge, std::cbrt(atoms_per_block * room));
  }
  return edge;
}

// Least squares of offsets against places, drawn towards no change: the frame that maps the old prediction onto the
// atoms by a translation and a small linear map.
class FrameFit {
 public:
  FrameFit(const Vec3& center, double edge) : center_(center), edge_(edge) {}

  // An atom `offset` away from where the frame has its site.
  void add(const Vec3& atom, const Vec3& offset, double weight) {
    const Vec3 u = atom - offset - center_;
    weight_ += weight;
    u_ += weight * u;
    r_ += weight * offset;
    for (int k = 0; k < 3; ++k) {
      uu_[k] += weight * u[k] * u;
      ru_[k] += weight * u[k] * offset;
    }
  }

  LatticeFrame fitted(const LatticeFrame& old) const {
    if (weight_ <= 0.0) return old;
    const Vec3 mean_u = u_ / weight_;
    const Vec3 mean_r = r_ / weight_;
    Mat3 spread = uu_ - weight_ * glm::outerProduct(mean_u, mean_u);
    const Mat3 against = ru_ - weight_ * glm::outerProduct(mean_r, mean_u);
    for (int k = 0; k < 3; ++k) spread[k][k] += trust_in_prediction * edge_ * edge_ / 12.0;
    const Mat3 gradient = against * glm::inverse(spread);
    const Vec3 shift = weight_ / (weight_ + 0.2 * trust_in_prediction) * mean_r;
    LatticeFrame frame;
    frame.matrix = old.matrix + gradient * old.matrix;
    frame.origin = old.origin + shift + gradient * (old.origin - center_ - mean_u);
    return frame;
  }

 private:
  Vec3 center_;
  double edge_;
  double weight_ = 0.0;
  Vec3 u_{0.0}, r_{0.0};
  Mat3 uu_{0.0}, ru_{0.0};
};

}  // namespace

LatticeWalk::LatticeWalk(const Atoms& atoms, const Crystal& crystal, std::span<const WalkPattern> patterns,
                         std::size_t smallest_patch, std::vector<LatticeSite>& of, const Progress& progress)
    : atoms_(atoms),
      crystal_(crystal),
      patterns_(patterns),
      smallest_patch_(smallest_patch),
      of_(of),
      blocks_(atoms.positions, block_edge(patterns), progress) {
  of_.assign(atoms.size(), {});
  squared_.assign(atoms.size(), 0.0F);
  first_frame_.assign(blocks_.size(), no_index);
  free_.resize(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) free_[b] = static_cast<Index>(blocks_.atoms(b).size());
  const std::size_t species = atoms.species_table.size();
  for (const WalkPattern& pattern : patterns) {
    std::vector<std::uint8_t>& ok = species_ok_.emplace_back(pattern.cell.basis.size() * species);
    for (std::size_t n = 0; n < ok.size(); ++n) {
      ok[n] = pattern.cell.basis[n / species].species == atoms.species_table[n % species].name ? 1 : 0;
    }
    // A file that calls its atoms by other names has no say in which sites are whose.
    for (const std::uint16_t s : atoms.species) {
      for (std::size_t b = 0; b < pattern.cell.basis.size() && !species_known_; ++b) {
        species_known_ = ok[b * species + s] != 0;
      }
      if (species_known_) break;
    }
  }
}

const LatticeWalk::BlockFrame* LatticeWalk::frame_in(std::size_t block, std::uint16_t patch) const {
  for (Index n = first_frame_[block]; n != no_index; n = frames_[n].next) {
    if (frames_[n].patch == patch) return &frames_[n];
  }
  return nullptr;
}

// From the blocks so many blocks away: the mean of the frames that agree with the weightiest, for at a dislocation the
// walk meets itself with other numbers. False where there are none.
bool LatticeWalk::predict(std::size_t block, std::uint16_t patch, int shell, LatticeFrame& frame) const {
  struct Known {
    const BlockFrame* frame;
    double weight;
  };
  std::vector<Known> around;
  const Known* best = nullptr;
  for_shell(shell, [&](int dx, int dy, int dz) {
    const Index other = blocks_.neighbour(block, dx, dy, dz);
    const BlockFrame* known = other == no_index ? nullptr : frame_in(other, patch);
    if (known != nullptr) around.push_back({known, known->atoms / static_cast<double>(dx * dx + dy * dy + dz * dz)});
  });
  for (const Known& known : around) best = best == nullptr || known.weight > best->weight ? &known : best;
  if (best == nullptr) return false;
  const LatticeFrame& reference = best->frame->frame;
  const Vec3 center = blocks_.center(block);
  const Vec3 site = glm::inverse(reference.matrix) * (center - reference.origin);
  const double tolerance = patterns_[patches_[patch].pattern].tolerance;
  frame = {Mat3(0.0), Vec3(0.0)};
  double weight = 0.0;
  for (const Known& known : around) {
    const LatticeFrame& f = known.frame->frame;
    if (glm::length(f.origin + f.matrix * site - center) > tolerance) continue;
    weight += known.weight;
    frame.matrix += known.weight * f.matrix;
    frame.origin += known.weight * f.origin;
  }
  frame.matrix /= weight;
  frame.origin /= weight;
  return true;
}

// Which free atoms of the block are on sites of the frame, and the frame that fits them best.
LatticeWalk::Outcome LatticeWalk::match(std::size_t block, const WalkPattern& pattern, const LatticeFrame& frame,
                                        std::vector<Placed>* placed) const {
  if (placed != nullptr) placed->clear();
  const Mat3 to_fraction = glm::inverse(frame.matrix);
  const double limit = pattern.tolerance * pattern.tolerance;
  const auto& ok = species_ok_[static_cast<std::size_t>(&pattern - patterns_.data())];
  const std::size_t species = atoms_.species_table.size();
  FrameFit fit(blocks_.center(block), blocks_.edge());
  Outcome outcome;
  double squared = 0.0;
  for (const Index atom : blocks_.atoms(block)) {
    if (of_[atom].patch != no_patch) continue;
    ++outcome.free;
    const SiteFinder::Found found = pattern.finder.find(frame, to_fraction, atoms_.positions[atom]);
    if (!(found.squared <= limit)) continue;
    if (placed != nullptr) placed->push_back({atom, found});
    ++outcome.matched;
    outcome.of_species += ok[found.basis * species + atoms_.species[atom]];
    squared += found.squared;
    const double nearness = 1.0 - 0.8 * found.squared / limit;  // Tukey: what is far off counts little
    fit.add(atoms_.positions[atom], found.offset, nearness * nearness);
  }
  outcome.mean_squared = outcome.matched == 0 ? 0.0 : squared / outcome.matched;
  outcome.frame = fit.fitted(frame);
  return outcome;
}

LatticeWalk::Outcome LatticeWalk::settle(std::size_t block, const WalkPattern& pattern, const LatticeFrame& predicted,
                                         std::vector<Placed>& placed) const {
  const Outcome first = match(block, pattern, predicted, &placed);
  // With all of them placed there is nothing to gain.
  if (first.matched == first.free || first.matched < least_share * first.free) return first;
  return match(block, pattern, first.frame, &placed);
}

void LatticeWalk::take(std::size_t block, std::uint16_t patch, const std::vector<Placed>& placed) {
  for (const Placed& p : placed) {
    of_[p.atom] = {p.found.cell, p.found.basis, patch};
    squared_[p.atom] = static_cast<float>(p.found.squared);
  }
  free_[block] -= static_cast<Index>(placed.size());
}

void LatticeWalk::accept(std::size_t block, std::uint16_t patch, const Outcome& outcome) {
  frames_.push_back({static_cast<Index>(block), first_frame_[block], patch, outcome.matched, outcome.frame});
  first_frame_[block] = static_cast<Index>(frames_.size() - 1);
}

// One wave: tries the blocks of the frontier and returns those around the ones that fitted.
std::vector<Index> LatticeWalk::advance(std::uint16_t patch, const std::vector<Index>& frontier, int shell,
                                        Progress& progress) {
  const WalkPattern& pattern = patterns_[patches_[patch].pattern];
  const double limit = pattern.tolerance * pattern.tolerance;
  std::vector<Outcome> outcomes(frontier.size());
  std::vector<std::uint8_t> fits(frontier.size(), 0);
  parallel_for(frontier.size(), blocks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Placed> placed;
    for (std::size_t n = begin; n < end; ++n) {
      LatticeFrame predicted;
      bool known = false;
      for (int s = 1; s <= shell && !known; ++s) known = predict(frontier[n], patch, s, predicted);
      if (!known) continue;
      Outcome& outcome = outcomes[n];
      outcome = settle(frontier[n], pattern, predicted, placed);
      const double share = shell == 1 ? least_share : least_share_beyond_gap;
      const double order = shell == 1 ? least_order : least_order_beyond_gap;
      if (outcome.matched < std::min<double>(outcome.free, share * outcome.free + 1.0)) continue;
      if (outcome.mean_squared > order * limit) continue;
      take(frontier[n], patch, placed);
      // Leftovers among another patch's atoms are labelled but carry the walk no further.
      const std::size_t all = blocks_.atoms(frontier[n]).size();
      fits[n] = 4 * std::size_t{outcome.matched} >= all ? 1 : 0;
    }
  });
  std::vector<Index> next;
  for (std::size_t n = 0; n < frontier.size(); ++n) {
    if (fits[n] != 0) accept(frontier[n], patch, outcomes[n]);
  }
  for (std::size_t n = 0; n < frontier.size(); ++n) {
    if (fits[n] == 0) continue;
    for_shell(1, [&](int dx, int dy, int dz) {
      const Index other = blocks_.neighbour(frontier[n], dx, dy, dz);
      if (other != no_index && free_[other] > 0 && frame_in(other, patch) == nullptr) next.push_back(other);
    });
  }
  std::sort(next.begin(), next.end());
  next.erase(std::unique(next.begin(), next.end()), next.end());
  return next;
}

// Blocks that the walk did not reach but that lie across a few empty (or strange) ones from where it was.
std::vector<Index> LatticeWalk::beyond_gaps(std::uint16_t patch) const {
  constexpr Index enough = 8;  // atoms; fewer fit too easily
  std::vector<Index> blocks;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (free_[b] < enough || frame_in(b, patch) != nullptr) continue;
    bool near = false;
    for (int shell = 1; shell <= widest_gap && !near; ++shell) {
      for_shell(shell, [&](int dx, int dy, int dz) {
        if (near) return;
        const Index other = blocks_.neighbour(b, dx, dy, dz);
        near = other != no_index && frame_in(other, patch) != nullptr;
      });
    }
    if (near) blocks.push_back(static_cast<Index>(b));
  }
  return blocks;
}

void LatticeWalk::grow(std::uint16_t patch, std::vector<Index> frontier, Progress& progress) {
  for (;;) {
    while (!frontier.empty()) frontier = advance(patch, frontier, 1, progress);
    frontier = advance(patch, beyond_gaps(patch), widest_gap, progress);
    if (frontier.empty()) return;
  }
}

// The best of some atoms of the block taken for each of the cell's.
LatticeWalk::Seed LatticeWalk::try_seed(std::size_t block) const {
  std::vector<Index> free;
  for (const Index atom : blocks_.atoms(block)) {
    if (of_[atom].patch == no_patch) free.push_back(atom);
  }
  // The grain that most of them are said to belong to; all are tried where nothing is said.
  std::vector<std::uint16_t> patterns;
  if (patterns_.size() > 1 && !crystal_.grain_of.empty()) {
    std::vector<std::size_t> votes(patterns_.size(), 0);
    for (const Index atom : free) {
      if (crystal_.grain(atom) < votes.size()) ++votes[crystal_.grain(atom)];
    }
    const auto most = std::max_element(votes.begin(), votes.end());
    if (*most > 0) patterns.push_back(static_cast<std::uint16_t>(most - votes.begin()));
  }
  if (patterns.empty()) {
    patterns.resize(std::min<std::size_t>(patterns_.size(), 8));
    std::iota(patterns.begin(), patterns.end(), std::uint16_t{0});
  }
  Seed best;
  best.block = block;
  const std::size_t tried = std::min(seed_atoms, free.size());
  // Nothing beats a block all of whose atoms are in place to rounding, of the right species.
  const double highest = (species_known_ ? 1.5 : 1.0) * static_cast<double>(free.size());
  for (const std::uint16_t p : patterns) {
    const WalkPattern& pattern = patterns_[p];
    for (std::size_t n = 0; n < tried; ++n) {
      const Vec3& place = atoms_.positions[free[(2 * n + 1) * free.size() / (2 * tried)]];
      for (const BasisAtom& atom : pattern.cell.basis) {
        if (best.score >= highest) return best;
        Outcome outcome = match(block, pattern, {pattern.cell.matrix(), place - atom.position});
        const double order = outcome.mean_squared / (pattern.tolerance * pattern.tolerance);
        const double score = outcome.matched * (1.0 - 0.5 * order) + 0.5 * outcome.of_species;
        if (score > best.score) best = {block, p, outcome, score};
      }
    }
  }
  return best;
}

LatticeWalk::Seed LatticeWalk::find_seed(std::vector<bool>& failed, std::size_t& failures, Progress& progress) const {
  constexpr Index enough = 16;  // atoms
  Index fullest = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!failed[b]) fullest = std::max(fullest, free_[b]);
  }
  Index least = std::max(enough, fullest / 2);
  while (fullest >= enough && failures < most_failures) {
    std::vector<Index> full;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (!failed[b] && free_[b] >= least) full.push_back(static_cast<Index>(b));
    }
    if (full.empty()) {
      if (least == enough) break;
      least = enough;
      continue;
    }
    const std::size_t count = std::min(seeds_at_once, full.size());
    std::vector<Seed> seeds(count);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t n = begin; n < end; ++n) seeds[n] = try_seed(full[(2 * n + 1) * full.size() / (2 * count)]);
    });
    Seed best;
    std::vector<Placed> placed;
    for (Seed& seed : seeds) {
      const WalkPattern& pattern = patterns_[seed.pattern];
      seed.outcome = settle(seed.block, pattern, seed.outcome.frame, placed);
      const double order = seed.outcome.mean_squared / (pattern.tolerance * pattern.tolerance);
      const bool foreign = species_known_ && seed.outcome.of_species < least_of_species * seed.outcome.matched;
      if (seed.outcome.matched < least_seed_share * seed.outcome.free + 3.0 || order > least_seed_order || foreign) {
        failed[seed.block] = true;
        ++failures;
      } else if (seed.score > best.score) {
        best = seed;
      }
    }
    if (best.score >= 0.0) {
      failures = 0;
      return best;
    }
  }
  return {};
}

std::vector<LatticeWalk::Patch> LatticeWalk::run(Progress& progress) {
  std::vector<bool> failed(blocks_.size(), false);
  std::size_t failures = 0;
  while (patches_.size() + 1 < no_patch) {
    const std::size_t free = std::accumulate(free_.begin(), free_.end(), std::size_t{0});
    progress.update(1.0 - static_cast<double>(free) / static_cast<double>(std::max<std::size_t>(of_.size(), 1)));
    if (free < smallest_patch_) break;
    const Seed seed = find_seed(failed, failures, progress);
    if (seed.score < 0.0) break;
    const auto patch = static_cast<std::uint16_t>(patches_.size());
    patches_.push_back({seed.pattern, 0});
    std::vector<Placed> placed;
    const Outcome outcome = match(seed.block, patterns_[seed.pattern], seed.outcome.frame, &placed);
    take(seed.block, patch, placed);
    accept(seed.block, patch, outcome);
    failed[seed.block] = true;
    std::vector<Index> around;
    for_shell(1, [&](int dx, int dy, int dz) {
      const Index other = blocks_.neighbour(seed.block, dx, dy, dz);
      if (other != no_index && free_[other] > 0) around.push_back(other);
    });
    std::sort(around.begin(), around.end());
    grow(patch, std::move(around), progress);
  }
  merge_patches(progress);
  settle_leftovers(progress);
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    patches_[p].seams = count_seams(static_cast<std::uint16_t>(p));
  }
  return std::move(patches_);
}

}  // namespace atomesh
