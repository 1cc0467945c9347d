#include "core/split_cells.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace atomesh {

namespace {

using Faces = std::vector<std::vector<int>>;

// Outward, in corners of the cell.
const Faces& faces_of(CellShape shape) {
  static const std::array<Faces, 6> faces{{
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
      {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
      {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}},
      {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}},
      {{0, 4, 3, 2, 1}, {5, 6, 7, 8, 9}, {0, 1, 6, 5}, {1, 2, 7, 6}, {2, 3, 8, 7}, {3, 4, 9, 8}, {4, 0, 5, 9}},
      {{0, 5, 4, 3, 2, 1},
       {6, 7, 8, 9, 10, 11},
       {0, 1, 7, 6},
       {1, 2, 8, 7},
       {2, 3, 9, 8},
       {3, 4, 10, 9},
       {4, 5, 11, 10},
       {5, 0, 6, 11}},
  }};
  return faces[static_cast<std::size_t>(shape)];
}

constexpr bool is_odd(int corner) {
  return corner == 1 || corner == 3 || corner == 4 || corner == 6;
}

void append(const Tetrahedron& t, std::vector<Tetrahedron>& tetrahedra) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if (t[i] == t[j]) return;
    }
  }
  tetrahedra.push_back(t);
}

// From `apex` to every triangle of a face, which is split from its smallest vertex.
void cone(Index apex, std::vector<Index>& face, std::vector<Tetrahedron>& tetrahedra) {
  face.erase(std::unique(face.begin(), face.end()), face.end());
  while (face.size() > 1 && face.back() == face.front()) face.pop_back();
  if (face.size() < 3 || std::find(face.begin(), face.end(), apex) != face.end()) return;
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  for (std::size_t i = 1; i + 1 < face.size(); ++i) append({apex, face[0], face[i], face[i + 1]}, tetrahedra);
}

void split_hexahedron_into_5(std::span<const Index, 8> c, bool odd, std::vector<Tetrahedron>& tetrahedra) {
  static constexpr std::array<std::array<int, 4>, 5> even_split{
      {{0, 1, 2, 5}, {0, 2, 3, 7}, {0, 5, 7, 4}, {2, 7, 5, 6}, {0, 2, 7, 5}}};
  static constexpr std::array<std::array<int, 4>, 5> odd_split{
      {{0, 1, 3, 4}, {1, 2, 3, 6}, {1, 6, 4, 5}, {3, 4, 6, 7}, {1, 3, 4, 6}}};
  for (const auto& [p, q, r, s] : odd ? odd_split : even_split) append({c[p], c[q], c[r], c[s]}, tetrahedra);
}

// The class of the diagonal through each face's smallest vertex.
unsigned diagonals_from_smallest(std::span<const Index, 8> corners) {
  unsigned odd = 0;
  for (std::size_t f = 0; f < 6; ++f) {
    const auto& face = hexahedron_faces[f];
    const int smallest = *std::min_element(face.begin(), face.end(), [&](int a, int b) {
      return corners[static_cast<std::size_t>(a)] < corners[static_cast<std::size_t>(b)];
    });
    if (is_odd(smallest)) odd |= 1U << f;
  }
  return odd;
}

bool all_differ(std::span<const Index, 8> corners) {
  std::array<Index, 8> sorted{};
  std::copy(corners.begin(), corners.end(), sorted.begin());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

}  // namespace

std::size_t corner_count(CellShape shape) {
  static constexpr std::array<std::size_t, 6> counts{4, 5, 6, 8, 10, 12};
  return counts[static_cast<std::size_t>(shape)];
}

bool split_hexahedron(std::span<const Index, 8> corners, unsigned odd, std::vector<Tetrahedron>& tetrahedra) {
  if (odd == 0 || odd == 63) {
    split_hexahedron_into_5(corners, odd != 0, tetrahedra);
    return true;
  }
  for (int apex = 0; apex < 8; ++apex) {
    // A corner that the diagonals of its three faces all go through.
    bool fits = true;
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& face = hexahedron_faces[f];
      const bool has_apex = std::find(face.begin(), face.end(), apex) != face.end();
      fits = fits && (!has_apex || ((odd >> f & 1U) != 0) == is_odd(apex));
    }
    if (!fits) continue;
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& face = hexahedron_faces[f];
      if (std::find(face.begin(), face.end(), apex) != face.end()) continue;
      const std::size_t first = is_odd(face[0]) == ((odd >> f & 1U) != 0) ? 0 : 1;
      const auto corner = [&](std::size_t i) { return corners[static_cast<std::size_t>(face[(first + i) % 4])]; };
      append({corners[static_cast<std::size_t>(apex)], corner(0), corner(1), corner(2)}, tetrahedra);
      append({corners[static_cast<std::size_t>(apex)], corner(0), corner(2), corner(3)}, tetrahedra);
    }
    return true;
  }
  return false;
}

void split_cell(CellShape shape, std::span<const Index> corners, std::vector<Tetrahedron>& tetrahedra) {
  if (corners.size() != corner_count(shape)) {
    throw Error("a cell with " + std::to_string(corners.size()) + " corners, expected " +
                std::to_string(corner_count(shape)));
  }
  if (shape == CellShape::tetrahedron) {
    append({corners[0], corners[1], corners[2], corners[3]}, tetrahedra);
    return;
  }
  if (shape == CellShape::hexahedron) {
    const std::span<const Index, 8> eight(corners.data(), 8);
    if (all_differ(eight)) {
      split_hexahedron(eight, diagonals_from_smallest(eight), tetrahedra);
      return;
    }
  }
  const Index apex = *std::min_element(corners.begin(), corners.end());
  std::vector<Index> polygon;
  for (const std::vector<int>& face : faces_of(shape)) {
    polygon.clear();
    for (const int corner : face) polygon.push_back(corners[static_cast<std::size_t>(corner)]);
    cone(apex, polygon, tetrahedra);
  }
}

void split_polyhedron(std::span<const std::vector<Index>> faces, std::vector<Tetrahedron>& tetrahedra) {
  Index apex = no_index;
  for (const auto& face : faces) {
    for (const Index v : face) apex = std::min(apex, v);
  }
  std::vector<Index> polygon;
  for (const auto& face : faces) {
    polygon = face;
    cone(apex, polygon, tetrahedra);
  }
}

}  // namespace atomesh
