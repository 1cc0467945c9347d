#include "preprocess/star_mesh.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace atomesh {

namespace {

constexpr std::size_t most_tetrahedra = std::size_t{1} << 30U;

// Which corner v is, without a branch that could be guessed wrong.
Index corner_at(const Tetrahedron& tet, Index v) {
  return static_cast<Index>(tet[1] == v) + 2 * static_cast<Index>(tet[2] == v) + 3 * static_cast<Index>(tet[3] == v);
}

}  // namespace

void PlaceTable::clear() {
  constexpr std::size_t usual = 128;  // twice the tetrahedra of nearly every star
  if (slots_.size() < usual) slots_.resize(usual);
  mask_ = usual - 1;
  count_ = 0;
  std::fill_n(slots_.begin(), usual, empty);
}

Index PlaceTable::place(Index key, bool& is_new) {
  std::size_t slot = slot_of(key);
  is_new = slots_[slot] == empty;
  if (!is_new) return static_cast<Index>(slots_[slot]);
  slots_[slot] = std::uint64_t{key} << 32U | count_++;
  if (2 * std::size_t{count_} > mask_) grow();
  return count_ - 1;
}

void PlaceTable::grow() {
  const std::vector<std::uint64_t> old(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(mask_ + 1));
  mask_ = 4 * mask_ + 3;
  slots_.assign(std::max(slots_.size(), mask_ + 1), empty);
  for (const std::uint64_t entry : old) {
    if (entry != empty) slots_[slot_of(static_cast<Index>(entry >> 32U))] = entry;
  }
}

StarMesh::StarMesh(std::vector<Tetrahedron> tetrahedra, const std::vector<Vec3>& vertices, Progress& progress)
    : vertices_(vertices), living_(tetrahedra.size()) {
  if (tetrahedra.size() >= most_tetrahedra) throw Error("a mesh of 2^30 tetrahedra or more cannot be simplified");
  TetMesh mesh;  // for face_neighbours(), which wants the number of vertices alone
  mesh.tetrahedra = std::move(tetrahedra);
  mesh.vertices.resize(vertices.size());
  const std::vector<std::array<Index, 4>> neighbours = face_neighbours(mesh, progress);
  tetrahedra_ = std::move(mesh.tetrahedra);
  behind_.assign(4 * tetrahedra_.size(), no_index);
  corner_of_.assign(vertices.size(), no_index);
  surface_.assign(vertices.size(), 0);
  for (Index t = 0; t < neighbours.size(); ++t) {
    if (t % 4096 == 0) progress.check();
    remember_corners(t);
    for (Index f = 0; f < 4; ++f) {
      const Index other = neighbours[t][f];
      if (other == no_index) {
        for (const int corner : face_corners[f]) surface_[tetrahedra_[t][corner]] = 1;
        continue;
      }
      // Its face whose opposite vertex this tetrahedron does not have.
      for (Index g = 0; g < 4; ++g) {
        const Index apex = tetrahedra_[other][g];
        if (std::find(tetrahedra_[t].begin(), tetrahedra_[t].end(), apex) == tetrahedra_[t].end()) {
          behind_[4 * t + f] = 4 * other + g;
        }
      }
    }
  }
}

std::vector<double> StarMesh::shortest_edges(const Progress& progress) const {
  std::vector<double> shortest(vertices_.size(), 0.0);
  std::size_t looked = 0;
  for (const Tetrahedron& tet : tetrahedra_) {
    if (looked++ % 4096 == 0) progress.check();
    if (tet[0] == no_index) continue;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const Vec3 edge = vertices_[tet[j]] - vertices_[tet[i]];
        const double squared = glm::dot(edge, edge);
        for (const Index v : {tet[i], tet[j]}) {
          if (shortest[v] == 0.0 || squared < shortest[v]) shortest[v] = squared;
        }
      }
    }
  }
  return shortest;
}

void StarMesh::gather(Index v, Star& star) {
  star.vertex = v;
  star.corners.clear();
  star.link.clear();
  star.triangles.clear();
  star_tetrahedra_.clear();
  star_vertices_.clear();
  const auto add = [&](Corner corner) {
    bool is_new = false;
    star_tetrahedra_.place(corner / 4, is_new);
    if (is_new) star.corners.push_back(corner);
  };
  add(corner_of_[v]);
  for (std::size_t i = 0; i < star.corners.size(); ++i) {
    const Corner corner = star.corners[i];
    const Index t = corner / 4;
    Triangle triangle{};
    for (int k = 0; k < 3; ++k) {
      const auto f = static_cast<Index>(face_corners[corner % 4][k]);
      const Index w = tetrahedra_[t][f];
      bool is_new = false;
      triangle[k] = star_vertices_.place(w, is_new);
      if (is_new) star.link.push_back(w);
      const Index other = behind_[4 * t + f] / 4;
      add(4 * other + corner_at(tetrahedra_[other], v));
    }
    star.triangles.push_back(triangle);
  }
}

