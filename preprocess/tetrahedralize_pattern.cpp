#include "preprocess/tetrahedralize_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/file_rounding.h"
#include "preprocess/insert_points.h"
#include "preprocess/mend_tetrahedra.h"
#include "preprocess/neighbour_grid.h"
#include "preprocess/pattern_radius.h"
#include "preprocess/rigid_parts.h"
#include "preprocess/stamp_delaunay.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

constexpr std::size_t items_per_range = 1 << 14;
// The tolerant way leaves what is a little too large to carve(), which looks at the tetrahedra as they are.
constexpr double tolerant_margin = 1.25;
// Share of the tetrahedra that may have to be mended.
constexpr double most_bad = 0.01;
constexpr double same_radius = 1e-9;
// Tetrahedra around an atom on no site have a vertex within this many times the crystal's largest void.
constexpr double insert_reach = 1.6;
// More atoms outside the mesh than this are not looked at one by one.
constexpr std::size_t most_bare = 20'000;
// Share of the atoms that a Delaunay mesh would hold and this one need not: atoms on the surface of which the sites
// around lie in one plane or on one sphere with theirs, so that only noise gives them a tetrahedron.
constexpr double most_missing = 1e-3;

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

// Whether the circumsphere is smaller, told without a division where that is beyond doubt.
bool is_smaller(const Tetrahedron& t, std::span<const Vec3> p, double radius) {
  const Vec3 u = p[t[0]] - p[t[3]];
  const Vec3 v = p[t[1]] - p[t[3]];
  const Vec3 w = p[t[2]] - p[t[3]];
  const Vec3 vw = glm::cross(v, w);
  const double twice = 2.0 * glm::dot(u, vw);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), ww = glm::dot(w, w);
  const Vec3 offset = uu * vw + vv * glm::cross(w, u) + ww * glm::cross(u, v);
  constexpr double thin = 1e-3, margin = 0.99;
  if (twice * twice > thin * thin * uu * vv * ww &&
      glm::dot(offset, offset) < margin * radius * radius * twice * twice) {
    return true;
  }
  return circumsphere(p[t[0]], p[t[1]], p[t[2]], p[t[3]]).radius <= radius;
}

void drop_larger(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> p, double radius, Progress& progress) {
  std::vector<std::uint8_t> keep(tetrahedra.size());
  parallel_for(tetrahedra.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t n = begin; n < end; ++n) {
      keep[n] = is_smaller(tetrahedra[n], p, radius) ? 1 : 0;
    }
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < tetrahedra.size(); ++n) {
    if (keep[n] != 0) tetrahedra[kept++] = tetrahedra[n];
  }
  tetrahedra.resize(kept);
}

void note(const StampReport& stamp, PatternReport& report) {
  report.stamped = stamp.stamped;
  report.filled = stamp.filled;
  report.open_atoms = stamp.open_atoms;
}

// False where the radius at which carve() would carve cannot be told without the tetrahedra above it.
bool settle_radius(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points, const LatticeSites& sites,
                   double tolerance, PatternReport& report, Progress& progress) {
  for (int round = 0; round < 3; ++round) {
    const RadiusBounds bounds = enclose_radius(tetrahedra, points, progress);
    if (bounds.largest > (1.0 + same_radius) * report.largest_radius) {
      report.largest_radius = bounds.largest;
      StampReport stamp;
      tetrahedra = stamp_delaunay(points, sites, {report.largest_radius, tolerance}, stamp, progress);
      note(stamp, report);
      continue;
    }
    if (bounds.between > 0) return false;
    if (bounds.least < (1.0 - same_radius) * report.largest_radius) {
      report.largest_radius = bounds.least;
      drop_larger(tetrahedra, points, bounds.least, progress);
    }
    return true;
  }
  return false;
}

