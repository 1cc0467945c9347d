// The order in which tetrahedra are drawn so that on each ray they follow one another front to back, or nearly so.
//
// First by a key of each cell. In a Delaunay mesh the power of the eye with respect to the circumspheres is an exact
// order (Edelsbrunner 1990, "An acyclicity theorem for cell complexes in d dimensions"; from infinity it becomes the
// depth of the circumcentres); a trace of the squared distance of the centroid breaks ties (all cells of a cube of a
// perfect lattice share one sphere). Elsewhere the key is that distance. Both are |eye|² - 2 eye·p + w of a point p and
// a weight w of the cell, which is all that is kept of it.
//
// Then, where the mesh's neighbours are given, by its faces: of two cells that share a face the one on the eye's side
// comes first (Williams 1992, "Visibility-ordering meshed polyhedra"), and keys decide between cells that share none
// (gaps, concave outsides). Cells that overlap one another in a circle have no right order; one of them is drawn too
// early, and counted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/progress.h"
#include "render/gl/key_sort.h"
#include "render/scene.h"

namespace atomesh::gl {

struct CellOrderStats {
  double keys_ms = 0.0;       // computing keys and sorting by them
  double faces_ms = 0.0;      // putting cells that share faces in order
  std::uint64_t circles = 0;  // faces whose cells stand in the wrong order, for there is none that suits all
};

// What a cell's key is made of, for the CPU and for shaders: key_of() with p and weight of each cell.
struct OrderPoint {
  Vec3f p;  // about Scene::center: the circumcentre or the centroid
  float weight;
};

// From |eye|² - 2 eye·p + w, or p·forward of parallel projection, to 32 bits that grow with it. Values between `low`
// and `low + range` get a third of all keys; what lies outside (spheres of slivers reach far) shares the rest.
struct KeyScale {
  Vec3 direction;  // key = weight_factor · weight + direction · p
  double weight_factor;
  double low;
  double over_range;  // 1 / range
};
KeyScale key_scale(const Camera& camera, const Scene& scene);
std::uint32_t key_of(const KeyScale& scale, const OrderPoint& point);

// A face that one cell alone has.
struct OutsideFace {
  Index cell;
  int face;  // opposite its corner of that number
};

class CellOrder {
 public:
  // Keeps a reference to the scene, 16 bytes a tetrahedron and, `by_faces`, 16 more (while made 24). A mesh in which
  // more than two cells share a face is ordered by keys alone. Throws CancelledError.
  CellOrder(const Scene& scene, bool by_faces, Progress& progress = no_progress());

  // The cells (indices into Scene::tetrahedra, each at most once) front to back. Adds to `stats`. Not for two threads
  // at once. `unseen`: other cells that are not drawn, but may lie between those that are (transparent ones): the order
  // by faces is found across them. Throws CancelledError; outside() is then empty.
  void sort(const Camera& camera, std::span<const Index> cells, std::span<const Index> unseen,
            std::vector<Index>& order, CellOrderStats& stats, const Progress& progress = no_progress());

  std::span<const OrderPoint> points() const { return points_; }
  bool by_faces() const { return !neighbours_.empty(); }

  // Whether in the order last found all cells that share a face stand right, and none is turned inside out: a ray then
  // may meet cells in a wrong order only where it leaves the mesh and enters it again. All of the mesh's outside faces
  // front to back, as far as that order is right: each where its cell stands, before it where the ray enters, behind it
  // where it leaves. Empty where that is not so.
  std::span<const OutsideFace> outside() const { return outside_in_order_; }

 private:
  void order_by_faces(const Camera& camera, std::span<const Index> cells, std::span<const Index> unseen,
                      std::vector<Index>& order, CellOrderStats& stats, const Progress& progress);
  void find_outside(Progress& progress);
  void order_outside(const Camera& camera, const Progress& progress);

  const Scene& scene_;
  std::vector<OrderPoint> points_;
  std::vector<std::array<Index, 4>> neighbours_;
  // of sort(), kept for the next frame
  std::vector<KeyedCell> keyed_;
  std::vector<KeyedCell> scratch_;
  // of each cell of the scene
  std::vector<Index> rank_;  // by keys; no_index where it is not looked at
  std::vector<std::uint8_t> state_;
  std::vector<Index> path_;
  std::vector<OutsideFace> outside_;  // none where a cell is turned inside out
  std::vector<OutsideFace> outside_in_order_;
};

}  // namespace atomesh::gl
