// What is done once every patch has been walked: patches that are one are joined, what lies between is shared out.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "preprocess/lattice_walk.h"

namespace atomesh {

namespace {

// Two predictions of one site agree when they are this near, as a share of the tolerance.
constexpr double same_place = 0.5;
// An atom changes its patch only for a better place by this share of the tolerance², not by rounding.
constexpr double noticeable = 1e-3;
constexpr std::size_t blocks_per_range = 4;

}  // namespace

// How the numbers of one frame read in another that lies near, where both say the same of sites and species.
LatticeWalk::Renumbering LatticeWalk::common_numbers(const BlockFrame& from, const BlockFrame& to) const {
  const WalkPattern& pattern = patterns_[patches_[from.patch].pattern];
  const Mat3 to_fraction = glm::inverse(to.frame.matrix);
  const double limit = std::pow(same_place * pattern.tolerance, 2.0);
  const Vec3 middle = 0.5 * (blocks_.center(from.block) + blocks_.center(to.block));
  const Vec3 near = glm::floor(glm::inverse(from.frame.matrix) * (middle - from.frame.origin));
  Renumbering renumbering;
  std::vector<bool> taken(pattern.cell.basis.size(), false);
  for (std::size_t b = 0; b < pattern.cell.basis.size(); ++b) {
    const Vec3 place = from.frame.origin + from.frame.matrix * (near + pattern.finder.fractional()[b]);
    const SiteFinder::Found found = pattern.finder.find(to.frame, to_fraction, place);
    if (!(found.squared <= limit) || taken[found.basis]) return {};
    if (pattern.cell.basis[b].species != pattern.cell.basis[found.basis].species) return {};
    taken[found.basis] = true;
    LatticeSite& site = renumbering.of.emplace_back(LatticeSite{found.cell, found.basis, to.patch});
    for (int k = 0; k < 3; ++k) site.cell[k] -= static_cast<std::int32_t>(near[k]);
  }
  renumbering.into = to.patch;
  return renumbering;
}

// Patches that met without knowing that they are one: begun on two sides of something that the walk went round, or
// numbered from another of the cell's atoms where the cell given is not primitive.
void LatticeWalk::merge_patches(Progress& progress) {
  std::vector<Renumbering> merged(patches_.size());
  bool any = false;
  for (bool changed = patches_.size() > 1; changed;) {
    changed = false;
    progress.check();
    for (std::size_t n = 0; n < frames_.size() && !changed; ++n) {
      const BlockFrame from = frames_[n];
      if (from.patch == no_patch) continue;
      for (int shell = 0; shell <= 1 && !changed; ++shell) {
        for_shell(shell, [&](int dx, int dy, int dz) {
          const Index other = changed ? no_index : blocks_.neighbour(from.block, dx, dy, dz);
          for (Index m = other == no_index ? no_index : first_frame_[other]; m != no_index && !changed;
               m = frames_[m].next) {
            const BlockFrame& to = frames_[m];
            if (to.patch >= from.patch || patches_[to.patch].pattern != patches_[from.patch].pattern) continue;
            Renumbering& renumbering = merged[from.patch];
            renumbering = common_numbers(from, to);
            changed = renumbering.into != no_patch;
          }
        });
      }
      if (!changed) continue;
      any = true;
      // The frames now speak the other patch's numbers.
      const Renumbering& renumbering = merged[from.patch];
      const std::vector<Vec3>& fraction = patterns_[patches_[from.patch].pattern].finder.fractional();
      const LatticeSite& first = renumbering.of[0];
      const Vec3 shift = Vec3(first.cell[0], first.cell[1], first.cell[2]) + fraction[first.basis] - fraction[0];
      for (BlockFrame& frame : frames_) {
        if (frame.patch != from.patch) continue;
        frame.patch = frame_in(frame.block, renumbering.into) != nullptr ? no_patch : renumbering.into;
        frame.frame.origin -= frame.frame.matrix * shift;
      }
    }
  }
  if (!any) return;
  for (LatticeSite& site : of_) {
    while (site.patch != no_patch && merged[site.patch].into != no_patch) {
      LatticeSite other = merged[site.patch].of[site.basis];
      for (int k = 0; k < 3; ++k) other.cell[k] += site.cell[k];
      site = other;
    }
  }
}

// Atoms that the waves left without a site, or took while another patch that lies as near fits them better: on cracks,
// grain boundaries and steps, where a block holds parts of two.
void LatticeWalk::settle_leftovers(Progress& progress) {
  parallel_for(blocks_.size(), blocks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<const BlockFrame*> around;
    std::vector<Mat3> to_fraction;
    for (std::size_t b = begin; b < end; ++b) {
      around.clear();
      to_fraction.clear();
      bool mixed = false;
      for (int shell = 0; shell <= 1; ++shell) {
        for_shell(shell, [&](int dx, int dy, int dz) {
          const Index other = blocks_.neighbour(b, dx, dy, dz);
          if (other == no_index) return;
          for (Index n = first_frame_[other]; n != no_index; n = frames_[n].next) {
            if (frames_[n].patch == no_patch) continue;
            around.push_back(&frames_[n]);
            mixed = mixed || frames_[n].patch != around.front()->patch;
          }
        });
      }
      if (around.empty() || (!mixed && free_[b] == 0)) continue;
      for (const BlockFrame* frame : around) to_fraction.push_back(glm::inverse(frame->frame.matrix));
      Index free = 0;
      for (const Index atom : blocks_.atoms(b)) {
        LatticeSite& site = of_[atom];
        if (site.patch != no_patch && !mixed) continue;
        const double own_limit = std::pow(patterns_.front().tolerance, 2.0);
        double own = std::numeric_limits<double>::infinity();
        double best = std::numeric_limits<double>::infinity();
        LatticeSite found_site;
        for (std::size_t n = 0; n < around.size(); ++n) {
          const BlockFrame& frame = *around[n];
          const WalkPattern& pattern = patterns_[patches_[frame.patch].pattern];
          const auto found = pattern.finder.find(frame.frame, to_fraction[n], atoms_.positions[atom]);
          if (!(found.squared <= pattern.tolerance * pattern.tolerance)) continue;
          if (frame.patch == site.patch) own = std::min(own, found.squared);
          if (found.squared < best) {
            best = found.squared;
            found_site = {found.cell, found.basis, frame.patch};
          }
        }
        if (site.patch == no_patch || (found_site.patch != site.patch && best + noticeable * own_limit < 0.25 * own)) {
          site = found_site;
          squared_[atom] = static_cast<float>(best);
        }
        if (site.patch == no_patch) ++free;
      }
      free_[b] = free;
    }
  });
}

// Pairs of neighbouring blocks that number what lies between them differently.
std::size_t LatticeWalk::count_seams(std::uint16_t patch) const {
  const double tolerance = 2.0 * patterns_[patches_[patch].pattern].tolerance;
  std::size_t seams = 0;
  for (const BlockFrame& known : frames_) {
    if (known.patch != patch) continue;
    const LatticeFrame& frame = known.frame;
    const Mat3 to_fraction = glm::inverse(frame.matrix);
    for_shell(1, [&](int dx, int dy, int dz) {
      const Index other = blocks_.neighbour(known.block, dx, dy, dz);
      const BlockFrame* next = other == no_index || other < known.block ? nullptr : frame_in(other, patch);
      if (next == nullptr) return;
      const Vec3 between = 0.5 * (blocks_.center(known.block) + blocks_.center(other));
      const Vec3 site = to_fraction * (between - frame.origin);
      if (glm::length(next->frame.origin + next->frame.matrix * site - between) > tolerance) ++seams;
    });
  }
  return seams;
}

}  // namespace atomesh
