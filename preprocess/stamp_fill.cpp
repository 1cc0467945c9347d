#include "preprocess/stamp_fill.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/gather_polytopes.h"
#include "preprocess/pull_polytope.h"
#include "preprocess/stamp_seam.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

constexpr std::size_t copies_per_range = 4096;
// Radii nearer to the largest than this are compared with it tetrahedron by tetrahedron, as carve() does: what
// rounding says of one place need not be what it says of another.
constexpr double same_radius = 1.0 + 1e-9;

Tetrahedron global(const Tetrahedron& t, std::span<const Index> open) {
  return {open[t[0]], open[t[1]], open[t[2]], open[t[3]]};
}

// A tetrahedron that may be missing, and its sphere.
struct Missing {
  Tetrahedron tetrahedron;  // indices into all points
  Sphere sphere;
};

// The open points cut into blocks, so that several threads have something to do and no triangulation spans the hollow
// where everything is stamped. A cell belongs to the block that its centre lies in; its corners are not further than
// the largest radius from there.
class Blocks {
 public:
  Blocks(const StampedSample& sample, std::span<const Index> open) {
    Bounds bounds;
    for (const Index i : open) bounds.add(sample.points()[i]);
    min_ = bounds.min;
    const double halo = sample.options().largest_radius * (1.0 + 1e-6);
    for (int k = 0; k < 3; ++k) {
      const double extent = bounds.extent()[k];
      count_[k] = std::clamp(static_cast<int>(extent / (halos_per_block * halo)), 1, most_blocks);
      edge_[k] = extent > 0.0 ? extent / count_[k] : 1.0;
    }
    members_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
    for (const Index i : open) {
      const std::array<int, 3> low = place(sample.points()[i] - halo), high = place(sample.points()[i] + halo);
      for (int a = low[0]; a <= high[0]; ++a) {
        for (int b = low[1]; b <= high[1]; ++b) {
          for (int c = low[2]; c <= high[2]; ++c) members_[number({a, b, c})].push_back(i);
        }
      }
    }
  }

  std::size_t size() const { return members_.size(); }
  const std::vector<Index>& members(std::size_t block) const { return members_[block]; }  // ascending
  // Places outside the bounds belong to the nearest block.
  std::size_t of(const Vec3& position) const { return number(place(position)); }

 private:
  static constexpr double halos_per_block = 12.0;
  static constexpr int most_blocks = 64;  // along an axis

  std::array<int, 3> place(const Vec3& p) const {
    std::array<int, 3> result;
    for (int k = 0; k < 3; ++k) {
      result[k] = static_cast<int>(std::clamp(std::floor((p[k] - min_[k]) / edge_[k]), 0.0, count_[k] - 1.0));
    }
    return result;
  }
  std::size_t number(const std::array<int, 3>& p) const {
    return (static_cast<std::size_t>(p[0]) * count_[1] + p[1]) * count_[2] + p[2];
  }

  Vec3 min_{0.0}, edge_{1.0};
  std::array<int, 3> count_{1, 1, 1};
  std::vector<std::vector<Index>> members_;
};

