#include "preprocess/simplify_remove.h"

#include <array>
#include <limits>

#include "preprocess/delaunay_hole.h"
#include "preprocess/vertex_queue.h"

namespace atomesh {

std::size_t remove_vertices(StarMesh& mesh, std::vector<std::uint8_t>& free, Progress& progress) {
  VertexQueue queue(mesh, free, progress);
  Star star;
  DelaunayHole hole;
  std::vector<Index> cells;
  std::array<SphereTies, 3> rules{SphereTies::to_the_ulp, SphereTies::pull_first, SphereTies::push_last};
  std::size_t removed = 0;
  std::size_t steps = 0;
  for (VertexQueue::Waiting next; queue.next(next);) {
    progress.check();
    if (++steps % 4096 == 0) progress.update(queue.fraction());
    const Index v = next.vertex;
    mesh.gather(v, star);
    // Its nearest neighbour may have gone since it entered the queue.
    double shortest = std::numeric_limits<double>::infinity();
    for (const Index w : star.link) {
      const Vec3 edge = mesh.position(w) - mesh.position(v);
      shortest = std::min(shortest, glm::dot(edge, edge));
    }
    if (shortest > next.squared_length && queue.shorter_waits(shortest)) {
      queue.put_back(v, shortest);
      continue;
    }
    bool filled = false;
    if (star.corners.size() <= remove_largest_star) {
      cells.clear();
      for (const Corner corner : star.corners) cells.push_back(corner / 4);
      // A mesh follows one rule nearly everywhere: what worked last is tried first.
      for (std::size_t i = 0; i < rules.size() && !filled; ++i) {
        filled = hole.fill(mesh, star, rules[i]) && mesh.refill(cells, star.corners, hole.tetrahedra());
        if (filled) std::swap(rules[0], rules[i]);
      }
    }
    if (!filled) {
      queue.refuse(v, shortest);
      queue.put_aside(v, star.corners.size());
      continue;
    }
    free[v] = 0;
    ++removed;
    queue.changed(star.link);
  }
  return removed;
}

}  // namespace atomesh
