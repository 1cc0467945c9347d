// The line of sight through one pixel, and what of a mesh it meets: one pass over the mesh, nothing kept.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/progress.h"
#include "render/scene.h"

namespace atomesh::gui {

// Where the line goes through a triangle. Weights are barycentric, in the order of the corners.
struct TriangleCrossing {
  Index triangle = no_index;
  double depth = 0.0;     // along Camera::forward
  bool entering = false;  // through the side the normal points to
  std::array<double, 3> weights{};
};

// The stretch of the line in a tetrahedron, in front of the eye. Weights are barycentric.
struct CellCrossing {
  Index cell = no_index;
  double near_depth = 0.0;
  double far_depth = 0.0;
  std::array<double, 4> near_weights{};
  std::array<double, 4> far_weights{};
};

class SightLine {
 public:
  // Through the centre of the pixel. Looks at every vertex of the scene (a byte each is kept). Keeps a reference.
  SightLine(const Scene& scene, const Camera& camera, int column, int row);

  // What lies in front of the eye, nearest first. A line through an edge or a vertex goes by it on the right and above,
  // as the renderers have it. Throws CancelledError.
  std::vector<TriangleCrossing> triangles(std::span<const Triangle> triangles, const Progress& progress) const;
  std::vector<CellCrossing> cells(std::span<const Tetrahedron> cells, const Progress& progress) const;

  // Å along the line for each Å of depth.
  double stretch() const { return stretch_; }
  // Scene coordinates (about Scene::center).
  Vec3 point(double depth) const;

 private:
  // A vertex about the line: x to the right of it and y above in the picture's axes, both 0 on the line; z the depth.
  Vec3 about_line(const Vec3f& vertex) const;
  std::optional<TriangleCrossing> cross(const Vec3& a, const Vec3& b, const Vec3& c) const;

  const Scene& scene_;
  Camera camera_;
  Vec3 eye_;  // about Scene::center
  double x_;
  double y_;
  bool perspective_;
  double stretch_;
  // Of each vertex, on which sides of the line it lies: what all corners share cannot be met.
  std::vector<std::uint8_t> sides_;
};

}  // namespace atomesh::gui
