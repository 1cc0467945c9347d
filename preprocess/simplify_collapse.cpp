#include "preprocess/simplify_collapse.h"

#include <algorithm>
#include <cmath>

#include "core/predicates.h"
#include "preprocess/cavity.h"
#include "preprocess/vertex_queue.h"

namespace atomesh {

namespace {

double squared(const Vec3& v) {
  return glm::dot(v, v);
}

// What becomes of a star when its vertex moves onto one of its link: the shapes that come out, found with plain doubles
// wherever they decide.
class Fan {
 public:
  void prepare(const StarMesh& mesh, const Star& star) {
    mesh_ = &mesh;
    star_ = &star;
    const Vec3& centre = mesh.position(star.vertex);
    points_.clear();
    double reach = 0.0;
    for (const Index w : star.link) {
      points_.push_back(mesh.position(w) - centre);
      reach = std::max({reach, std::abs(points_.back().x), std::abs(points_.back().y), std::abs(points_.back().z)});
    }
    planes_.clear();
    for (const Triangle& triangle : star.triangles) {
      const Vec3& a = points_[triangle[0]];
      const Vec3 normal = glm::cross(points_[triangle[1]] - a, points_[triangle[2]] - a);
      const Vec3 &b = points_[triangle[1]], &c = points_[triangle[2]];
      planes_.push_back(
          {triangle, normal, glm::dot(normal, a), std::max({squared(b - a), squared(c - b), squared(a - c)})});
    }
    // Coordinates about the centre are off by half an ulp, their differences by two, all at most 2 reach: the
    // determinant, six products of three, by less than 300 half ulps of reach³.
    doubt_ = 1e-13 * reach * reach * reach;
  }

  double squared_length(Index target) const { return squared(points_[target]); }

  // The worst shape (see shape_of() in cavity.h) among the tetrahedra that link vertex `target` makes with the
  // triangles it is no corner of; 0 when one of them would be inverted, flat or not better than `floor`.
  double worst_shape(Index target, double floor) {
    const Vec3& apex = points_[target];
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const Plane& plane = planes_[i];
      if (plane.offset - glm::dot(plane.normal, apex) > doubt_ || plane.has(target) || sees(plane, target, floor)) {
        continue;
      }
      // What hides from one hides from others: it is looked at first next time.
      std::swap(planes_[i], planes_[i / 2]);
      return 0.0;
    }
    double worst = 1.0;
    for (const Plane& plane : planes_) {
      if (plane.has(target)) continue;
      worst = std::min(worst, shape(plane, plane.offset - glm::dot(plane.normal, apex), target));
      if (worst <= floor) return 0.0;
    }
    return worst;
  }

 private:
  struct Plane {
    Triangle triangle;
    Vec3 normal;  // outward, twice the triangle's area long
    double offset;
    double squared_edge;  // the longest of the triangle
    bool has(Index corner) const { return triangle[0] == corner || triangle[1] == corner || triangle[2] == corner; }
  };

  double shape(const Plane& plane, double six_volumes, Index target) const {
    const Vec3& apex = points_[target];
    double longest = plane.squared_edge;
    for (const Index corner : plane.triangle) longest = std::max(longest, squared(points_[corner] - apex));
    return std::numbers::sqrt2 * six_volumes / (longest * std::sqrt(longest));
  }

  // Whether the target sees a triangle that doubles are not sure about.
  bool sees(const Plane& plane, Index target, double floor) const {
    const double six_volumes = plane.offset - glm::dot(plane.normal, points_[target]);
    if (shape(plane, six_volumes + doubt_, target) <= floor) return false;
    const auto at = [&](int corner) -> const Vec3& { return mesh_->position(star_->link[plane.triangle[corner]]); };
    return orientation(at(0), at(1), at(2), mesh_->position(star_->link[target])) < 0;
  }

