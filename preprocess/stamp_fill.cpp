#include "preprocess/stamp_fill.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_map>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/tet_mesh.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/gather_polytopes.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

constexpr std::size_t items_per_range = 512;

PolytopeTolerance tolerance_of(const StampedSample& sample) {
  return {0.2 * sample.options().tolerance, sample.options().tolerance};
}

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
    if (!(sphere.radius <= sample.options().largest_radius) || blocks.of(sphere.center) != block) continue;
    if (find_slivers({&t, 1}, sample.points(), tolerance)[0] != 0 || sample.in_one_polytope(t)) continue;
    const double inside = sphere.radius * (1.0 - tolerance.sphere);
    if (sample.each_in_ball(sphere.center, inside, slots, [](Index) { return false; })) missing.push_back({t, sphere});
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
  std::unordered_multimap<std::uint64_t, Index> first_of;
  std::vector<std::pair<Index, Index>> members;
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
    Index polytope = static_cast<Index>(n);
    for (std::int64_t a = cells[0][0]; a <= cells[0][1]; ++a) {
      for (std::int64_t b = cells[1][0]; b <= cells[1][1]; ++b) {
        for (std::int64_t c = cells[2][0]; c <= cells[2][1]; ++c) {
          const auto [begin, end] = first_of.equal_range(key(a, b, c));
          for (auto other = begin; other != end; ++other) {
            const Sphere& s = missing[other->second].sphere;
            if (glm::distance(s.center, sphere.center) <= near && std::abs(s.radius - sphere.radius) <= near) {
              polytope = std::min(polytope, other->second);
            }
          }
        }
      }
    }
    if (polytope == n) {
      const auto cell = [&](int k) { return static_cast<std::int64_t>(std::floor(sphere.center[k] / edge)); };
      first_of.emplace(key(cell(0), cell(1), cell(2)), polytope);
    }
    members.emplace_back(polytope, static_cast<Index>(n));
  }
  std::sort(members.begin(), members.end());
  return members;
}

std::vector<Index> ranks_by_height(std::span<const Vec3> points, const Vec3& direction) {
  std::vector<std::pair<double, Index>> heights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    heights.emplace_back(glm::dot(points[i], direction), static_cast<Index>(i));
  }
  std::sort(heights.begin(), heights.end());
  std::vector<Index> rank(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) rank[heights[i].second] = static_cast<Index>(i);
  return rank;
}

// A triangle rotated so that its smallest corner is first: two that look the same way are equal.
Triangle rotated(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

Triangle reversed(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

// Stamped triangles with nothing stamped behind and all corners open, ascending. Those with a closed corner have
// nothing missing behind them.
std::vector<Triangle> stamped_seam(const StampedSample& sample, const LatticeSites& sites,
                                   std::span<const Index> open) {
  std::vector<std::vector<Triangle>> parts((open.size() + items_per_range - 1) / items_per_range);
  const auto is_open = [&](Index v) { return std::binary_search(open.begin(), open.end(), v); };
  parallel_for(open.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    std::vector<Triangle>& part = parts[begin / items_per_range];
    for (std::size_t n = begin; n < end; ++n) {
      const Index v = open[n];
      const StampedPatch* patch = sample.patch_of(v);
      if (patch == nullptr) continue;
      patch->each_outside_face(sites.of[v], [&](const Triangle& t) {
        if (*std::min_element(t.begin(), t.end()) == v && is_open(t[0]) && is_open(t[1]) && is_open(t[2])) {
          part.push_back(rotated(t));
        }
        return true;
      });
    }
  });
  std::vector<Triangle> seam;
  for (const auto& part : parts) seam.insert(seam.end(), part.begin(), part.end());
  std::sort(seam.begin(), seam.end());
  return seam;
}

// Whether a cell of at most the largest radius should lie behind a triangle, on the side its normal points to. Of the
// spheres through the triangle's corners, what lies on that side in a smaller one lies in a larger one too, as long as
// the centre moves to that side: it is enough to look into the largest.
bool misses_cell(const StampedSample& sample, const Triangle& t, std::vector<Index>& slots) {
  const auto points = sample.points();
  const double largest = sample.options().largest_radius;
  const Vec3 &a = points[t[0]], u = points[t[1]] - a, v = points[t[2]] - a;
  const Vec3 normal = glm::cross(u, v);
  const double area2 = glm::dot(normal, normal);
  const Vec3 center = a + glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) * (0.5 / area2);
  const double radius2 = glm::dot(center - a, center - a);
  const double height = std::sqrt(std::max(largest * largest - radius2, 0.0)) * (1.0 - 1e-6);
  const Vec3 up = normal / std::sqrt(area2);
  const double flat = 10.0 * tolerance_of(sample).sphere * largest;
  return !sample.each_in_ball(center + height * up, std::sqrt(radius2 + height * height), slots,
                              [&](Index p) { return glm::dot(points[p] - a, up) <= flat; });
}

