// Atoms on the edge of what is stamped around which the crystal is the same, moved by whole cells.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/parallel.h"
#include "preprocess/stamp_sample.h"

namespace atomesh {

namespace {

constexpr std::size_t atoms_per_range = 1024;

// The sites around one: windows of 4×4×4 cells, and which of their cells count.
struct Window {
  Cell first;  // from the atom's cell
  std::size_t basis;
  std::uint64_t cells;
};

std::vector<Window> windows_around(const PatchPattern& pattern, std::size_t basis, double radius) {
  const Vec3 center = pattern.position({0, 0, 0}, basis);
  const Vec3 reach = radius * pattern.cells_per_length();
  std::vector<Window> windows;
  for (std::size_t b = 0; b < pattern.basis(); ++b) {
    Cell low, high, first;
    for (int k = 0; k < 3; ++k) {
      const double at = pattern.fractional()[basis][k] - pattern.fractional()[b][k];
      low[k] = static_cast<int>(std::floor(at - reach[k]));
      high[k] = static_cast<int>(std::ceil(at + reach[k]));
    }
    for (first[0] = low[0]; first[0] <= high[0]; first[0] += 4) {
      for (first[1] = low[1]; first[1] <= high[1]; first[1] += 4) {
        for (first[2] = low[2]; first[2] <= high[2]; first[2] += 4) {
          std::uint64_t cells = 0;
          for (std::size_t n = 0; n < 64; ++n) {
            const Vec3 site = pattern.position(first + StampedPatch::local_cell(n), b);
            if (glm::distance(site, center) <= radius) cells |= std::uint64_t{1} << n;
          }
          if (cells != 0) windows.push_back({first, b, cells});
        }
      }
    }
  }
  return windows;
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
  return hash ^ hash >> 29;
}

}  // namespace

// An atom's cells of radius up to R, and which of them are stamped, are decided by the points within 2R of it; by the
// corners and the sites close to polytopes at it; and by foreign points in the spheres of those, all a little moved.
double StampedSample::sphere_of_influence(const PatchPattern& pattern) const {
  const double off = pattern.in_place();
  const double stamped = std::min(pattern.largest_void(), options_.largest_radius + sphere_slack * off);
  return std::max(2.0 * options_.largest_radius * (1.0 + 1e-6) + off, 2.0 * stamped + (close_slack + 7.0) * off);
}

// Two atoms of one patch on the same basis site have the same cells at them, moved by whole lattice vectors, when the
// same sites within the sphere of influence are taken, by exact atoms, and nothing else is in it. For then the points
// that decide their cells are the same but for rounding, far below the tolerance within which points count as on a
// sphere and within which certain() is decided; and so is what is stamped. (Stamps taken back leave their atoms
// inexact.) Cells found at the first, whose corners all lie in the sphere, are cells at the others.
//
// The first is the one that comes first in its patch's bricks, which no order of atoms or threads changes.
void StampedSample::find_copies(std::span<const Index> edge, std::span<const std::size_t> first, OpenPoints& result,
                                Progress& progress) const {
  std::vector<std::uint64_t> hash(edge.size(), 0);
  std::vector<std::uint8_t> repeats(edge.size(), 0);
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (!patches_[p] || first[p] == first[p + 1]) continue;
    const StampedPatch& patch = *patches_[p];
    const PatchPattern& pattern = patch.pattern();
    const double radius = sphere_of_influence(pattern);
    std::vector<std::vector<Window>> windows;
    for (std::size_t b = 0; b < pattern.basis(); ++b) windows.push_back(windows_around(pattern, b, radius));

    const auto near_foreign = [&](Index i, std::vector<Index>& slots) {
      const double far = radius + pattern.in_place();
      const auto none = [](Index) { return false; };
      for (std::size_t o = 0; o < patches_.size(); ++o) {
        if (o != p && patches_[o] && !patches_[o]->each_in_ball(points_[i], far, none)) return true;
      }
      loose_grid_->find(points_[i], far, slots);
      return !slots.empty();
    };
    parallel_for(first[p + 1] - first[p], atoms_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::vector<Index> slots;
      for (std::size_t n = first[p] + begin; n < first[p] + end; ++n) {
        const LatticeSite& site = sites_.of[edge[n]];
        std::uint64_t key = site.basis;
        bool exact = true;
        for (const Window& w : windows[site.basis]) {
          key = mixed(key, patch.occupied(site.cell + w.first, w.basis) & w.cells);
          exact = exact && (patch.inexact(site.cell + w.first, w.basis) & w.cells) == 0;
        }
        if (!exact || near_foreign(edge[n], slots)) continue;
        hash[n] = key;
        repeats[n] = 1;
      }
    });

    std::unordered_map<std::uint64_t, std::size_t> model_of;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // (model, copy), places in `edge`
    for (std::size_t n = first[p]; n < first[p + 1]; ++n) {
      if (repeats[n] == 0) continue;
      const auto [found, added] = model_of.try_emplace(hash[n], n);
      if (!added) pairs.emplace_back(found->second, n);
    }
    // Equal hashes are not proof.
    std::vector<std::uint8_t> equal(pairs.size(), 0);
    parallel_for(pairs.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t n = begin; n < end; ++n) {
        const LatticeSite &a = sites_.of[edge[pairs[n].first]], &b = sites_.of[edge[pairs[n].second]];
        equal[n] = a.basis == b.basis && std::all_of(windows[a.basis].begin(), windows[a.basis].end(),
                                                     [&](const Window& w) {
                                                       return ((patch.occupied(a.cell + w.first, w.basis) ^
                                                                patch.occupied(b.cell + w.first, w.basis)) &
                                                               w.cells) == 0;
                                                     })
                       ? 1
                       : 0;
      }
    });
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      if (equal[n] == 0) continue;
      const Index model = edge[pairs[n].first], copy = edge[pairs[n].second];
      result.role[model] = OpenPoints::model;
      result.role[copy] = OpenPoints::copy;
      result.copies.emplace_back(model, copy);
    }
  }
}

}  // namespace atomesh