std::vector<Tetrahedron> mesh_exactly(std::span<const Vec3> points, const LatticeSites& sites,
                                      const PatternOptions& options, double tolerance, PatternReport& report,
                                      Progress& progress) {
  const LatticePatch& main = sites.patches[0];
  const PatternRadius radius = pattern_radius(sites.patterns[main.pattern], main.matrix);
  report.largest_radius = options.largest_radius > 0.0 ? options.largest_radius : radius.radius;
  StampReport stamp;
  std::vector<Tetrahedron> tetrahedra =
      stamp_delaunay(points, sites, {report.largest_radius, tolerance}, stamp, progress);
  note(stamp, report);
  // A quarter of the atoms decides; those that are not open have the crystal's own void around them.
  const bool certain = radius.certain && sites.patterns.size() == 1 && 4 * stamp.open_atoms < points.size();
  if (options.largest_radius == 0.0 && !certain &&
      !settle_radius(tetrahedra, points, sites, tolerance, report, progress)) {
    report.why = fmt::format(
        "{} of the atoms are on their sites to rounding, but so many are on the surface that the radius of carving "
        "depends on tetrahedra that the pattern would leave out",
        percent(report.in_place));
    return {};
  }
  report.done = true;
  report.delaunay = stamp.tolerance <= StampOptions{}.tolerance;
  if (!report.delaunay) {
    report.why = fmt::format(
        "the coordinates are those of a crystal rounded to {:g} Å: {} of {} tetrahedra are the crystal's own, and the "
        "mesh is Delaunay but for the rounding",
        report.rounding, stamp.stamped, stamp.stamped + stamp.filled);
    return tetrahedra;
  }
  report.why =
      fmt::format("{} of the atoms are on their sites to rounding{}: {} of {} tetrahedra are the crystal's own",
                  percent(report.in_place), report.parts > 1 ? fmt::format(" in {} rigid parts", report.parts) : "",
                  stamp.stamped, stamp.stamped + stamp.filled);
  return tetrahedra;
}

// The one crystal that the tolerant way meshes: which points are on its sites, and where those are.
struct IdealCrystal {
  LatticeSites sites;
  std::vector<Index> point;  // of each site taken; empty: all points, in their order
  std::vector<Vec3> places;
  std::vector<Index> off;  // points on none
};

IdealCrystal idealize(LatticeSites sites) {
  IdealCrystal ideal;
  const std::size_t count = sites.of.size();
  const std::uint16_t pattern = sites.patches[0].pattern;
  for (std::size_t i = 0; i < count; ++i) {
    if (sites.of[i].patch != 0) ideal.off.push_back(static_cast<Index>(i));
  }
  if (!ideal.off.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      if (sites.of[i].patch != 0) continue;
      sites.of[ideal.point.size()] = sites.of[i];
      ideal.point.push_back(static_cast<Index>(i));
    }
    sites.of.resize(ideal.point.size());
  }
  sites.patterns = {std::move(sites.patterns[pattern])};
  sites.patches.resize(1);
  const UnitCell& cell = sites.patterns[0].cell;
  const Mat3 matrix = cell.matrix();
  LatticePatch& patch = sites.patches[0];
  patch.pattern = 0;
  patch.matrix = matrix;
  patch.origin = Vec3(0.0);
  ideal.places.resize(sites.of.size());
  parallel_for(sites.of.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [c, basis, p] = sites.of[i];
      ideal.places[i] = matrix * Vec3(c[0], c[1], c[2]) + cell.basis[basis].position;
    }
  });
  ideal.sites = std::move(sites);
  return ideal;
}

