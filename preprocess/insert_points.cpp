#include "preprocess/insert_points.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/parallel.h"
#include "core/predicates.h"
#include "preprocess/local_mesh.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

namespace {

constexpr std::size_t points_per_range = 4096;

class Inserter {
 public:
  Inserter(LocalMesh& mesh, std::span<const Vec3> points) : mesh_(mesh), points_(points) {}

  // `near`: vertices that may belong to the tetrahedron around the point. False when none of theirs contains it.
  bool insert(Index point, std::span<const Index> near) {
    std::set<Index> holders;
    for (const Index v : near) {
      for (const Index t : mesh_.at(v)) {
        if (holds(t, points_[point])) holders.insert(t);
      }
    }
    if (holders.empty()) return false;
    std::set<Index> cavity = grown(holders, point);
    shrink(cavity, holders, point);
    std::vector<Tetrahedron> made;
    for (const Index t : cavity) {
      for (int f = 0; f < 4; ++f) {
        if (!is_outside(cavity, t, f)) continue;
        const Triangle face = outward_face(mesh_.tetrahedron(t), f);
        if (visible(face, point) > 0) {
          made.push_back({face[0], face[2], face[1], point});
        } else if (mesh_.on_rim(t, f)) {
          return false;  // what lies behind would have to be split too
        }
        // Otherwise the point lies in an outside face of the mesh, which it splits.
      }
    }
    for (const Index t : cavity) mesh_.remove(t);
    for (const Tetrahedron& t : made) mesh_.add(t);
    return true;
  }

 private:
  // 1 where the point lies on the inner side of an outward face, 0 in its plane.
  int visible(const Triangle& face, Index point) const {
    return orientation(points_[face[0]], points_[face[2]], points_[face[1]], points_[point]);
  }

  bool holds(Index t, const Vec3& p) const {
    const Tetrahedron& tet = mesh_.tetrahedron(t);
    for (int f = 0; f < 4; ++f) {
      const Triangle face = outward_face(tet, f);
      if (orientation(points_[face[0]], points_[face[2]], points_[face[1]], p) < 0) return false;
    }
    return true;
  }

  bool is_outside(const std::set<Index>& cavity, Index t, int f) const {
    const Index other = mesh_.neighbour(t, f);
    return other == no_index || !cavity.contains(other);
  }

  std::set<Index> grown(const std::set<Index>& holders, Index point) const {
    std::set<Index> cavity = holders;
    std::vector<Index> todo(holders.begin(), holders.end());
    while (!todo.empty()) {
      const Index t = todo.back();
      todo.pop_back();
      for (int f = 0; f < 4; ++f) {
        const Index other = mesh_.neighbour(t, f);
        if (other == no_index || cavity.contains(other)) continue;
        const auto& [a, b, c, d] = mesh_.tetrahedron(other);
        if (in_sphere(points_[a], points_[b], points_[c], points_[d], points_[point]) <= 0) continue;
        cavity.insert(other);
        todo.push_back(other);
      }
    }
    return cavity;
  }

  // Gives up what the point does not see all of, and what would take a vertex with it; what holds the point stays.
  void shrink(std::set<Index>& cavity, const std::set<Index>& holders, Index point) const {
    for (bool changed = true; changed;) {
      std::set<Index> unseen;
      std::set<Index> kept;  // vertices
      for (const Index t : cavity) {
        for (int f = 0; f < 4; ++f) {
          if (!is_outside(cavity, t, f)) continue;
          const Triangle face = outward_face(mesh_.tetrahedron(t), f);
          kept.insert(face.begin(), face.end());
          if (visible(face, point) <= 0) unseen.insert(t);
        }
      }
      std::vector<Index> given_up;
      for (const Index t : cavity) {
        const Tetrahedron& tet = mesh_.tetrahedron(t);
        const bool loses = std::any_of(tet.begin(), tet.end(), [&](Index v) { return !kept.contains(v); });
        if (!holders.contains(t) && (loses || unseen.contains(t))) given_up.push_back(t);
      }
      for (const Index t : given_up) cavity.erase(t);
      changed = !given_up.empty();
      keep_connected(cavity, holders);
    }
  }

  void keep_connected(std::set<Index>& cavity, const std::set<Index>& holders) const {
    std::set<Index> reached = holders;
    std::vector<Index> todo(holders.begin(), holders.end());
    while (!todo.empty()) {
      const Index t = todo.back();
      todo.pop_back();
      for (int f = 0; f < 4; ++f) {
        const Index other = mesh_.neighbour(t, f);
        if (other != no_index && cavity.contains(other) && reached.insert(other).second) todo.push_back(other);
      }
    }
    cavity = std::move(reached);
  }

  LocalMesh& mesh_;
  std::span<const Vec3> points_;
};

}  // namespace

std::vector<Index> insert_points(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points,
                                 std::span<const Index> added, double reach, Progress& progress) {
  if (added.empty()) return {};
  std::vector<Vec3> places;
  for (const Index i : added) places.push_back(points[i]);
  const NeighbourGrid grid(places, Box{}, reach, reach);
  // near[n]: vertices within reach of added[n]. Found from the vertices' side: they are many, the added few.
  std::vector<std::vector<Index>> near(added.size());
  std::vector<bool> marked(points.size(), false);
  {
    const std::size_t ranges = (points.size() + points_per_range - 1) / points_per_range;
    std::vector<std::vector<std::pair<Index, Index>>> pairs(ranges);
    parallel_for(points.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::vector<Index> slots;
      for (std::size_t i = begin; i < end; ++i) {
        grid.find(points[i], reach, slots);
        for (const Index slot : slots) {
          pairs[begin / points_per_range].emplace_back(grid.point(slot), static_cast<Index>(i));
        }
      }
    });
    for (const auto& range : pairs) {
      for (const auto& [n, i] : range) {
        near[n].push_back(i);
        marked[i] = true;
      }
    }
  }
  LocalMesh mesh(tetrahedra, marked, progress);
  Inserter inserter(mesh, points);
  std::vector<Index> outside;
  for (std::size_t n = 0; n < added.size(); ++n) {
    if (n % 64 == 0) progress.check();
    if (!inserter.insert(added[n], near[n])) outside.push_back(added[n]);
  }
  mesh.give_back(tetrahedra);
  std::sort(outside.begin(), outside.end());
  return outside;
}

}  // namespace atomesh
