#include "preprocess/delaunay_hole.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/circumsphere.h"
#include "core/predicates.h"
#include "preprocess/remove_slivers.h"

namespace atomesh {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double squared(const Vec3& v) {
  return glm::dot(v, v);
}

// Of a triangle of link vertices, whichever way round: of two with one name, one is seen from each side.
std::uint64_t name_of(const Triangle& triangle) {
  auto [a, b, c] = triangle;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return std::uint64_t{a} << 42U | std::uint64_t{b} << 21U | c;
}

}  // namespace

// Sign of the volume, 0 for what is thinner than a sliver.
int DelaunayHole::side(Index a, Index b, Index c, Index d) const {
  const Vec3 u = points_[b] - points_[a], v = points_[c] - points_[a], w = points_[d] - points_[a];
  const Vec3 normal = glm::cross(u, v);
  const double longest = std::max({squared(u), squared(v), squared(w)});
  const double six_volumes = glm::dot(normal, w);
  if (six_volumes * six_volumes <= sliver_thickness * sliver_thickness * longest * squared(normal)) return 0;
  return six_volumes > 0.0 ? 1 : -1;
}

// Whether `place` counts as inside the sphere of tet, on which it lies.
bool DelaunayHole::inside_perturbed(const Tetrahedron& tet, Index place, SphereTies ties) const {
  std::array<Index, 5> all{tet[0], tet[1], tet[2], tet[3], place};
  if (ties == SphereTies::to_the_ulp) {
    const int sign = in_sphere(position(tet[0]), position(tet[1]), position(tet[2]), position(tet[3]), position(place));
    if (sign != 0) return sign > 0;
  }
  const bool push = ties != SphereTies::pull_first;
  std::sort(all.begin(), all.end(), [&](Index a, Index b) { return push ? rank_[a] > rank_[b] : rank_[a] < rank_[b]; });
  for (const Index moved : all) {
    if (moved == place) return !push;
    Tetrahedron other = tet;
    *std::find(other.begin(), other.end(), moved) = place;
    const int sign = side(other[0], other[1], other[2], other[3]);
    if (sign != 0) return push ? sign > 0 : sign < 0;
  }
  return false;
}

Index DelaunayHole::apex_behind(const Triangle& triangle, SphereTies ties) {
  const auto& [a, b, c] = triangle;
  const Vec3 u = points_[b] - points_[a], v = points_[c] - points_[a];
  const Vec3 normal = glm::cross(u, v);
  const double normal_squared = squared(normal);
  if (normal_squared == 0.0) return no_index;
  const double normal_length = std::sqrt(normal_squared);
  // Centre of the circle through the triangle, from its first corner. The centres of the spheres through the triangle
  // lie on the line through it; the sphere that reaches less far behind holds nothing that another's vertex does.
  const Vec3 centre = glm::cross(squared(u) * v - squared(v) * u, normal) / (2.0 * normal_squared);
  const double circle = squared(centre);
  const double thickness = sliver_thickness * std::sqrt(std::max({squared(u), squared(v), squared(v - u)}));
  reach_.assign(points_.size(), infinity);
  double least = infinity;
  for (Index w = 0; w < points_.size(); ++w) {
    const Vec3 from_corner = points_[w] - points_[a];
    const double depth = -glm::dot(normal, from_corner) / normal_length;
    if (depth <= thickness || w == a || w == b || w == c) continue;
    reach_[w] = (squared(from_corner - centre) - circle) / (2.0 * depth);
    least = std::min(least, reach_[w]);
  }
  if (least == infinity) return no_index;
  const double limit = least + sliver_sphere_tolerance * std::sqrt(circle + least * least);
  Index best = no_index;
  for (Index w = 0; w < points_.size(); ++w) {
    if (reach_[w] > limit) continue;
    if (best == no_index || inside_perturbed({a, c, b, best}, w, ties)) best = w;
  }
  return best;
}

bool DelaunayHole::fill(const StarMesh& mesh, const Star& star, SphereTies ties) {
  mesh_ = &mesh;
  star_ = &star;
  const std::size_t count = star.link.size();
  points_.clear();
  for (const Index v : star.link) points_.push_back(mesh.position(v) - mesh.position(star.vertex));
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), Index{0});
  std::sort(order_.begin(), order_.end(), [&](Index a, Index b) {
    const Vec3 &p = position(a), &q = position(b);
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  });
  rank_.resize(count);
  for (std::size_t i = 0; i < count; ++i) rank_[order_[i]] = static_cast<Index>(i);

  // Gift wrapping: a tetrahedron behind each open triangle, until none is open.
  fill_.clear();
  front_ = star.triangles;
  front_name_.clear();
  for (const Triangle& triangle : front_) front_name_.push_back(name_of(triangle));
  while (!front_.empty()) {
    const auto [a, b, c] = front_.back();
    front_.pop_back();
    front_name_.pop_back();
    const Index apex = apex_behind({a, b, c}, ties);
    if (apex == no_index || fill_.size() > 4 * star.triangles.size()) return false;
    fill_.push_back({a, c, b, apex});
    // The other three faces: what was open there from the other side is closed, else they are open from this side.
    for (const Triangle& face : {Triangle{a, b, apex}, Triangle{b, c, apex}, Triangle{c, a, apex}}) {
      const std::uint64_t name = name_of(face);
      const auto found = std::find(front_name_.begin(), front_name_.end(), name);
      if (found == front_name_.end()) {
        front_.push_back(face);
        front_name_.push_back(name);
      } else {
        front_[static_cast<std::size_t>(found - front_name_.begin())] = front_.back();
        *found = front_name_.back();
        front_.pop_back();
        front_name_.pop_back();
      }
    }
  }
  if (!fills_the_star() || !spheres_are_empty()) return false;
  for (Tetrahedron& tet : fill_) {
    for (Index& v : tet) v = star.link[v];
  }
  return true;
}

// Positive tetrahedra that end at the star's triangles fill it once when they have its volume.
bool DelaunayHole::fills_the_star() const {
  double hole = 0.0;
  for (const auto& [a, b, c] : star_->triangles) hole += glm::dot(glm::cross(points_[a], points_[b]), points_[c]);
  double filled = 0.0;
  for (const auto& [a, b, c, d] : fill_) filled += 6.0 * signed_volume(points_[a], points_[b], points_[c], points_[d]);
  return std::abs(filled - hole) <= 1e-9 * hole;
}

bool DelaunayHole::spheres_are_empty() const {
  const Vec3& origin = mesh_->position(star_->vertex);
  for (const auto& [a, b, c, d] : fill_) {
    if (orientation(position(a), position(b), position(c), position(d)) <= 0) return false;
    const Sphere sphere = circumsphere(points_[a], points_[b], points_[c], points_[d]);
    const double inner = sphere.radius * (1.0 - 0.5 * delaunay_tolerance);
    const double limit = inner * inner;
    for (const Vec3& p : points_) {
      if (squared(p - sphere.center) < limit) return false;
    }
    for (const Corner face : star_->corners) {
      const Index beyond = mesh_->across(face);
      if (beyond != no_index && squared(mesh_->position(beyond) - origin - sphere.center) < limit) return false;
    }
  }
  return true;
}

}  // namespace atomesh