// Whether a Delaunay mesh carved at this radius has a tetrahedron at each of these points: spheres no larger than the
// radius reach no further than its double, so the points that near are all that matter.
std::size_t count_meshed(std::span<const Vec3> points, std::span<const Index> asked, double radius,
                         Progress& progress) {
  if (asked.empty()) return 0;
  std::vector<Vec3> places;
  for (const Index i : asked) places.push_back(points[i]);
  const NeighbourGrid grid(places, Box{}, 2.0 * radius, 2.0 * radius);
  std::vector<std::vector<Vec3>> around(asked.size());
  for (std::size_t n = 0; n < asked.size(); ++n) around[n].push_back(places[n]);
  std::vector<Index> slots;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % items_per_range == 0) progress.check();
    grid.find(points[i], 2.0 * radius, slots);
    for (const Index slot : slots) {
      const Index n = grid.point(slot);
      if (asked[n] != i) around[n].push_back(points[i]);
    }
  }
  std::size_t meshed = 0;
  for (const std::vector<Vec3>& near : around) {
    bool found = false;
    if (near.size() >= 4) {
      for (const Tetrahedron& t : delaunay_cgal(near, progress)) {
        if (std::find(t.begin(), t.end(), Index{0}) == t.end()) continue;
        found = found || circumsphere(near[t[0]], near[t[1]], near[t[2]], near[t[3]]).radius <= radius;
      }
    }
    meshed += found ? 1 : 0;
  }
  return meshed;
}

std::vector<Index> bare_points(std::span<const Tetrahedron> tetrahedra, std::size_t count) {
  std::vector<bool> used(count, false);
  for (const Tetrahedron& t : tetrahedra) {
    for (const Index v : t) used[v] = true;
  }
  std::vector<Index> bare;
  for (std::size_t i = 0; i < count; ++i) {
    if (!used[i]) bare.push_back(static_cast<Index>(i));
  }
  return bare;
}

std::vector<Tetrahedron> mesh_tolerantly(std::span<const Vec3> points, LatticeSites sites,
                                         const PatternOptions& options, PatternReport& report, Progress& progress) {
  const LatticePatch main = sites.patches[0];
  const double automatic = pattern_radius(sites.patterns[main.pattern], main.matrix).radius;
  const bool given = options.largest_radius > 0.0;
  const double radius = given ? options.largest_radius : automatic;
  report.largest_radius = given ? radius : tolerant_margin * radius;
  const double deepest = sites.patterns[main.pattern].largest_void;

  IdealCrystal ideal = idealize(std::move(sites));
  report.off_sites = ideal.off.size();
  StampReport stamp;
  std::vector<Tetrahedron> tetrahedra =
      stamp_delaunay(ideal.places, ideal.sites, {tolerant_margin * radius}, stamp, progress);
  note(stamp, report);
  for (Tetrahedron& t : tetrahedra) {
    for (Index& v : t) v = ideal.point.empty() ? v : ideal.point[v];
  }
  std::vector<Index> off = std::move(ideal.off);
  ideal = {};

  const auto most = static_cast<std::size_t>(most_bad * static_cast<double>(tetrahedra.size())) + 100;
  MendReport mend;
  const bool mended = mend_tetrahedra(tetrahedra, points, most, mend, progress);
  report.mended = mend.removed + mend.replaced;
  if (!mended) {
    report.why = fmt::format(
        "atoms are too far from the sites of one crystal: {} of {} tetrahedra of its pattern would be inverted, and "
        "{} could not be mended",
        mend.bad, stamp.stamped + stamp.filled, mend.bad - report.mended);
    return {};
  }
  off.insert(off.end(), mend.lost.begin(), mend.lost.end());
  std::sort(off.begin(), off.end());
  const std::vector<Index> outside = insert_points(tetrahedra, points, off, insert_reach * deepest, progress);
  report.inserted = off.size() - outside.size();
  drop_larger(tetrahedra, points, report.largest_radius, progress);

  const std::vector<Index> bare = bare_points(tetrahedra, points.size());
  report.bare = bare.size();
  report.missing = bare.size() > most_bare ? bare.size() : count_meshed(points, bare, radius, progress);
  if (static_cast<double>(report.missing) > most_missing * static_cast<double>(points.size())) {
    report.why = fmt::format("{} atoms lie outside the tetrahedra of the crystal that a Delaunay mesh would hold",
                             report.missing);
    return {};
  }
  report.done = true;
  report.why = fmt::format(
      "the atoms number the sites of one crystal ({} of them on none, {:.2g} Å rms from the sites overall): its "
      "tetrahedra were taken from the perfect crystal and {} of {} mended",
      report.off_sites, main.rms, report.mended, stamp.stamped + stamp.filled);
  if (report.missing > 0) {
    report.why += fmt::format("; {} atoms on the surface that slivers would hold have none", report.missing);
  }
  return tetrahedra;
}

