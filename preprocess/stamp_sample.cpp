#include "preprocess/stamp_sample.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t points_per_range = 4096;

}  // namespace

StampedSample::StampedSample(std::span<const Vec3> points, const LatticeSites& sites, const StampOptions& options,
                             Progress& progress)
    : points_(points), sites_(sites), options_(options), in_place_(points.size(), 0) {
  find_direction();
  make_patches(progress);
  keep_clear(progress);
  for (const auto& patch : patches_) {
    if (patch) tetrahedra_ += patch->stamp(options.largest_radius, options.tolerance, progress);
  }
}

// One for the whole sample, so that cells between grains are cut alike from all sides.
void StampedSample::find_direction() {
  std::vector<std::vector<Vec3>> polytopes;
  for (const LatticeTemplate& pattern : sites_.patterns) {
    for (const TemplatePolytope& polytope : pattern.polytopes) {
      polytopes.emplace_back();
      for (const SiteOffset& s : polytope.corners) polytopes.back().push_back(pattern.position(s));
    }
  }
  direction_ =
      sites_.patterns.size() == 1 ? sites_.patterns[0].pulling_direction : find_pulling_direction(polytopes).direction;
}

void StampedSample::make_patches(Progress& progress) {
  const std::size_t count = sites_.patches.size();
  std::vector<PatchPattern> patterns;
  std::vector<double> exact_within;
  for (const LatticePatch& patch : sites_.patches) {
    patterns.emplace_back(sites_.patterns[patch.pattern], patch, direction_);
    const double within = patterns.back().exact(options_.largest_radius, options_.tolerance);
    exact_within.push_back(within > 0.0 ? within : -1.0);
    progress.check();
  }
  std::vector<std::uint8_t> exact(points_.size(), 0);
  parallel_for(points_.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LatticeSite& site = sites_.of[i];
      if (site.patch >= count || !patterns[site.patch].usable()) continue;
      const PatchPattern& pattern = patterns[site.patch];
      const Vec3 off = points_[i] - pattern.position(site.cell, site.basis);
      in_place_[i] = glm::dot(off, off) <= pattern.in_place() * pattern.in_place() ? 1 : 0;
      exact[i] = glm::dot(off, off) <=
                         std::copysign(exact_within[site.patch] * exact_within[site.patch], exact_within[site.patch])
                     ? 1
                     : 0;
    }
  });
  // The atoms in place, patch by patch.
  std::vector<std::size_t> first(count + 1, 0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (in_place_[i] != 0) ++first[sites_.of[i].patch + 1];
  }
  for (std::size_t p = 0; p < count; ++p) first[p + 1] += first[p];
  std::vector<Index> atoms(first[count]);
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (in_place_[i] != 0) atoms[next[sites_.of[i].patch]++] = static_cast<Index>(i);
  }
  progress.check();
  patches_.resize(count);
  std::vector<Index> left_over;
  for (std::size_t p = 0; p < count; ++p) {
    const std::span<const Index> own(atoms.data() + first[p], first[p + 1] - first[p]);
    auto patch = StampedPatch::make(std::move(patterns[p]), own, points_, sites_.of, exact, left_over);
    if (patch) {
      patches_[p] = std::make_unique<StampedPatch>(std::move(*patch));
    } else {
      for (const Index i : own) in_place_[i] = 0;
    }
  }
  for (const Index i : left_over) in_place_[i] = 0;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (in_place_[i] != 0) continue;
    loose_.push_back(static_cast<Index>(i));
    places.push_back(points_[i]);
  }
  double farthest = 2.0 * options_.largest_radius;
  for (const auto& patch : patches_) {
    if (patch) farthest = std::max(farthest, sphere_of_influence(patch->pattern()) + patch->pattern().in_place());
  }
  loose_grid_ = std::make_unique<NeighbourGrid>(places, Box{}, farthest, options_.largest_radius);
}

// From each patch's polytopes, whatever is no atom in place of its own.
void StampedSample::keep_clear(Progress& progress) {
  const auto stamped_patches =
      std::count_if(patches_.begin(), patches_.end(), [](const auto& p) { return p != nullptr; });
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (!patches_[p]) continue;
    const bool alone = stamped_patches == 1;
    parallel_for(alone ? loose_.size() : points_.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t n = begin; n < end; ++n) {
        const std::size_t i = alone ? loose_[n] : n;
        if (in_place_[i] == 0 || sites_.of[i].patch != p) patches_[p]->keep_clear_of(points_[i]);
      }
    });
  }
}

void StampedSample::write(std::span<Tetrahedron> tetrahedra, Progress& progress) const {
  std::size_t first = 0;
  for (const auto& patch : patches_) {
    if (!patch) continue;
    patch->write(tetrahedra.subspan(first, patch->tetrahedra()), progress);
    first += patch->tetrahedra();
  }
}

