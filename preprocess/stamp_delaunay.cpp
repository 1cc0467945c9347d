#include "preprocess/stamp_delaunay.h"

#include <algorithm>
#include <cmath>

#include "core/circumsphere.h"
#include "core/error.h"
#include "preprocess/remove_slivers.h"
#include "preprocess/stamp_fill.h"
#include "preprocess/stamp_sample.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

// With more of the points open than this, triangulating all of them is faster.
constexpr double most_open = 0.95;
// Where stamped and filled cells do not fit, stamps are taken back, each time further around, while that helps.
constexpr std::size_t most_rounds = 4;
// Where it does not help, atoms are off by about the tolerance. A finer one tells them from those that are not off at
// all, at the price of the slivers that Delaunay's rule makes of them.
constexpr double finer = 1e-2;
constexpr double finest = 1e-12;
constexpr int most_attempts = 3;

std::vector<Tetrahedron> without_stamps(std::span<const Vec3> points, const StampOptions& options, Progress& progress) {
  std::vector<Tetrahedron> tetrahedra = delaunay_cgal(points, progress);
  remove_slivers(tetrahedra, points);
  std::erase_if(tetrahedra, [&](const Tetrahedron& t) {
    return circumsphere(points[t[0]], points[t[1]], points[t[2]], points[t[3]]).radius > options.largest_radius;
  });
  return tetrahedra;
}

enum class Outcome { fits, conflict, too_open };

Outcome stamp_and_fill(std::span<const Vec3> points, const LatticeSites& sites, const StampOptions& options,
                       StampReport& report, std::vector<Tetrahedron>& tetrahedra, Progress& progress) {
  StampedSample sample(points, sites, options, progress);
  progress.update(0.4);
  std::size_t before = points.size();
  for (std::size_t round = 0; round < most_rounds; ++round) {
    const OpenPoints open = sample.open_points(progress);
    progress.update(0.5);
    if (static_cast<double>(open.open.size()) > most_open * static_cast<double>(points.size())) {
      return Outcome::too_open;
    }
    const Filling filling = fill_open(sample, open, progress);
    if (filling.conflict.empty()) {
      progress.update(0.9);
      const std::size_t stamped = sample.stamped(), filled = filling.tetrahedra.size();
      report = {stamped, open.open.size(), filled, open.copies.size(), round, options.tolerance};
      tetrahedra.resize(stamped + filled);
      sample.write(std::span(tetrahedra).first(stamped), progress);
      std::copy(filling.tetrahedra.begin(), filling.tetrahedra.end(),
                tetrahedra.begin() + static_cast<std::ptrdiff_t>(stamped));
      progress.update(1.0);
      return Outcome::fits;
    }
    if (2 * filling.conflict.size() > before) break;
    before = filling.conflict.size();
    sample.unstamp(filling.conflict, static_cast<double>(round) * options.largest_radius);
  }
  return Outcome::conflict;
}

}  // namespace

std::vector<Tetrahedron> stamp_delaunay(std::span<const Vec3> points, const LatticeSites& sites,
                                        const StampOptions& options, StampReport& report, Progress& progress) {
  if (!(options.largest_radius > 0.0) || !std::isfinite(options.largest_radius)) {
    throw UsageError("the largest radius must be a positive length in Å; got " +
                     std::to_string(options.largest_radius));
  }
  if (!(options.tolerance > 0.0 && options.tolerance < 0.01)) {
    throw UsageError("the tolerance of stamping must lie between 0 and 0.01; got " + std::to_string(options.tolerance));
  }
  if (sites.of.size() != points.size()) throw UsageError("stamping needs the site of every point");
  report = {};
  std::vector<Tetrahedron> tetrahedra;
  StampOptions attempt = options;
  for (int n = 0; n < most_attempts && attempt.tolerance >= finest; ++n, attempt.tolerance *= finer) {
    const Outcome outcome = stamp_and_fill(points, sites, attempt, report, tetrahedra, progress);
    if (outcome == Outcome::fits) return tetrahedra;
    if (outcome == Outcome::too_open) break;  // and with a finer tolerance more so
  }
  tetrahedra = without_stamps(points, options, progress);
  report = {0, points.size(), tetrahedra.size(), 0, 0, options.tolerance};
  return tetrahedra;
}

}  // namespace atomesh