std::size_t tetrahedra_per_cell(const LatticeTemplate& pattern) {
  std::size_t count = 0;
  for (const TemplatePolytope& polytope : pattern.polytopes) count += polytope.tetrahedra.size();
  return count;
}

// Whether the rigid parts, with their atoms where they really are, need more tetrahedra than the crystal does: rounding
// has taken corners of polytopes off their spheres.
bool cuts_finer(const LatticeSites& parts, const LatticeSites& whole) {
  std::size_t most = 0;
  for (const LatticeTemplate& pattern : whole.patterns) most = std::max(most, tetrahedra_per_cell(pattern));
  return std::any_of(parts.patterns.begin(), parts.patterns.end(),
                     [&](const LatticeTemplate& pattern) { return tetrahedra_per_cell(pattern) > most; });
}

// Why the tolerant way cannot be taken, or nothing.
std::string objection(std::size_t points, const LatticeSites& sites, const PatternOptions& options) {
  const LatticePatch& main = sites.patches[0];
  const double off = 1.0 - static_cast<double>(main.atoms) / static_cast<double>(points);
  if (off > options.most_off_sites) {
    const std::size_t others = sites.patches.size() - 1;
    return fmt::format("{} of the atoms are on no site of the one crystal that most of them number{}", percent(off),
                       others > 0 ? fmt::format(" ({} other grains or slid parts)", others) : "");
  }
  if (main.seams > 0) {
    return fmt::format("the crystal's sites do not close on themselves, at {} places (a dislocation)", main.seams);
  }
  return {};
}

}  // namespace

std::vector<Tetrahedron> tetrahedralize_pattern(std::span<const Vec3> points, LatticeSites sites,
                                                const PatternOptions& options, PatternReport& report,
                                                Progress& progress) {
  if (sites.of.size() != points.size()) throw UsageError("meshing by pattern needs the site of every point");
  report = {};
  if (sites.patches.empty()) {
    report.why = "no atoms on the sites of a crystal were found";
    return {};
  }
  if (!std::isfinite(options.largest_radius)) {
    report.why = "nothing is to be carved, and the pattern fills only what would not be";
    return {};
  }
  for (const LatticePatch& patch : sites.patches) {
    if (!sites.patterns[patch.pattern].polytopes.empty()) continue;
    report.why = "the unit cell has no pattern of tetrahedra that could be stamped";
    return {};
  }
  const RigidParts parts = find_rigid_parts(points, sites, progress);
  report.in_place = parts.in_place;
  report.undisturbed = parts.undisturbed;
  report.parts = parts.parts;
  const std::string why_not = objection(points.size(), sites, options);
  const double enough = why_not.empty() ? options.least_undisturbed : options.least_undisturbed_alone;
  report.rounding = find_rounding(points);
  const double tolerance = tolerance_of_rounding(points, sites, report.rounding, options.least_in_place, progress);
  if (parts.in_place >= options.least_in_place || parts.undisturbed >= enough) {
    LatticeSites split = sites;
    split_into_rigid_parts(points, parts, split);
    if (tolerance == 0.0 || (parts.in_place >= options.least_in_place && !cuts_finer(split, sites))) {
      sites = {};
      return mesh_exactly(points, split, options, StampOptions{}.tolerance, report, progress);
    }
  }
  if (tolerance > 0.0 && !why_not.empty()) return mesh_exactly(points, sites, options, tolerance, report, progress);
  if (!why_not.empty()) {
    report.why =
        fmt::format("only {} of the atoms are on their sites to rounding, and {}", percent(parts.in_place), why_not);
    return {};
  }
  return mesh_tolerantly(points, std::move(sites), options, report, progress);
}

}  // namespace atomesh
