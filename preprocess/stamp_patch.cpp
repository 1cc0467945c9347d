#include "preprocess/stamp_patch.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "core/circumsphere.h"
#include "core/parallel.h"
#include "preprocess/pull_polytope.h"

namespace atomesh {

namespace {

constexpr std::size_t bricks_per_range = 64;

Cell offset_cell(const SiteOffset& s) {
  return {s.cell[0], s.cell[1], s.cell[2]};
}

}  // namespace

std::optional<StampedPatch> StampedPatch::make(PatchPattern pattern, std::span<const Index> atoms,
                                               std::span<const Vec3> points, std::span<const LatticeSite> of,
                                               std::vector<Index>& left_over) {
  if (!pattern.usable() || atoms.empty()) return std::nullopt;
  StampedPatch patch(std::move(pattern), points);
  if (!patch.lay_bricks(atoms, of)) return std::nullopt;
  const std::size_t basis = patch.pattern_.basis();
  for (const Index i : atoms) {
    Index& place = patch.atoms_[patch.slot(of[i].cell) * basis + of[i].basis];
    if (place == no_index) {
      place = i;
    } else {
      left_over.push_back(i);
    }
  }
  return patch;
}

bool StampedPatch::lay_bricks(std::span<const Index> atoms, std::span<const LatticeSite> of) {
  constexpr int limit = std::numeric_limits<int>::max() / 4;  // room for differences
  min_.fill(limit);
  Cell max{-limit, -limit, -limit};
  for (const Index i : atoms) {
    for (int k = 0; k < 3; ++k) {
      min_[k] = std::min(min_[k], of[i].cell[k]);
      max[k] = std::max(max[k], of[i].cell[k]);
    }
  }
  // Polytopes are kept at their anchors, which may lie in cells without atoms.
  std::vector<std::vector<Cell>> anchors(pattern_.basis());
  Cell before{}, behind{};
  for (std::size_t b = 0; b < anchors.size(); ++b) {
    anchors[b].push_back({0, 0, 0});
    for (const PatternCorner& c : pattern_.around(b)) anchors[b].push_back(c.cell);
    std::sort(anchors[b].begin(), anchors[b].end());
    anchors[b].erase(std::unique(anchors[b].begin(), anchors[b].end()), anchors[b].end());
    for (const Cell& cell : anchors[b]) {
      for (int k = 0; k < 3; ++k) {
        before[k] = std::min(before[k], cell[k]);
        behind[k] = std::max(behind[k], cell[k]);
      }
    }
  }
  min_ = min_ + before;
  max = max + behind;
  double places = 1.0;
  for (int k = 0; k < 3; ++k) {
    if (min_[k] < -limit || max[k] > limit) return false;
    bricks_[k] = static_cast<std::uint32_t>(max[k] - min_[k]) / 4 + 1;
    places *= bricks_[k];
  }
  if (!(places < 1e6 + 8.0 * static_cast<double>(atoms.size()))) return false;
  brick_.assign(static_cast<std::size_t>(places), no_index);
  const auto place = [&](const Cell& cell) {
    return (static_cast<std::size_t>((cell[0] - min_[0]) >> 2) * bricks_[1] +
            static_cast<std::size_t>((cell[1] - min_[1]) >> 2)) *
               bricks_[2] +
           static_cast<std::size_t>((cell[2] - min_[2]) >> 2);
  };
  for (const Index i : atoms) {
    for (const Cell& cell : anchors[of[i].basis]) brick_[place(of[i].cell + cell)] = 0;
  }
  for (std::uint32_t a = 0, n = 0; a < bricks_[0]; ++a) {
    for (std::uint32_t b = 0; b < bricks_[1]; ++b) {
      for (std::uint32_t c = 0; c < bricks_[2]; ++c, ++n) {
        if (brick_[n] == no_index) continue;
        brick_[n] = static_cast<Index>(first_cell_.size());
        first_cell_.push_back(min_ + Cell{static_cast<int>(4 * a), static_cast<int>(4 * b), static_cast<int>(4 * c)});
      }
    }
  }
  const std::size_t slots = first_cell_.size() * cells_per_brick;
  atoms_.assign(slots * pattern_.basis(), no_index);
  state_.assign(slots * pattern_.polytopes().size(), State::open);
  tetrahedra_.assign(first_cell_.size(), 0);
  return true;
}

void StampedPatch::keep_clear_of(const Vec3& position) {
  const Vec3 at = pattern_.fraction(position);
  const std::size_t count = pattern_.polytopes().size();
  for (std::size_t p = 0; p < count; ++p) {
    const PatternPolytope& polytope = pattern_.polytopes()[p];
    const double radius = polytope.radius + sphere_slack * pattern_.in_place();
    const Vec3 middle = at - polytope.center_fraction;
    Cell low, high, cell;
    for (int k = 0; k < 3; ++k) {
      const double first = min_[k], last = first + 4.0 * bricks_[k];
      low[k] =
          static_cast<int>(std::clamp(std::ceil(middle[k] - radius * pattern_.cells_per_length()[k]), first, last));
      high[k] = static_cast<int>(
          std::clamp(std::floor(middle[k] + radius * pattern_.cells_per_length()[k]), first - 1.0, last));
    }
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          const std::size_t s = slot(cell);
          if (s == nowhere) continue;
          const Vec3 d = pattern_.corner(cell) + polytope.center - position;
          if (glm::dot(d, d) > radius * radius) continue;
          std::atomic_ref(state_[s * count + p]).store(State::kept_clear, std::memory_order_relaxed);
        }
      }
    }
  }
}