// A point moved by far less than the tolerance, always the same way. What shares a sphere is told from the points as
// they are; to the triangulation ties only mean slow arithmetic, and how it would break them does not matter.
Vec3 shaken(const StampedSample& sample, Index i) {
  const double amplitude = 0.01 * sample.options().tolerance * sample.options().largest_radius;
  Vec3 p = sample.points()[i];
  for (int k = 0; k < 3; ++k) {
    std::uint64_t random = (3 * std::uint64_t{i} + static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15U;
    random = (random ^ random >> 30) * 0xBF58476D1CE4E5B9U;  // SplitMix64
    random = (random ^ random >> 27) * 0x94D049BB133111EBU;
    p[k] += amplitude * (static_cast<double>(random >> 11) * 0x1p-52 - 1.0);
  }
  return p;
}

// Of the tetrahedra of a block's points, those that may be missing: of radius up to the largest, empty of all points
// and not stamped. Slivers have no sphere to speak of; the polytopes they are scraps of are known by their other
// pieces.
std::vector<Missing> find_missing(const StampedSample& sample, const Blocks& blocks, std::size_t block,
                                  const Progress& progress) {
  const std::vector<Index>& members = blocks.members(block);
  std::vector<Missing> missing;
  if (members.size() < 4) return missing;
  std::vector<Vec3> places;
  for (const Index i : members) places.push_back(shaken(sample, i));
  // The triangulation is told of a cancel without sharing the caller's listener among threads.
  Progress quiet([&](std::string_view, double) {
    if (progress.cancelled()) throw CancelledError();
  });
  const std::vector<Tetrahedron> tetrahedra = delaunay_cgal(places, quiet);
  const PolytopeTolerance tolerance = tolerance_of(sample);
  std::vector<Index> slots;
  for (std::size_t n = 0; n < tetrahedra.size(); ++n) {
    if (n % 1024 == 0) progress.check();
    // In one order of corners, so that two blocks get one sphere to the last bit and agree whose it is.
    const Tetrahedron t = canonical(global(tetrahedra[n], members));
    const auto corner = [&](int i) -> const Vec3& { return sample.points()[t[i]]; };
    const Sphere sphere = circumsphere(corner(0), corner(1), corner(2), corner(3));
    if (!(sphere.radius <= same_radius * sample.options().largest_radius) || blocks.of(sphere.center) != block)
      continue;
    if (find_slivers({&t, 1}, sample.points(), tolerance)[0] != 0 || sample.in_one_polytope(t)) continue;
    const double inside = sphere.radius * (1.0 - tolerance.sphere);
    // Of the open points none is in it: those are the triangulation's.
    const auto is_open = [&](Index p) { return std::binary_search(members.begin(), members.end(), p); };
    if (sample.each_in_ball(sphere.center, inside, slots, is_open)) missing.push_back({t, sphere});
  }
  return missing;
}

std::vector<Missing> find_missing(const StampedSample& sample, std::span<const Index> open, const Progress& progress) {
  const Blocks blocks(sample, open);
  std::vector<std::vector<Missing>> parts(blocks.size());
  parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) parts[b] = find_missing(sample, blocks, b, progress);
  });
  std::vector<Missing> missing;
  for (auto& part : parts) {
    missing.insert(missing.end(), part.begin(), part.end());
    part = {};
  }
  return missing;
}

