#include "app/cli/grid_seams.h"

#include <algorithm>
#include <map>

namespace atomesh::cli {

namespace {

// The vertices of a face in ascending order.
using FaceKey = std::array<Index, 4>;

class Seams {
 public:
  Seams(std::span<const Index> vertex_of, const std::vector<bool>& blanked)
      : vertex_of_(vertex_of), blanked_(blanked) {}

  void add(const StructuredBlock& block) {
    const auto& n = block.points;
    if (n[0] < 2 || n[1] < 2 || n[2] < 2) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      for (const bool far : {false, true}) {
        std::array<std::uint64_t, 3> cell{};
        cell[axis] = far ? n[axis] - 2 : 0;
        for (cell[v] = 0; cell[v] + 1 < n[v]; ++cell[v]) {
          for (cell[u] = 0; cell[u] + 1 < n[u]; ++cell[u]) add_face(block, cell, 2 * axis + (far ? 1 : 0));
        }
      }
    }
  }
  std::unordered_map<std::uint64_t, unsigned> take() { return std::move(chosen_); }

 private:
  void add_face(const StructuredBlock& block, const std::array<std::uint64_t, 3>& at, std::size_t face) {
    const auto& n = block.points;
    const std::uint64_t cell = block.first_cell + at[0] + (n[0] - 1) * (at[1] + (n[1] - 1) * at[2]);
    if (blanked_[cell]) return;
    std::array<Index, 8> corners{};
    for (std::size_t c = 0; c < 8; ++c) {
      const std::uint64_t i = at[0] + (c == 1 || c == 2 || c == 5 || c == 6 ? 1 : 0);
      const std::uint64_t j = at[1] + (c == 2 || c == 3 || c == 6 || c == 7 ? 1 : 0);
      const std::uint64_t k = at[2] + (c >= 4 ? 1 : 0);
      corners[c] = vertex_of_[block.first_point + i + n[0] * (j + n[1] * k)];
    }
    const auto& places = hexahedron_faces[face];
    FaceKey key{};
    for (std::size_t i = 0; i < 4; ++i) key[i] = corners[static_cast<std::size_t>(places[i])];
    const std::array<Index, 4> around = key;
    std::sort(key.begin(), key.end());
    if (std::adjacent_find(key.begin(), key.end()) != key.end()) return;  // collapsed: any diagonal does
    const auto found = chosen_.find(cell);
    const unsigned own = (at[0] + at[1] + at[2]) % 2 == 1 ? 63U : 0U;
    const unsigned diagonals = found == chosen_.end() ? own : found->second;
    const bool first_is_odd = places[0] == 1 || places[0] == 3 || places[0] == 4 || places[0] == 6;
    const bool takes_first = ((diagonals >> face & 1U) != 0) == first_is_odd;
    const Index end = takes_first ? std::min(around[0], around[2]) : std::min(around[1], around[3]);
    const auto [other, fresh] = faces_.try_emplace(key, end);
    if (fresh || other->second == end) return;
    std::vector<Tetrahedron> pieces;
    const unsigned flipped = diagonals ^ 1U << face;
    if (split_hexahedron(corners, flipped, pieces)) chosen_[cell] = flipped;
  }

  std::span<const Index> vertex_of_;
  const std::vector<bool>& blanked_;
  std::map<FaceKey, Index> faces_;  // the smaller end of the diagonal
  std::unordered_map<std::uint64_t, unsigned> chosen_;
};

}  // namespace

std::unordered_map<std::uint64_t, unsigned> seam_diagonals(std::span<const StructuredBlock> blocks,
                                                           std::span<const Index> vertex_of,
                                                           const std::vector<bool>& blanked) {
  Seams seams(vertex_of, blanked);
  for (const StructuredBlock& block : blocks) seams.add(block);
  return seams.take();
}

}  // namespace atomesh::cli