  const StarMesh* mesh_ = nullptr;
  const Star* star_ = nullptr;
  std::vector<Vec3> points_;  // of the link, about the star's vertex
  std::vector<Plane> planes_;
  double doubt_ = 0.0;
};

struct Edge {
  double squared_length;
  Index target;  // place in the link
  Index vertex;
  bool operator<(const Edge& other) const {
    return squared_length != other.squared_length ? squared_length < other.squared_length : vertex < other.vertex;
  }
};

class Collapser {
 public:
  Collapser(StarMesh& mesh, std::vector<std::uint8_t>& free, const std::vector<std::uint8_t>& kept, Progress& progress)
      : mesh_(mesh), free_(free), progress_(progress), cavity_(mesh, kept), best_cavity_(mesh, kept) {}

  // Tetrahedra of a worse shape than `floor` are not made.
  std::size_t run(double floor) {
    floor_ = floor;
    VertexQueue queue(mesh_, free_, progress_);
    std::size_t removed = 0;
    std::size_t steps = 0;
    for (VertexQueue::Waiting next; queue.next(next);) {
      progress_.check();
      if (++steps % 4096 == 0) progress_.update(queue.fraction());
      if (try_vertex(next, queue)) ++removed;
    }
    return removed;
  }

 private:
  bool try_vertex(const VertexQueue::Waiting& waiting, VertexQueue& queue) {
    const Index v = waiting.vertex;
    mesh_.gather(v, star_);
    fan_.prepare(mesh_, star_);
    edges_.clear();
    for (Index w = 0; w < star_.link.size(); ++w) {
      const double squared = fan_.squared_length(w);
      if (squared > queue.refused(v)) edges_.push_back({squared, w, star_.link[w]});
    }
    std::sort(edges_.begin(), edges_.end());
    for (std::size_t i = 0; i < edges_.size();) {
      if (edges_[i].squared_length > waiting.squared_length && queue.shorter_waits(edges_[i].squared_length)) {
        queue.put_back(v, edges_[i].squared_length);
        return false;
      }
      std::size_t end = i;
      const double limit = collapse_near * collapse_near * edges_[i].squared_length;
      while (end < edges_.size() && edges_[end].squared_length <= limit) ++end;
      if (collapse_one(i, end, queue)) return true;
      queue.refuse(v, edges_[end - 1].squared_length);
      i = end;
    }
    queue.put_aside(v, star_.corners.size());
    return false;
  }

  // Collapses the best of edges_[begin] to edges_[end - 1], with the star alone or, when none of these ends sees all of
  // it, with what hides from them taken in.
  bool collapse_one(std::size_t begin, std::size_t end, VertexQueue& queue) {
    double best_shape = 0.0;
    Index best = no_index;
    for (std::size_t i = begin; i < end; ++i) {
      const double shape = fan_.worst_shape(edges_[i].target, std::max(floor_, best_shape));
      if (shape <= best_shape) continue;
      best_shape = shape;
      best = edges_[i].target;
    }
    if (best != no_index) {
      mesh_.collapse(star_, best);
      free_[star_.vertex] = 0;
      queue.changed(star_.link, star_.link[best]);
      return true;
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (i % 64 == 63) progress_.check();
      const double shape = cavity_.grow(star_, edges_[i].vertex, floor_, best_shape);
      if (shape <= best_shape) continue;
      best_shape = shape;
      best = edges_[i].vertex;
      std::swap(best_cavity_, cavity_);
    }
    if (best_shape <= 0.0) return false;
    if (!mesh_.refill(best_cavity_.cells(), best_cavity_.faces(), best_cavity_.fill())) return false;
    free_[star_.vertex] = 0;
    queue.changed(best_cavity_.border(), best);
    return true;
  }

  StarMesh& mesh_;
  std::vector<std::uint8_t>& free_;
  Progress& progress_;
  double floor_ = 0.0;
  Star star_;
  Fan fan_;
  std::vector<Edge> edges_;
  Cavity cavity_, best_cavity_;
};

}  // namespace

std::size_t collapse_edges(StarMesh& mesh, std::vector<std::uint8_t>& free, const std::vector<std::uint8_t>& kept,
                           Progress& progress) {
  Collapser collapser(mesh, free, kept, progress);
  std::size_t removed = 0;
  for (const double floor : collapse_shapes) removed += collapser.run(floor);
  return removed;
}

}  // namespace atomesh
