// The only file that includes TetGen.
#include "core/error.h"
#include "preprocess/tetrahedralize.h"

#ifdef ATOMESH_TETGEN
#define TETLIBRARY
#include <tetgen.h>

#include <algorithm>
#include <new>

#include "core/predicates.h"
#include "preprocess/memory_needs.h"
#include "preprocess/remove_flat.h"
#endif

namespace atomesh {

#ifdef ATOMESH_TETGEN

namespace {

// Four points that span space, exactly; false when all lie in one plane.
bool span_space(std::span<const Vec3> points) {
  const auto differs = [&](const Vec3& p) { return p != points[0]; };
  const auto second = std::find_if(points.begin(), points.end(), differs);
  if (second == points.end()) return false;
  // Three points are on a line exactly when they are in one plane with every fourth point.
  const auto collinear = [&](const Vec3& p) {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      if (orientation(points[0], *second, p, points[0] + axis) != 0) return false;
    }
    return true;
  };
  const auto third = std::find_if_not(second, points.end(), collinear);
  if (third == points.end()) return false;
  return std::any_of(third, points.end(),
                     [&](const Vec3& p) { return orientation(points[0], *second, *third, p) != 0; });
}

// TetGen compares lengths with 1e-8 of the largest; of points that are flatter it makes nothing, or crashes.
bool too_flat(std::span<const Vec3> points) {
  constexpr double flat = 1e-7;
  const auto farthest = [&](auto&& distance) {
    const Vec3* best = &points[0];
    double most = distance(points[0]);
    for (const Vec3& p : points) {
      const double d = distance(p);
      if (d > most) {
        most = d;
        best = &p;
      }
    }
    return std::pair(*best - points[0], most);
  };
  const auto [along, length] = farthest([&](const Vec3& p) { return glm::distance(p, points[0]); });
  const Vec3 axis = along / length;
  const auto [across, width] = farthest([&](const Vec3& p) { return glm::length(glm::cross(axis, p - points[0])); });
  if (!(width > flat * length)) return true;
  const Vec3 normal = glm::normalize(glm::cross(axis, across));
  const auto [up, height] = farthest([&](const Vec3& p) { return std::abs(glm::dot(normal, p - points[0])); });
  return !(height > flat * length);
}

}  // namespace

std::vector<Tetrahedron> delaunay_tetgen(std::span<const Vec3> points, TetrahedralizeReport& report,
                                         Progress& progress) {
  std::vector<Tetrahedron> tetrahedra;
  if (points.size() < 4 || !span_space(points)) return tetrahedra;
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 8)) {
    throw Error("TetGen counts in 31 bits: too many atoms for it; use --mesher delaunay");
  }
  if (too_flat(points)) {
    report.why += "; the atoms are too nearly in one plane for TetGen, so the mesh is CGAL's";
    return delaunay_cgal(points, progress);
  }
  progress.check();
  require_memory_for("tetrahedralization by TetGen", points.size(), "points", memory_to_mesh("tetgen", points.size()));

  tetgenio input;
  tetgenio output;
  input.numberofpoints = static_cast<int>(points.size());
  input.pointlist = new double[3 * points.size()];  // freed by tetgenio
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) input.pointlist[3 * i + axis] = points[i][axis];
  }
  try {
    // Quiet, keep every point's index.
    std::string switches = "QJ";
    ::tetrahedralize(switches.data(), &input, &output);
  } catch (const int code) {
    if (code == 1) throw std::bad_alloc();
    throw Error("TetGen gave up (its code " + std::to_string(code) + "); use --mesher delaunay");
  }
  progress.check();

  const auto count = static_cast<std::size_t>(output.numberoftetrahedra);
  tetrahedra.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    Tetrahedron& tet = tetrahedra[t];
    for (int k = 0; k < 4; ++k) tet[k] = static_cast<Index>(output.tetrahedronlist[4 * t + k]);
    if (orientation(points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]]) < 0) std::swap(tet[2], tet[3]);
  }
  report.flat_removed = remove_flat_outside(tetrahedra, points);
  if (count_flat(tetrahedra, points) > 0) {
    // Dropping one of these would tear its neighbours apart.
    report.why += "; TetGen left flat tetrahedra inside the mesh, so the mesh is CGAL's";
    return delaunay_cgal(points, progress);
  }
  return tetrahedra;
}

#else

std::vector<Tetrahedron> delaunay_tetgen(std::span<const Vec3>, TetrahedralizeReport&, Progress&) {
  throw UnavailableError("this build of atomesh has no TetGen (ATOMESH_TETGEN was off); use --mesher delaunay");
}

#endif

}  // namespace atomesh