// Whether filled and stamped cells meet without gap or overlap: no triangle is seen twice from one side, and behind
// each that is seen from one side only there is no cell to miss.
bool fits(const StampedSample& sample, const std::vector<Triangle>& seam, const std::vector<Tetrahedron>& filled,
          const std::vector<std::array<Index, 4>>& neighbours, Progress& progress) {
  std::vector<std::uint8_t> met(seam.size(), 0);
  std::vector<Triangle> alone;
  const auto find = [&](const Triangle& t) {
    const auto found = std::lower_bound(seam.begin(), seam.end(), t);
    return found != seam.end() && *found == t ? static_cast<std::size_t>(found - seam.begin()) : seam.size();
  };
  for (std::size_t n = 0; n < filled.size(); ++n) {
    for (int f = 0; f < 4; ++f) {
      const auto& c = face_corners[f];
      const Triangle t = rotated({filled[n][c[0]], filled[n][c[1]], filled[n][c[2]]});
      if (find(t) != seam.size()) return false;
      const std::size_t behind = find(reversed(t));
      if (behind != seam.size()) {
        if (neighbours[n][f] != no_index) return false;
        met[behind] = 1;
      } else if (neighbours[n][f] == no_index) {
        alone.push_back(t);
      }
    }
  }
  for (std::size_t s = 0; s < seam.size(); ++s) {
    if (met[s] == 0) alone.push_back(seam[s]);
  }
  std::atomic<bool> whole{true};
  parallel_for(alone.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t n = begin; n < end && whole; ++n) {
      if (misses_cell(sample, alone[n], slots)) whole = false;
    }
  });
  return whole;
}

}  // namespace

std::optional<std::vector<Tetrahedron>> fill_open(const StampedSample& sample, const LatticeSites& sites,
                                                  std::span<const Index> open, Progress& progress) {
  const PolytopeTolerance tolerance = tolerance_of(sample);
  const std::vector<Missing> missing = find_missing(sample, open, progress);
  const auto members = gather(missing, tolerance.sphere, sample.options().largest_radius);
  progress.check();

  // From here in the numbers of the open points alone.
  TetMesh mesh;
  for (const Index i : open) mesh.vertices.push_back(sample.points()[i]);
  std::vector<Tetrahedron> pieces;
  for (const Missing& m : missing) {
    Tetrahedron local;
    for (int i = 0; i < 4; ++i) {
      local[i] = static_cast<Index>(std::lower_bound(open.begin(), open.end(), m.tetrahedron[i]) - open.begin());
    }
    pieces.push_back(local);
  }
  const std::vector<Index> rank = ranks_by_height(mesh.vertices, sample.direction());
  if (!cut_polytopes(pieces, mesh.vertices, members, rank, tolerance, mesh.tetrahedra)) return std::nullopt;
  progress.check();
  std::vector<std::array<Index, 4>> neighbours;
  try {
    neighbours = face_neighbours(mesh);
  } catch (const Error&) {
    return std::nullopt;  // a face of three
  }
  std::vector<Tetrahedron> filled = std::move(mesh.tetrahedra);
  for (Tetrahedron& t : filled) t = global(t, open);
  if (!fits(sample, stamped_seam(sample, sites, open), filled, neighbours, progress)) return std::nullopt;
  return filled;
}

}  // namespace atomesh