std::uint64_t StampedPatch::find_corners(const PatternPolytope& polytope, const Cell& anchor, Index* corner) const {
  const std::size_t count = polytope.corners.size();
  std::uint64_t occupied = 0;
  std::size_t empty = 0;
  for (std::size_t c = 0; c < count; ++c) {
    const SiteOffset& s = polytope.corners[c];
    corner[c] = atom(anchor + offset_cell(s), s.basis);
    if (corner[c] != no_index) {
      occupied |= std::uint64_t{1} << c;
    } else if (++empty + 4 > count) {
      return 0;
    }
  }
  return occupied;
}

const PatternCut& StampedPatch::cut_of(Index polytope, std::uint64_t occupied) const {
  const PatternPolytope& p = pattern_.polytopes()[polytope];
  if (static_cast<std::size_t>(std::popcount(occupied)) == p.corners.size()) return p.whole;
  const std::scoped_lock guard(cuts_->lock);
  const auto [place, added] = cuts_->cut.try_emplace({polytope, occupied});
  if (added) place->second = pattern_.cut(p, occupied);
  return place->second;
}

std::pair<StampedPatch::State, std::size_t> StampedPatch::fit(Index number, const Cell& anchor, double largest_radius,
                                                              double tolerance) const {
  constexpr std::pair<State, std::size_t> none{State::open, 0};
  const PatternPolytope& polytope = pattern_.polytopes()[number];
  std::array<Index, pull_polytope_corners> corner;
  const std::uint64_t occupied = find_corners(polytope, anchor, corner.data());
  if (occupied == 0) return none;
  const PatternCut& cut = cut_of(number, occupied);
  if (cut.tetrahedra.empty()) return none;
  const auto at = [&](std::size_t c) -> const Vec3& { return points_[corner[c]]; };
  const auto& f = cut.frame;
  const Sphere sphere = circumsphere(at(f[0]), at(f[1]), at(f[2]), at(f[3]));
  if (!(sphere.radius <= largest_radius)) return none;
  const double moved = glm::distance(sphere.center, pattern_.corner(anchor) + polytope.center);
  if (!(moved + std::abs(sphere.radius - polytope.radius) <= sphere_slack * pattern_.in_place())) return none;
  const double off = tolerance * sphere.radius;
  const std::size_t count = polytope.corners.size();
  for (std::size_t c = 0; count > 4 && c < count; ++c) {
    if (corner[c] == no_index) continue;
    if (!(std::abs(glm::distance(at(c), sphere.center) - sphere.radius) <= off)) return none;
  }
  for (const SiteOffset& s : polytope.close) {
    const Index near = atom(anchor + offset_cell(s), s.basis);
    if (near != no_index && !(glm::distance(points_[near], sphere.center) > sphere.radius + off)) return none;
  }
  return {&cut == &polytope.whole ? State::whole : State::part, cut.tetrahedra.size()};
}

