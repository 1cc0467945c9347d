#include "core/shared_faces.h"

#include <string>
#include <utility>

#include "core/error.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_check = 1 << 16;

// The smallest and the second smallest.
std::pair<Index, Index> two_smallest(const Tetrahedron& t) {
  const Index a = std::min(t[0], t[1]);
  const Index b = std::max(t[0], t[1]);
  const Index c = std::min(t[2], t[3]);
  const Index d = std::max(t[2], t[3]);
  return a < c ? std::pair(a, std::min(b, c)) : std::pair(c, std::min(a, d));
}

}  // namespace

SharedFaces::SharedFaces(const TetMesh& mesh, Progress& progress)
    : mesh_(mesh), first_(mesh.vertices.size() + 2, 0), filed_(2 * mesh.tetrahedra.size()) {
  const std::size_t count = mesh.tetrahedra.size();
  // Counted two places ahead, so that filling moves each vertex's start to where it belongs.
  for (std::size_t t = 0; t < count; ++t) {
    if (t % tetrahedra_per_check == 0) progress.check();
    const auto [smallest, second] = two_smallest(mesh.tetrahedra[t]);
    ++first_[std::size_t{smallest} + 2];
    ++first_[std::size_t{second} + 2];
  }
  for (std::size_t v = 2; v < first_.size(); ++v) first_[v] += first_[v - 1];
  for (std::size_t t = 0; t < count; ++t) {
    if (t % tetrahedra_per_check == 0) progress.check();
    const auto [smallest, second] = two_smallest(mesh.tetrahedra[t]);
    filed_[first_[std::size_t{smallest} + 1]++] = static_cast<Index>(t);
    filed_[first_[std::size_t{second} + 1]++] = static_cast<Index>(t);
  }
}

void SharedFaces::collect(Index v, std::vector<FaceEntry>& faces) const {
  faces.clear();
  for (std::uint64_t i = first_[v]; i < first_[std::size_t{v} + 1]; ++i) {
    const Tetrahedron& tet = mesh_.tetrahedra[filed_[i]];
    for (Index f = 0; f < 4; ++f) {
      const auto& corner = face_corners[f];
      Index a = tet[static_cast<std::size_t>(corner[0])];
      Index b = tet[static_cast<std::size_t>(corner[1])];
      Index c = tet[static_cast<std::size_t>(corner[2])];
      if (std::min({a, b, c}) != v) continue;
      if (b == v) std::swap(a, b);
      if (c == v) std::swap(a, c);
      faces.push_back({std::uint64_t{std::min(b, c)} << 32 | std::max(b, c), filed_[i], f});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const FaceEntry& x, const FaceEntry& y) {
    return x.larger != y.larger ? x.larger < y.larger : x.tetrahedron < y.tetrahedron;
  });
}

void require_at_most_two(Index v, std::span<const FaceEntry> sharing) {
  if (sharing.size() <= 2) return;
  const std::uint64_t larger = sharing[0].larger;
  throw Error("the face of vertices " + std::to_string(v) + ", " + std::to_string(larger >> 32) + ", " +
              std::to_string(larger & 0xffffffffU) + " belongs to " + std::to_string(sharing.size()) +
              " tetrahedra; at most two can share it");
}

}  // namespace atomesh
