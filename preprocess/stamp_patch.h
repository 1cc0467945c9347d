// One patch of a sample with the polytopes of its pattern that are stamped.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "preprocess/stamp_pattern.h"

namespace atomesh {

using Cell = std::array<int, 3>;

inline Cell operator+(const Cell& a, const Cell& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

// Where corners of a polytope are empty but its sphere is too, what the others span is a Delaunay cell like the whole:
// half octahedra at the surface, cubes that lack a corner at a vacancy.
//
// Cells are kept in bricks of 4×4×4, only where there are atoms: memory grows with the atoms, whatever the patch's
// shape, but for a pointer a brick of its bounds.
class StampedPatch {
 public:
  // `atoms`: the patch's atoms that are in place. Those that find their site taken are handed back in `left_over`.
  // `points`, `of` and `exact` (1: the atom is so near its site that it cannot be told from it) are the whole sample's
  // and points must outlive this. Nothing when the patch is so scattered that even its bricks' bounds would not fit.
  static std::optional<StampedPatch> make(PatchPattern pattern, std::span<const Index> atoms,
                                          std::span<const Vec3> points, std::span<const LatticeSite> of,
                                          std::span<const std::uint8_t> exact, std::vector<Index>& left_over);

  const PatchPattern& pattern() const { return pattern_; }
  // no_index where no atom is in place.
  Index atom(const Cell& cell, std::size_t basis) const {
    const std::size_t s = slot(cell);
    return s == nowhere ? no_index : atoms_[s * pattern_.basis() + basis];
  }

  // Polytopes whose sphere might hold this place will not be stamped. May be called from several threads.
  void keep_clear_of(const Vec3& position);
  // Stamps what can be stamped; returns how many tetrahedra that makes.
  std::size_t stamp(double largest_radius, double tolerance, Progress& progress);
  std::size_t tetrahedra() const { return total_; }
  // Writes them.
  void write(std::span<Tetrahedron> tetrahedra, Progress& progress) const;

  // Takes back what is stamped at an atom, and counts it as not exact.
  void unstamp(const LatticeSite& site);

  // The atoms around which not every polytope is stamped whole, brick by brick.
  std::vector<Index> edge(Progress& progress) const;
  // A bit for each of the 4×4×4 cells from `first` on: local number n (see cell_of) is n-th. Which have an atom on this
  // basis site, and which one that is off it.
  std::uint64_t occupied(const Cell& first, std::size_t basis) const { return window(occupied_, first, basis); }
  std::uint64_t inexact(const Cell& first, std::size_t basis) const {
    return any_inexact_ ? window(inexact_, first, basis) : 0;
  }
  static Cell local_cell(std::size_t local) {
    const auto n = static_cast<int>(local);
    return {n >> 4, n >> 2 & 3, n & 3};
  }
  bool any_stamped(const LatticeSite& site) const;
  // Whether the sites, all of this patch, are corners of one stamped polytope.
  bool in_one_polytope(std::span<const LatticeSite> sites) const;
  // Calls body(triangle) for the triangles at an atom with a stamped polytope before and none behind them, seen
  // counter-clockwise from behind (outside). Stops and returns false when body does.
  template <class Body>
  bool each_outside_face(const LatticeSite& site, Body&& body) const {
    const std::vector<Triangle> faces = outside_faces(site);
    return std::all_of(faces.begin(), faces.end(), body);
  }
  // Calls body(atom) for the atoms in place within `radius` of a place. Stops and returns false when body does.
  template <class Body>
  bool each_in_ball(const Vec3& center, double radius, Body&& body) const;

 private:
  // `part`: some corners are empty, and what the others span is stamped.
  enum class State : std::uint8_t { open, whole, part };
  // What polytopes with empty corners are cut into, kept for the next with the same.
  struct Cuts {
    std::mutex lock;
    std::map<std::pair<Index, std::uint64_t>, PatternCut> cut;
  };
  static constexpr std::size_t nowhere = ~std::size_t{0};
  static constexpr std::size_t cells_per_brick = 64;

  StampedPatch(PatchPattern pattern, std::span<const Vec3> points) : pattern_(std::move(pattern)), points_(points) {}
  bool lay_bricks(std::span<const Index> atoms, std::span<const LatticeSite> of);
  std::size_t slot(const Cell& cell) const {
    // Numbers below the first become huge ones.
    const auto i = static_cast<std::uint32_t>(cell[0] - min_[0]);
    const auto j = static_cast<std::uint32_t>(cell[1] - min_[1]);
    const auto k = static_cast<std::uint32_t>(cell[2] - min_[2]);
    if (i >> 2 >= bricks_[0] || j >> 2 >= bricks_[1] || k >> 2 >= bricks_[2]) return nowhere;
    const Index brick = brick_[(std::size_t{i >> 2} * bricks_[1] + (j >> 2)) * bricks_[2] + (k >> 2)];
    if (brick == no_index) return nowhere;
    return brick * cells_per_brick + ((i & 3) << 4 | (j & 3) << 2 | (k & 3));
  }
  Cell cell_of(std::size_t brick, std::size_t local) const { return first_cell_[brick] + local_cell(local); }
  // What a word holds of one cell: bits are kept [brick][kind], one for each cell.
  bool bit(const std::vector<std::uint64_t>& words, const Cell& cell, std::size_t kind) const {
    const std::size_t s = slot(cell);
    if (s == nowhere) return false;
    const std::size_t kinds = words.size() / first_cell_.size();
    return (words[(s / cells_per_brick) * kinds + kind] >> (s % cells_per_brick) & 1) != 0;
  }
  // The bits of the 4×4×4 cells from `first` on.
  std::uint64_t window(const std::vector<std::uint64_t>& words, const Cell& first, std::size_t kind) const;
  bool whole(const Cell& anchor, std::size_t polytope) const { return bit(whole_, anchor, polytope); }
  bool stamped(const Cell& anchor, std::size_t polytope) const {
    return whole(anchor, polytope) || bit(part_, anchor, polytope);
  }
  std::size_t stamp_brick(std::size_t brick, std::size_t polytope, double largest_radius, double tolerance);
  // The atoms at a polytope's corners, no_index where there is none; returns which there are, a bit each. Stops when
  // fewer than four can be left.
  std::uint64_t find_corners(const PatternPolytope& polytope, const Cell& anchor, Index* corner) const;
  const PatternCut& cut_of(Index polytope, std::uint64_t occupied) const;
  // The state that a polytope is given, and how many tetrahedra that makes.
  std::pair<State, std::size_t> fit(Index polytope, const Cell& anchor, double largest_radius, double tolerance) const;
  std::vector<Triangle> outside_faces(const LatticeSite& site) const;

  PatchPattern pattern_;
  std::span<const Vec3> points_;
  Cell min_{};
  std::array<std::uint32_t, 3> bricks_{};  // along each axis of the bounds
  std::vector<Index> brick_;               // of each place in the bounds, no_index: none
  std::vector<Cell> first_cell_;           // of each brick
  std::vector<Index> atoms_;               // [brick][cell][basis]
  bool any_inexact_ = false;
  std::vector<std::uint64_t> occupied_, inexact_;         // [brick][basis]
  std::vector<std::uint64_t> whole_, part_, kept_clear_;  // [brick][polytope]
  std::vector<std::size_t> tetrahedra_;                   // stamped in each brick
  std::size_t total_ = 0;                                 // in all
  std::unique_ptr<Cuts> cuts_ = std::make_unique<Cuts>();
};

template <class Body>
bool StampedPatch::each_in_ball(const Vec3& center, double radius, Body&& body) const {
  const Vec3 middle = pattern_.fraction(center);
  const Vec3 reach = (radius + pattern_.in_place()) * pattern_.cells_per_length();
  for (std::size_t b = 0; b < pattern_.basis(); ++b) {
    Cell low, high, cell;
    for (int k = 0; k < 3; ++k) {
      const double at = middle[k] - pattern_.fractional()[b][k];
      const double last = static_cast<double>(min_[k]) + 4.0 * bricks_[k];
      low[k] = static_cast<int>(std::clamp(std::ceil(at - reach[k]), static_cast<double>(min_[k]), last));
      high[k] = static_cast<int>(std::clamp(std::floor(at + reach[k]), static_cast<double>(min_[k]) - 1.0, last));
    }
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          const Index i = atom(cell, b);
          if (i == no_index) continue;
          const Vec3 d = points_[i] - center;
          if (glm::dot(d, d) <= radius * radius && !body(i)) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace atomesh