bool StampedSample::in_one_polytope(const Tetrahedron& tetrahedron) const {
  std::array<LatticeSite, 4> sites;
  for (int i = 0; i < 4; ++i) {
    sites[i] = sites_.of[tetrahedron[i]];
    if (in_place_[tetrahedron[i]] == 0 || sites[i].patch != sites[0].patch) return false;
  }
  return patch(tetrahedron[0])->in_one_polytope(sites);
}

void StampedSample::unstamp(std::span<const Index> points, double radius) {
  std::vector<Index> slots;
  for (auto& patch : patches_) {
    if (!patch) continue;
    std::vector<Index> near;
    for (const Index p : points) {
      patch->each_in_ball(points_[p], radius, [&](Index i) {
        near.push_back(i);
        return true;
      });
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    tetrahedra_ -= patch->tetrahedra();
    for (const Index i : near) patch->unstamp(sites_.of[i]);
    tetrahedra_ += patch->tetrahedra();
  }
}

// Which points can be corners of a cell that is missing, that is a Delaunay cell of radius at most R that is not
// stamped? Call a point *on the edge* when the stamped polytopes around it do not fill its surroundings: a missing cell
// has only such corners. A point v on the edge is *closed*, no corner of a missing cell, when it has stamped polytopes
// and each triangle of theirs at v with nothing stamped behind it is seen from no point on the edge within
// L = max(2R, 4 × largest stamped radius) of v.
//
// Proof. All corners of a missing cell Q at v are on the edge and within 2R of v. Let K be the cone at v spanned by the
// points on the edge within L and the stamped polytopes at v, their union being S; then Q and S lie in K. No corner w
// of S rises above the plane H of such a triangle: if it did and were not on the edge itself, its surroundings would
// be filled, and going from just outside the triangle near v straight to w, one would enter what is stamped through
// some triangle, above H; one of that triangle's corners is above H, on the edge, and within 2 × (2 × radius) of v,
// which was excluded. So every triangle that bounds S at v lies in a plane that supports K: near v, S has no boundary
// inside K and fills it. Q, which lies in K, would overlap S; Delaunay cells do not.
OpenPoints StampedSample::open_points(Progress& progress) const {
  // Patch by patch, and last those in none.
  std::vector<Index> edge;
  std::vector<std::size_t> first;
  for (const auto& patch : patches_) {
    first.push_back(edge.size());
    if (!patch) continue;
    const std::vector<Index> own = patch->edge(progress);
    edge.insert(edge.end(), own.begin(), own.end());
  }
  first.push_back(edge.size());
  edge.insert(edge.end(), loose_.begin(), loose_.end());
  OpenPoints result;
  result.role.assign(points_.size(), OpenPoints::none);
  for (const Index i : edge) result.role[i] = OpenPoints::unique;
  if (options_.copy_fill) find_copies(edge, first, result, progress);

  std::vector<Vec3> places;
  for (const Index i : edge) places.push_back(points_[i]);
  const NeighbourGrid grid(places, Box{}, reach(), 0.5 * reach());
  // Corners of cells at those whose cells are to be found.
  std::vector<std::uint8_t> asked(edge.size(), result.copies.empty() ? 1 : 0);
  if (!result.copies.empty()) {
    const double far = 2.0 * options_.largest_radius * (1.0 + 1e-6);
    parallel_for(edge.size(), points_per_range / 8, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::vector<Index> slots;
      for (std::size_t n = begin; n < end; ++n) {
        if (result.role[edge[n]] == OpenPoints::copy) continue;
        grid.find(points_[edge[n]], far, slots);
        for (const Index slot : slots) {
          std::atomic_ref(asked[grid.point(slot)]).store(1, std::memory_order_relaxed);
        }
      }
    });
  }
  parallel_for(edge.size(), points_per_range / 8, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t n = begin; n < end; ++n) {
      if (asked[n] != 0 && in_place_[edge[n]] != 0 && is_closed(edge[n], grid, slots)) asked[n] = 0;
    }
  });
  for (std::size_t n = 0; n < edge.size(); ++n) {
    if (asked[n] != 0) result.open.push_back(edge[n]);
  }
  std::sort(result.open.begin(), result.open.end());
  return result;
}

double StampedSample::reach() const {
  double largest = 0.0;
  for (const auto& patch : patches_) {
    if (patch) largest = std::max(largest, patch->pattern().largest_void());
  }
  return std::max(2.0, 4.0 * std::min(largest / options_.largest_radius, 1.0)) * options_.largest_radius * 1.01;
}

bool StampedSample::is_closed(Index atom, const NeighbourGrid& edge, std::vector<Index>& slots) const {
  const StampedPatch& own = *patch(atom);
  if (!own.any_stamped(sites_.of[atom])) return false;
  edge.find(points_[atom], reach(), slots);
  // What rises by no more than rounding makes cells without volume, which nobody misses.
  const double off = options_.tolerance * options_.largest_radius;
  return own.each_outside_face(sites_.of[atom], [&](const Triangle& t) {
    const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    return std::none_of(slots.begin(), slots.end(),
                        [&](Index slot) { return glm::dot(edge.position(slot) - a, normal) > off; });
  });
}

}  // namespace atomesh
