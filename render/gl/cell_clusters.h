// Cells of a Delaunay mesh that share one circumsphere: all of a cube of a perfect lattice, of an octahedron of a face
// centred one. Their keys (cell_order.h) say nothing about which comes first. As a cluster they have one key, and among
// themselves are put in order by the faces between them, which is quickly done for so few: of two cells that share a
// face the one on the eye's side comes first. (order_clusters.comp)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "render/gl/cell_order.h"

namespace atomesh::gl {

inline constexpr std::size_t most_of_cluster = 32;  // cells; what would be larger is left in parts

struct CellClusters {
  struct Start {
    std::uint32_t cell, face;  // the first ones of a cluster
  };
  // A face between two cells of a cluster, by the places they have in it (near | far << 16): `plane` · (x, 1) is the
  // way (Å) of x, about Scene::center, from the face to the far cell's side.
  struct Face {
    Vec4f plane;
    std::uint32_t pair;
  };
  std::vector<Start> starts;  // one more than there are clusters
  std::vector<Index> cells;   // of each cluster, ascending
  std::vector<Face> faces;
  std::size_t count() const { return starts.empty() ? 0 : starts.size() - 1; }
};

// Clusters of two cells or more of a Delaunay scene; none where more than two cells share a face. Cells are of one
// whose spheres are the same to 3e-4 of an edge, or to what rounding leaves open; a flat cell, whose own sphere means
// nothing, is of a neighbour's on whose sphere its corners lie. `points` (CellOrder::points()) become the same for all
// cells of a cluster: the mean of those that are not flat. Takes 110 bytes a cell while it works. Throws
// CancelledError.
CellClusters find_cell_clusters(const Scene& scene, std::span<OrderPoint> points, Progress& progress = no_progress());

}  // namespace atomesh::gl
