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
                                               std::span<const std::uint8_t> exact, std::vector<Index>& left_over) {
  if (!pattern.usable() || atoms.empty()) return std::nullopt;
  StampedPatch patch(std::move(pattern), points);
  if (!patch.lay_bricks(atoms, of)) return std::nullopt;
  const std::size_t basis = patch.pattern_.basis();
  for (const Index i : atoms) {
    const std::size_t slot = patch.slot(of[i].cell);
    Index& place = patch.atoms_[slot * basis + of[i].basis];
    if (place != no_index) {
      left_over.push_back(i);
      continue;
    }
    place = i;
    const std::size_t word = slot / cells_per_brick * basis + of[i].basis;
    const std::uint64_t cell = std::uint64_t{1} << slot % cells_per_brick;
    patch.occupied_[word] |= cell;
    if (exact[i] != 0) continue;
    patch.inexact_[word] |= cell;
    patch.any_inexact_ = true;
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
  for (auto* words : {&occupied_, &inexact_}) words->assign(first_cell_.size() * pattern_.basis(), 0);
  for (auto* words : {&whole_, &part_, &kept_clear_}) {
    words->assign(first_cell_.size() * pattern_.polytopes().size(), 0);
  }
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
          std::atomic_ref(kept_clear_[s / cells_per_brick * count + p])
              .fetch_or(std::uint64_t{1} << s % cells_per_brick, std::memory_order_relaxed);
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

std::uint64_t StampedPatch::window(const std::vector<std::uint64_t>& words, const Cell& first, std::size_t kind) const {
  const std::size_t kinds = words.size() / first_cell_.size();
  std::array<int, 3> from, past;  // brick, and cells left out of it
  for (int k = 0; k < 3; ++k) {
    from[k] = (first[k] - min_[k]) >> 2;
    past[k] = (first[k] - min_[k]) & 3;
  }
  const auto word = [&](int a, int b, int c) -> std::uint64_t {
    // Numbers below the first become huge ones.
    const auto i = static_cast<std::uint32_t>(a), j = static_cast<std::uint32_t>(b), k = static_cast<std::uint32_t>(c);
    if (i >= bricks_[0] || j >= bricks_[1] || k >= bricks_[2]) return 0;
    const Index brick = brick_[(std::size_t{i} * bricks_[1] + j) * bricks_[2] + k];
    return brick == no_index ? 0 : words[brick * kinds + kind];
  };
  // The last axis lies in groups of 4 bits, the second in groups of 16.
  const std::uint64_t stay2 = 0x1111111111111111U * ((1U << (4 - past[2])) - 1U);
  const std::uint64_t stay1 = 0x0001000100010001U * ((1U << (16 - 4 * past[1])) - 1U);
  const auto row = [&](int a, int b) {
    const std::uint64_t w = word(a, b, from[2]);
    if (past[2] == 0) return w;
    return (w >> past[2] & stay2) | (word(a, b, from[2] + 1) << (4 - past[2]) & ~stay2);
  };
  const auto plane = [&](int a) {
    const std::uint64_t w = row(a, from[1]);
    if (past[1] == 0) return w;
    return (w >> 4 * past[1] & stay1) | (row(a, from[1] + 1) << (16 - 4 * past[1]) & ~stay1);
  };
  const std::uint64_t w = plane(from[0]);
  if (past[0] == 0) return w;
  return w >> 16 * past[0] | plane(from[0] + 1) << (64 - 16 * past[0]);
}

// All anchors of a brick at once where atoms are exact: each corner asks the cells that lie its offset away.
std::size_t StampedPatch::stamp_brick(std::size_t brick, std::size_t number, double largest_radius, double tolerance) {
  const PatternPolytope& polytope = pattern_.polytopes()[number];
  const std::size_t word = brick * pattern_.polytopes().size() + number;
  std::uint64_t all = ~kept_clear_[word], some = 0, off = 0;
  for (const SiteOffset& s : polytope.corners) {
    const std::uint64_t there = occupied(first_cell_[brick] + offset_cell(s), s.basis);
    all &= there;
    some |= there;
  }
  const bool can_be_certain = pattern_.certain(polytope, largest_radius, tolerance) > 0.0;
  if (any_inexact_ && can_be_certain) {
    for (const auto* sites : {&polytope.corners, &polytope.close}) {
      for (const SiteOffset& s : *sites) off |= inexact(first_cell_[brick] + offset_cell(s), s.basis);
    }
  }
  std::uint64_t whole = can_be_certain ? all & ~off : 0, part = 0;
  std::size_t made = static_cast<std::size_t>(std::popcount(whole)) * polytope.whole.tetrahedra.size();
  for (std::uint64_t rest = some & ~kept_clear_[word] & ~whole; rest != 0; rest &= rest - 1) {
    const auto local = static_cast<std::size_t>(std::countr_zero(rest));
    const auto [found, tetrahedra] = fit(static_cast<Index>(number), cell_of(brick, local), largest_radius, tolerance);
    if (found == State::whole) whole |= std::uint64_t{1} << local;
    if (found == State::part) part |= std::uint64_t{1} << local;
    made += tetrahedra;
  }
  whole_[word] = whole;
  part_[word] = part;
  return made;
}

std::size_t StampedPatch::stamp(double largest_radius, double tolerance, Progress& progress) {
  parallel_for(first_cell_.size(), bricks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t brick = begin; brick < end; ++brick) {
      std::size_t made = 0;
      for (std::size_t p = 0; p < pattern_.polytopes().size(); ++p) {
        made += stamp_brick(brick, p, largest_radius, tolerance);
      }
      tetrahedra_[brick] = made;
    }
  });
  total_ = 0;
  for (const std::size_t made : tetrahedra_) total_ += made;
  return total_;
}