std::size_t StampedPatch::stamp(double largest_radius, double tolerance, Progress& progress) {
  const auto& polytopes = pattern_.polytopes();
  parallel_for(first_cell_.size(), bricks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t brick = begin; brick < end; ++brick) {
      std::size_t made = 0;
      for (std::size_t local = 0; local < cells_per_brick; ++local) {
        const std::size_t s = brick * cells_per_brick + local;
        for (std::size_t p = 0; p < polytopes.size(); ++p) {
          State& state = state_[s * polytopes.size() + p];
          if (state != State::open) continue;
          const auto [found, tetrahedra] = fit(static_cast<Index>(p), cell_of(brick, local), largest_radius, tolerance);
          state = found;
          made += tetrahedra;
        }
      }
      tetrahedra_[brick] = made;
    }
  });
  total_ = 0;
  for (const std::size_t made : tetrahedra_) total_ += made;
  return total_;
}

void StampedPatch::write(std::span<Tetrahedron> tetrahedra, Progress& progress) const {
  const auto& polytopes = pattern_.polytopes();
  std::vector<std::size_t> first(tetrahedra_.size() + 1, 0);
  for (std::size_t brick = 0; brick < tetrahedra_.size(); ++brick) first[brick + 1] = first[brick] + tetrahedra_[brick];
  parallel_for(first_cell_.size(), bricks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::array<Index, pull_polytope_corners> corner;
    for (std::size_t brick = begin; brick < end; ++brick) {
      std::size_t next = first[brick];
      for (std::size_t local = 0; local < cells_per_brick; ++local) {
        const std::size_t s = brick * cells_per_brick + local;
        const Cell anchor = cell_of(brick, local);
        for (std::size_t p = 0; p < polytopes.size(); ++p) {
          const State state = state_[s * polytopes.size() + p];
          if (state != State::whole && state != State::part) continue;
          const std::uint64_t occupied = find_corners(polytopes[p], anchor, corner.data());
          for (const auto& t : cut_of(static_cast<Index>(p), occupied).tetrahedra) {
            tetrahedra[next++] = {corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]};
          }
        }
      }
    }
  });
}

bool StampedPatch::whole(const LatticeSite& site) const {
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    if (state(site.cell + c.cell, c.polytope) != State::whole) return false;
  }
  return true;
}

bool StampedPatch::any_stamped(const LatticeSite& site) const {
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    if (stamped(site.cell + c.cell, c.polytope)) return true;
  }
  return false;
}

std::vector<Triangle> StampedPatch::outside_faces(const LatticeSite& site) const {
  // All that are not known to have a whole polytope on both sides, then without those that are seen from both.
  std::vector<Triangle> seen;
  std::array<Index, pull_polytope_corners> corner;
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    const Cell anchor = site.cell + c.cell;
    if (!stamped(anchor, c.polytope)) continue;
    const PatternPolytope& polytope = pattern_.polytopes()[c.polytope];
    const PatternCut& cut = cut_of(c.polytope, find_corners(polytope, anchor, corner.data()));
    const bool is_whole = &cut == &polytope.whole;
    for (std::size_t f = 0; f < cut.faces.size(); ++f) {
      const auto& face = cut.faces[f];
      if (face[0] != c.corner && face[1] != c.corner && face[2] != c.corner) continue;
      if (is_whole) {
        const PatternNeighbour& behind = polytope.neighbours[f];
        if (state(anchor + behind.cell, behind.polytope) == State::whole) continue;
      }
      seen.push_back({corner[face[0]], corner[face[1]], corner[face[2]]});
    }
  }
  std::vector<Triangle> outside;
  for (const Triangle& t : seen) {
    const bool inside = std::any_of(seen.begin(), seen.end(), [&](const Triangle& o) {
      for (int i = 0; i < 3; ++i) {
        if (o[i] == t[0]) return o[(i + 1) % 3] == t[2] && o[(i + 2) % 3] == t[1];
      }
      return false;
    });
    if (!inside) outside.push_back(t);
  }
  return outside;
}

bool StampedPatch::in_one_polytope(std::span<const LatticeSite> sites) const {
  for (const PatternCorner& c : pattern_.around(sites[0].basis)) {
    const Cell anchor = sites[0].cell + c.cell;
    if (!stamped(anchor, c.polytope)) continue;
    const auto& corners = pattern_.polytopes()[c.polytope].corners;
    const auto is_corner = [&](const LatticeSite& site) {
      return std::any_of(corners.begin(), corners.end(), [&](const SiteOffset& s) {
        return s.basis == site.basis && anchor + offset_cell(s) == site.cell;
      });
    };
    if (std::all_of(sites.begin(), sites.end(), is_corner)) return true;
  }
  return false;
}

}  // namespace atomesh
