// The only file that includes CGAL.
#include "preprocess/tetrahedralize_cgal.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_cell_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <numeric>

#include "core/predicates.h"
#include "preprocess/memory_needs.h"
#include "preprocess/tetrahedralize.h"

namespace {

using Epick = CGAL::Exact_predicates_inexact_constructions_kernel;

atomesh::Vec3 vec(const Epick::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

// EPICK with the two predicates that decide a Delaunay triangulation answered by core/predicates.h. They are exact like
// CGAL's own, but stay in doubles where those turn to multi-precision numbers: on a perfect lattice, where every cell
// is cospherical with its neighbours, that is most of the time a triangulation takes.
struct Traits : Epick {
  struct Orientation_3 {
    using result_type = CGAL::Orientation;
    CGAL::Orientation operator()(const Point_3& a, const Point_3& b, const Point_3& c, const Point_3& d) const {
      return static_cast<CGAL::Orientation>(atomesh::orientation(vec(a), vec(b), vec(c), vec(d)));
    }
  };
  struct Side_of_oriented_sphere_3 {
    using result_type = CGAL::Oriented_side;
    CGAL::Oriented_side operator()(const Point_3& a, const Point_3& b, const Point_3& c, const Point_3& d,
                                   const Point_3& e) const {
      return static_cast<CGAL::Oriented_side>(atomesh::in_sphere(vec(a), vec(b), vec(c), vec(d), vec(e)));
    }
  };
  Orientation_3 orientation_3_object() const { return {}; }
  Side_of_oriented_sphere_3 side_of_oriented_sphere_3_object() const { return {}; }
};

// Index → point for sorting, which has no other place to look whether to cancel.
struct CancellablePoints {
  using key_type = std::size_t;
  using value_type = Traits::Point_3;
  using reference = const Traits::Point_3&;
  using category = boost::readable_property_map_tag;

  const Traits::Point_3* points;
  const atomesh::Progress* progress;

  friend reference get(const CancellablePoints& map, std::size_t i) {
    map.progress->check();
    return map.points[i];
  }
};

using Vertex = CGAL::Triangulation_vertex_base_with_info_3<atomesh::Index, Traits>;
using Cell = CGAL::Delaunay_triangulation_cell_base_3<Traits>;

}  // namespace

namespace CGAL {
// Walks may use rounded orientations first, as they do with EPICK itself.
template <>
struct Triangulation_structural_filtering_traits<Traits> {
  using Use_structural_filtering_tag = Tag_true;
};
}  // namespace CGAL

namespace atomesh {

std::vector<Tetrahedron> delaunay_cgal(std::span<const Vec3> points, Progress& progress) {
  using Triangulation =
      CGAL::Delaunay_triangulation_3<Traits, CGAL::Triangulation_data_structure_3<Vertex, Cell, CGAL::Sequential_tag>>;
  require_memory_for("Delaunay tetrahedralization", points.size(), "points", memory_to_mesh("delaunay", points.size()));
  std::vector<Traits::Point_3> positions;
  positions.reserve(points.size());
  for (const Vec3& p : points) positions.emplace_back(p.x, p.y, p.z);

  // Hilbert order in rounds of growing size: neighbours are inserted one after another, yet no order of the file can
  // make the conflict regions large. The order has no say in the result: the symbolic perturbation goes by coordinates
  // (Devillers & Teillaud 2003, INRIA RR-4870).
  //
  // One thread on purpose. CGAL's parallel insertion was measured on two cores: 1.4 to 1.6 times faster alone, but two
  // to three times slower as soon as anything else ran, for its threads spin on the locks of threads that wait for a
  // core.
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  CGAL::spatial_sort(
      order.begin(), order.end(),
      CGAL::Spatial_sort_traits_adapter_3<Traits, CancellablePoints>(CancellablePoints{positions.data(), &progress}));

  Triangulation triangulation;
  Triangulation::Vertex_handle hint;
  for (std::size_t i = 0; i < order.size(); ++i) {
    hint = triangulation.insert(positions[order[i]], hint);
    hint->info() = static_cast<Index>(order[i]);
    if (i % 1024 == 0) progress.update(static_cast<double>(i) / static_cast<double>(order.size()));
  }

  positions = {};
  order = {};
  std::vector<Tetrahedron> tetrahedra;
  if (triangulation.dimension() < 3) return tetrahedra;
  tetrahedra.reserve(triangulation.number_of_cells());
  for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end(); ++cell) {
    if (tetrahedra.size() % 65536 == 0) progress.check();
    tetrahedra.push_back(
        {cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(), cell->vertex(3)->info()});
  }
  return tetrahedra;
}

std::size_t delaunay_cgal_stock(std::span<const Vec3> points) {
  std::vector<Epick::Point_3> positions;
  positions.reserve(points.size());
  for (const Vec3& p : points) positions.emplace_back(p.x, p.y, p.z);
  const CGAL::Delaunay_triangulation_3<Epick> triangulation(positions.begin(), positions.end());
  return triangulation.dimension() < 3 ? 0 : triangulation.number_of_finite_cells();
}

}  // namespace atomesh