void StampedPatch::unstamp(const LatticeSite& site) {
  std::array<Index, pull_polytope_corners> corner;
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    const Cell anchor = site.cell + c.cell;
    const std::size_t s = slot(anchor);
    if (s == nowhere) continue;
    const std::size_t word = s / cells_per_brick * pattern_.polytopes().size() + c.polytope;
    const std::uint64_t cell = std::uint64_t{1} << s % cells_per_brick;
    if (((whole_[word] | part_[word]) & cell) != 0) {
      const PatternPolytope& polytope = pattern_.polytopes()[c.polytope];
      const std::size_t gone = cut_of(c.polytope, find_corners(polytope, anchor, corner.data())).tetrahedra.size();
      tetrahedra_[s / cells_per_brick] -= gone;
      total_ -= gone;
    }
    whole_[word] &= ~cell;
    part_[word] &= ~cell;
    kept_clear_[word] |= cell;
  }
  const std::size_t s = slot(site.cell);
  inexact_[s / cells_per_brick * pattern_.basis() + site.basis] |= std::uint64_t{1} << s % cells_per_brick;
  any_inexact_ = true;
}

std::vector<Index> StampedPatch::edge(Progress& progress) const {
  std::vector<std::vector<Index>> parts((first_cell_.size() + bricks_per_range - 1) / bricks_per_range);
  parallel_for(first_cell_.size(), bricks_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index>& part = parts[begin / bricks_per_range];
    for (std::size_t brick = begin; brick < end; ++brick) {
      for (std::size_t b = 0; b < pattern_.basis(); ++b) {
        const std::uint64_t here = occupied_[brick * pattern_.basis() + b];
        if (here == 0) continue;
        std::uint64_t inner = ~std::uint64_t{0};
        for (const PatternCorner& c : pattern_.around(b))
          inner &= window(whole_, first_cell_[brick] + c.cell, c.polytope);
        for (std::uint64_t rest = here & ~inner; rest != 0; rest &= rest - 1) {
          const auto local = static_cast<std::size_t>(std::countr_zero(rest));
          part.push_back(atoms_[(brick * cells_per_brick + local) * pattern_.basis() + b]);
        }
      }
    }
  });
  std::vector<Index> result;
  for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
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
        const Cell anchor = cell_of(brick, local);
        for (std::size_t p = 0; p < polytopes.size(); ++p) {
          const std::size_t word = brick * polytopes.size() + p;
          if (((whole_[word] | part_[word]) >> local & 1) == 0) continue;
          const std::uint64_t occupied = find_corners(polytopes[p], anchor, corner.data());
          for (const auto& t : cut_of(static_cast<Index>(p), occupied).tetrahedra) {
            tetrahedra[next++] = {corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]};
          }
        }
      }
    }
  });
}

bool StampedPatch::any_stamped(const LatticeSite& site) const {
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    if (stamped(site.cell + c.cell, c.polytope)) return true;
  }
  return false;
}

std::vector<Triangle> StampedPatch::outside_faces(const LatticeSite& site) const {
  // All that are not known to have a whole polytope on both sides, then without those that are seen from both. Each is
  // kept as the two corners after the atom.
  std::vector<std::uint64_t> seen;
  const Index self = atom(site.cell, site.basis);
  const auto key = [](Index a, Index b) { return std::uint64_t{a} << 32 | b; };
  std::array<Index, pull_polytope_corners> corner;
  for (const PatternCorner& c : pattern_.around(site.basis)) {
    const Cell anchor = site.cell + c.cell;
    const bool is_whole = whole(anchor, c.polytope);
    if (!is_whole && !bit(part_, anchor, c.polytope)) continue;
    const PatternPolytope& polytope = pattern_.polytopes()[c.polytope];
    const PatternCut& cut =
        is_whole ? polytope.whole : cut_of(c.polytope, find_corners(polytope, anchor, corner.data()));
    const auto corner_atom = [&](std::uint8_t n) {
      const SiteOffset& s = polytope.corners[n];
      return atom(anchor + offset_cell(s), s.basis);
    };
    for (std::size_t f = 0; f < cut.faces.size(); ++f) {
      const auto& face = cut.faces[f];
      const std::size_t own = face[0] == c.corner ? 0 : face[1] == c.corner ? 1 : face[2] == c.corner ? 2 : 3;
      if (own == 3) continue;
      if (is_whole) {
        const PatternNeighbour& behind = polytope.neighbours[f];
        if (whole(anchor + behind.cell, behind.polytope)) continue;
      }
      seen.push_back(key(corner_atom(face[(own + 1) % 3]), corner_atom(face[(own + 2) % 3])));
    }
  }
  std::vector<Triangle> outside;
  for (const std::uint64_t k : seen) {
    const std::uint64_t behind = k << 32 | k >> 32;
    bool inside = false;
    for (const std::uint64_t other : seen) inside |= other == behind;
    if (!inside) outside.push_back({self, static_cast<Index>(k >> 32), static_cast<Index>(k & 0xFFFFFFFFU)});
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