// Tetrahedra with one sphere are one polytope, for the sphere is empty: pairs (polytope, tetrahedron), ascending.
std::vector<std::pair<Index, Index>> gather(const std::vector<Missing>& missing, double tolerance, double largest) {
  const double edge = 0.01 * largest;  // of the cells that centres are looked up in
  std::unordered_multimap<std::uint64_t, Index> at;
  std::vector<std::pair<Index, Index>> members;
  std::vector<Index> parent(missing.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  const auto join = [&](Index a, Index b) {
    a = root(a);
    b = root(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (std::size_t n = 0; n < missing.size(); ++n) {
    const Sphere& sphere = missing[n].sphere;
    const double near = tolerance * sphere.radius;
    std::array<std::array<std::int64_t, 2>, 3> cells;
    for (int k = 0; k < 3; ++k) {
      cells[k] = {static_cast<std::int64_t>(std::floor((sphere.center[k] - near) / edge)),
                  static_cast<std::int64_t>(std::floor((sphere.center[k] + near) / edge))};
    }
    const auto key = [](std::int64_t a, std::int64_t b, std::int64_t c) {
      constexpr std::int64_t mask = (1 << 21) - 1;
      return static_cast<std::uint64_t>((a & mask) << 42 | (b & mask) << 21 | (c & mask));
    };
    for (std::int64_t a = cells[0][0]; a <= cells[0][1]; ++a) {
      for (std::int64_t b = cells[1][0]; b <= cells[1][1]; ++b) {
        for (std::int64_t c = cells[2][0]; c <= cells[2][1]; ++c) {
          const auto [begin, end] = at.equal_range(key(a, b, c));
          for (auto other = begin; other != end; ++other) {
            const Sphere& s = missing[other->second].sphere;
            if (glm::distance(s.center, sphere.center) <= near && std::abs(s.radius - sphere.radius) <= near) {
              join(other->second, static_cast<Index>(n));
            }
          }
        }
      }
    }
    const auto cell = [&](int k) { return static_cast<std::int64_t>(std::floor(sphere.center[k] / edge)); };
    at.emplace(key(cell(0), cell(1), cell(2)), static_cast<Index>(n));
  }
  for (std::size_t n = 0; n < missing.size(); ++n) {
    members.emplace_back(root(static_cast<Index>(n)), static_cast<Index>(n));
  }
  std::sort(members.begin(), members.end());
  return members;
}

// A missing cell and what it is cut into.
struct Polytope {
  std::vector<Index> corners;  // ascending
  double radius = 0.0;
  std::vector<Tetrahedron> tetrahedra;
  bool same_anywhere = true;  // no two corners stand so nearly equally high that rounding decides how it is cut
};

// False for corners that span no volume.
bool cut(const StampedSample& sample, Polytope& polytope) {
  const std::size_t count = polytope.corners.size();
  std::vector<Vec3> places;
  std::vector<std::pair<double, Index>> heights;
  std::vector<Index> local(count), rank(count);
  for (std::size_t c = 0; c < count; ++c) {
    places.push_back(sample.points()[polytope.corners[c]]);
    heights.emplace_back(glm::dot(places[c], sample.direction()), static_cast<Index>(c));
    local[c] = static_cast<Index>(c);
  }
  std::sort(heights.begin(), heights.end());
  const double clear = 4.0 * sample.options().tolerance * sample.options().largest_radius;
  for (std::size_t c = 0; c < count; ++c) {
    rank[heights[c].second] = static_cast<Index>(c);
    if (c > 0 && heights[c].first - heights[c - 1].first < clear) polytope.same_anywhere = false;
  }
  polytope.tetrahedra.clear();
  if (!pull_polytope(local, places, rank, sample.options().tolerance * polytope.radius, polytope.tetrahedra))
    return false;
  for (Tetrahedron& t : polytope.tetrahedra) {
    for (Index& v : t) v = polytope.corners[v];
  }
  return true;
}

// Polytopes that cannot be cut are in conflict with whatever is around them.
std::vector<Polytope> find_polytopes(const StampedSample& sample, std::span<const Index> open,
                                     std::vector<Index>& conflict, Progress& progress) {
  const std::vector<Missing> missing = find_missing(sample, open, progress);
  const auto members = gather(missing, tolerance_of(sample).sphere, sample.options().largest_radius);
  progress.check();
  std::vector<Polytope> polytopes;
  for (std::size_t i = 0; i < members.size();) {
    Polytope polytope;
    polytope.radius = missing[members[i].second].sphere.radius;
    const std::size_t first = i;
    for (; i < members.size() && members[i].first == members[first].first; ++i) {
      const Tetrahedron& t = missing[members[i].second].tetrahedron;
      polytope.corners.insert(polytope.corners.end(), t.begin(), t.end());
    }
    std::sort(polytope.corners.begin(), polytope.corners.end());
    polytope.corners.erase(std::unique(polytope.corners.begin(), polytope.corners.end()), polytope.corners.end());
    if (i - first == 1) {
      polytope.tetrahedra = {missing[members[first].second].tetrahedron};
    } else if (!cut(sample, polytope)) {
      conflict.insert(conflict.end(), polytope.corners.begin(), polytope.corners.end());
      continue;
    }
    polytopes.push_back(std::move(polytope));
  }
  return polytopes;
}

// Appends the tetrahedra of a polytope, without those that are too large.
void add(const StampedSample& sample, double radius, std::span<const Tetrahedron> of, std::vector<Tetrahedron>& to) {
  const double largest = sample.options().largest_radius;
  for (const Tetrahedron& t : of) {
    if (radius * same_radius > largest) {
      const auto& [a, b, c, d] = canonical(t);
      const auto points = sample.points();
      if (!(circumsphere(points[a], points[b], points[c], points[d]).radius <= largest)) continue;
    }
    to.push_back(t);
  }
}

// The polytope at `from`, moved to `to`, when `to` is its lowest corner there. False when an atom is not where it
// should be.
bool copy(const StampedSample& sample, const Polytope& polytope, Index from, Index to, Polytope& moved,
          std::vector<Tetrahedron>& tetrahedra) {
  const LatticeSite &a = sample.site(from), &b = sample.site(to);
  const Cell by{b.cell[0] - a.cell[0], b.cell[1] - a.cell[1], b.cell[2] - a.cell[2]};
  const StampedPatch& patch = *sample.patch_of(to);
  moved.corners.clear();
  for (const Index v : polytope.corners) {
    const Index w = v == from ? to : patch.atom(sample.site(v).cell + by, sample.site(v).basis);
    if (w == no_index) return false;
    if (w < to) return true;
    moved.corners.push_back(w);
  }
  if (polytope.same_anywhere) {
    moved.tetrahedra = polytope.tetrahedra;
    for (Tetrahedron& t : moved.tetrahedra) {
      for (Index& v : t) {
        const auto corner = std::lower_bound(polytope.corners.begin(), polytope.corners.end(), v);
        v = moved.corners[static_cast<std::size_t>(corner - polytope.corners.begin())];
      }
    }
    add(sample, polytope.radius, moved.tetrahedra, tetrahedra);
    return true;
  }
  std::sort(moved.corners.begin(), moved.corners.end());
  moved.radius = polytope.radius;
  if (!cut(sample, moved)) return false;
  add(sample, moved.radius, moved.tetrahedra, tetrahedra);
  return true;
}

// Each polytope comes from its lowest corner: found there, or copied from that one's model.
std::vector<Tetrahedron> spread(const StampedSample& sample, const OpenPoints& points,
                                const std::vector<Polytope>& polytopes, std::vector<Index>& conflict,
                                Progress& progress) {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::pair<Index, Index>> at_models;  // (model, polytope)
  for (std::size_t n = 0; n < polytopes.size(); ++n) {
    const Polytope& polytope = polytopes[n];
    const auto role = points.role[polytope.corners[0]];
    if (role == OpenPoints::unique || role == OpenPoints::model) {
      add(sample, polytope.radius, polytope.tetrahedra, tetrahedra);
    }
    for (const Index v : polytope.corners) {
      if (points.role[v] == OpenPoints::model) at_models.emplace_back(v, static_cast<Index>(n));
    }
  }
  std::sort(at_models.begin(), at_models.end());
  struct Part {
    std::vector<Tetrahedron> tetrahedra;
    std::vector<Index> conflict;
  };
  const auto& copies = points.copies;
  std::vector<Part> parts((copies.size() + copies_per_range - 1) / copies_per_range);
  parallel_for(copies.size(), copies_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Part& part = parts[begin / copies_per_range];
    Polytope moved;
    for (std::size_t n = begin; n < end; ++n) {
      const auto [model, to] = copies[n];
      auto at = std::lower_bound(at_models.begin(), at_models.end(), std::pair<Index, Index>{model, 0});
      for (; at != at_models.end() && at->first == model; ++at) {
        if (!copy(sample, polytopes[at->second], model, to, moved, part.tetrahedra)) part.conflict.push_back(to);
      }
    }
  });
  for (const Part& part : parts) {
    tetrahedra.insert(tetrahedra.end(), part.tetrahedra.begin(), part.tetrahedra.end());
    conflict.insert(conflict.end(), part.conflict.begin(), part.conflict.end());
  }
  return tetrahedra;
}

}  // namespace

Filling fill_open(const StampedSample& sample, const OpenPoints& points, Progress& progress) {
  Filling filling;
  const std::vector<Polytope> polytopes = find_polytopes(sample, points.open, filling.conflict, progress);
  filling.tetrahedra = spread(sample, points, polytopes, filling.conflict, progress);
  const std::vector<Index> seam = seam_conflicts(sample, points, filling.tetrahedra, progress);
  filling.conflict.insert(filling.conflict.end(), seam.begin(), seam.end());
  std::sort(filling.conflict.begin(), filling.conflict.end());
  filling.conflict.erase(std::unique(filling.conflict.begin(), filling.conflict.end()), filling.conflict.end());
  return filling;
}

}  // namespace atomesh
