#include "render/gl/clip_cell.h"

#include <tuple>
#include <utility>

namespace atomesh::gl {

namespace {

bool before(const CellCorner& a, const CellCorner& b) {
  return std::tie(a.p.x, a.p.y, a.p.z) < std::tie(b.p.x, b.p.y, b.p.z);
}

CellCorner cut(const CellCorner& a, const CellCorner& b, double height_a, double height_b) {
  if (before(b, a)) return cut(b, a, height_b, height_a);
  const double t = height_a / (height_a - height_b);
  return {a.p + t * (b.p - a.p), a.scalar + t * (b.scalar - a.scalar)};
}

// The prism with triangles abc and def, a over d, b over e and c over f; abc's normal towards def.
void add_prism(const CellCorner& a, const CellCorner& b, const CellCorner& c, const CellCorner& d, const CellCorner& e,
               const CellCorner& f, std::vector<CellCorners>& pieces) {
  pieces.push_back({a, b, c, d});
  pieces.push_back({b, c, d, e});
  pieces.push_back({c, d, e, f});
}

void clip(const CellCorners& cell, const HalfSpace& space, std::vector<CellCorners>& pieces) {
  std::array<double, 4> height;
  std::array<int, 4> order;  // inside first, an even permutation of the corners
  int inside = 0;
  for (int k = 0; k < 4; ++k) {
    height[k] = glm::dot(space.normal, cell[k].p) - space.distance;
    if (height[k] >= 0.0) order[inside++] = k;
  }
  if (inside == 0) return;
  if (inside == 4) {
    pieces.push_back(cell);
    return;
  }
  int last = inside;
  for (int k = 0; k < 4; ++k) {
    if (height[k] < 0.0) order[last++] = k;
  }
  int inversions = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j] ? 1 : 0;
  }
  // Two of the same side may change places.
  if (inversions % 2 == 1) inside >= 2 ? std::swap(order[0], order[1]) : std::swap(order[2], order[3]);
  const auto corner = [&](int i) { return cell[order[i]]; };
  const auto between = [&](int i, int j) {
    return cut(cell[order[i]], cell[order[j]], height[order[i]], height[order[j]]);
  };
  if (inside == 1) {
    pieces.push_back({corner(0), between(0, 1), between(0, 2), between(0, 3)});
  } else if (inside == 2) {
    add_prism(corner(0), between(0, 2), between(0, 3), corner(1), between(1, 2), between(1, 3), pieces);
  } else {
    add_prism(corner(0), corner(1), corner(2), between(0, 3), between(1, 3), between(2, 3), pieces);
  }
}

}  // namespace

void clip_cell(const CellCorners& cell, std::span<const HalfSpace> spaces, std::vector<CellCorners>& pieces) {
  std::vector<CellCorners> now{cell};
  std::vector<CellCorners> next;
  for (const HalfSpace& space : spaces) {
    next.clear();
    for (const CellCorners& piece : now) clip(piece, space, next);
    now.swap(next);
  }
  pieces.insert(pieces.end(), now.begin(), now.end());
}

}  // namespace atomesh::gl