void StarMesh::collapse(const Star& star, Index target) {
  const Index u = star.link[target];
  for (std::size_t i = 0; i < star.corners.size(); ++i) {
    const Corner corner = star.corners[i];
    const Index t = corner / 4;
    Tetrahedron& tet = tetrahedra_[t];
    const Triangle& triangle = star.triangles[i];
    const auto k = static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), target) - triangle.begin());
    if (k == 3) {
      tet[corner % 4] = u;
      continue;
    }
    // Squeezed flat: what was behind the face without v now meets what was behind the face without u.
    join(behind_[4 * t + static_cast<Index>(face_corners[corner % 4][k])], behind_[corner]);
    tet[0] = no_index;
    vacant_.push_back(t);
    --living_;
  }
  for (const Corner corner : star.corners) {
    if (tetrahedra_[corner / 4][0] != no_index) remember_corners(corner / 4);
  }
  corner_of_[star.vertex] = no_index;
}

bool StarMesh::refill(std::span<const Index> cells, std::span<const Corner> faces, std::span<const Tetrahedron> fill) {
  // Faces of the fill are numbered from 0, those of the hole from `hole` on. Each must meet one other, at least one of
  // the two in the fill.
  const auto hole = static_cast<Corner>(4 * fill.size());
  pairs_.clear();
  std::size_t table = 64;
  while (table < 2 * (hole + faces.size())) table *= 2;
  open_.assign(table, {0, no_index, no_index});
  std::size_t open_faces = 0;
  const auto meet = [&](const Tetrahedron& tet, Index f, Corner face) {
    Index a = tet[face_corners[f][0]], b = tet[face_corners[f][1]], c = tet[face_corners[f][2]];
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    const std::uint64_t smaller = std::uint64_t{a} << 32U | b;
    std::size_t slot = ((smaller ^ std::uint64_t{c} << 17U) * 0x9E3779B97F4A7C15U >> 40U) & (table - 1);
    while (open_[slot].largest != no_index && (open_[slot].smaller != smaller || open_[slot].largest != c)) {
      slot = (slot + 1) & (table - 1);
    }
    OpenFace& open = open_[slot];
    if (open.largest == no_index) {
      open = {smaller, c, face};
      ++open_faces;
      return true;
    }
    if (open.face == no_index) return false;  // a third
    pairs_.emplace_back(open.face, face);
    open.face = no_index;
    --open_faces;
    return true;
  };
  for (std::size_t t = 0; t < fill.size(); ++t) {
    for (Index f = 0; f < 4; ++f) {
      if (!meet(fill[t], f, static_cast<Corner>(4 * t + f))) return false;
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!meet(tetrahedra_[faces[i] / 4], faces[i] % 4, hole + static_cast<Corner>(i))) return false;
  }
  if (open_faces != 0) return false;
  for (const auto& [one, other] : pairs_) {
    if (one >= hole) return false;  // two of the hole's own: `one` came first, and the fill came before the hole
  }

  outside_.clear();
  for (const Corner face : faces) outside_.push_back(behind_[face]);
  for (const Index cell : cells) {
    for (const Index v : tetrahedra_[cell]) corner_of_[v] = no_index;
    tetrahedra_[cell][0] = no_index;
    vacant_.push_back(cell);
  }
  living_ -= cells.size();
  slots_.clear();
  for (const Tetrahedron& tet : fill) {
    if (vacant_.empty()) {
      vacant_.push_back(static_cast<Index>(tetrahedra_.size()));
      tetrahedra_.emplace_back();
      behind_.resize(behind_.size() + 4, no_index);
    }
    slots_.push_back(vacant_.back());
    vacant_.pop_back();
    tetrahedra_[slots_.back()] = tet;
    remember_corners(slots_.back());
    ++living_;
  }
  for (const auto& [one, other] : pairs_) {
    const Corner inner = 4 * slots_[one / 4] + one % 4;
    join(inner, other < hole ? 4 * slots_[other / 4] + other % 4 : outside_[other - hole]);
  }
  return true;
}

Index StarMesh::across(Corner face) const {
  const Corner other = behind_[face];
  return other == no_index ? no_index : tetrahedra_[other / 4][other % 4];
}

std::vector<Tetrahedron> StarMesh::take() {
  std::erase_if(tetrahedra_, [](const Tetrahedron& tet) { return tet[0] == no_index; });
  return std::move(tetrahedra_);
}

}  // namespace atomesh
