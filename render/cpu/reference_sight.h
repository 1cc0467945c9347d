// The judge's geometry: which faces and cells a pixel's ray meets, and where. Everything in double; what decides
// "meets or not" is exact, so a ray through a vertex, along an edge or inside a face meets every cell exactly once.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/geometry.h"
#include "render/scene.h"

namespace atomesh::reference {

// A ray in view coordinates: X along Camera::right, Y along up, Z = depth along forward, about the eye. Points on it
// are (x·Z, y·Z, Z) in perspective, (x, y, Z) in parallel projection.
struct PixelRay {
  double x = 0.0;
  double y = 0.0;
};

// Where a ray crosses a triangle.
struct Crossing {
  double depth = 0.0;
  std::array<double, 3> weights{};  // barycentric, in the order of the triangle's corners; they sum to 1
  bool entering = false;            // through the side the triangle's normal points to
};

// The stretch of a ray inside a tetrahedron, with the barycentric weights at both ends in the order of its vertices.
struct CellSegment {
  double near_depth = 0.0;
  double far_depth = 0.0;
  std::array<double, 4> near_weights{};
  std::array<double, 4> far_weights{};
};

class Sight {
 public:
  Sight(const Scene& scene, const Camera& camera);

  PixelRay pixel_ray(int column, int row) const { return {camera_.x_of(column), camera_.y_of(row)}; }
  // Å per unit of depth along the ray.
  double stretch(const PixelRay& ray) const;
  // Scene coordinates (about Scene::center) of the point at this depth, and of the eye.
  Vec3 point(const PixelRay& ray, double depth) const;
  Vec3 eye() const { return eye_; }
  // Unit vector from a point of the ray towards the viewer.
  Vec3 to_viewer(const PixelRay& ray) const;
  bool perspective() const { return perspective_; }
  const Camera& camera() const { return camera_; }

  // The whole line through the ray is tested: depths can be negative (behind the eye).
  std::optional<Crossing> cross_triangle(const PixelRay& ray, const Triangle& triangle) const;
  std::optional<CellSegment> cross_cell(const PixelRay& ray, const Tetrahedron& cell) const;
  // Conservative extent of a set of view points on the picture, in pixels; the whole picture where one is not in front
  // of the eye.
  struct Extent {
    int left = 0, right = -1, top = 0, bottom = -1;  // inclusive; empty when it misses the picture
  };
  Extent extent_of_vertices(const Index* vertices, int count) const;
  Extent extent_of_ball(const Ball& ball) const;

 private:
  Vec3 to_view(const Vec3& scene_point) const;
  // Homogeneous coordinates in the image plane.
  Vec3 image_point(const Vec3& view_point) const {
    return perspective_ ? view_point : Vec3(view_point.x, view_point.y, 1.0);
  }
  double image_area(const PixelRay& ray, const Vec3& p, const Vec3& q) const;
  int side(const PixelRay& ray, Index a, Index b) const;
  Crossing locate(const PixelRay& ray, const Triangle& triangle, bool entering) const;
  // Whether the eye lies exactly on the cell's boundary (on a vertex, on an edge, in a face), and then in the planes of
  // which faces.
  bool touches_eye(const Tetrahedron& cell, std::array<bool, 4>& in_plane) const;
  // Whether the ray leads inward through a face that the eye lies in.
  bool heads_inward(const PixelRay& ray, const Triangle& face) const;
  std::array<double, 4> weights_of_eye(const Tetrahedron& cell) const;
  Extent extent_of_points(const Vec3* points, int count) const;

  Camera camera_;
  bool perspective_;
  Vec3 eye_;                // about Scene::center
  std::vector<Vec3> view_;  // of every vertex
};

}  // namespace atomesh::reference
