#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "app/cli/grid_seams.h"
#include "app/cli/inner_walls.h"
#include "app/cli/mesh_cells.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/predicates.h"
#include "core/shared_faces.h"
#include "core/surface.h"

namespace atomesh::cli {

namespace {

constexpr std::size_t items_per_check = 1 << 14;

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t h = 0;
    // Adding zero makes -0 and +0, which compare equal, hash equal.
    for (const double c : {p.x, p.y, p.z}) h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(h ^ (h >> 32U));
  }
};

class MeshBuilder {
 public:
  MeshBuilder(const MeshCells& cells, const std::string& path, MeshFileReport& report, Progress& progress)
      : cells_(cells), path_(path), report_(report), progress_(progress) {}

  Material build() {
    report_.points = cells_.points.size();
    report_.notes.insert(report_.notes.end(), cells_.notes.begin(), cells_.notes.end());
    choose_cells();
    progress_.update(0.2);
    check_points();
    choose_fields();
    merge_points();
    progress_.update(0.4);
    split();
    progress_.update(0.7);
    separate_overlapping();
    progress_.update(0.8);
    drop_unused_vertices();
    m_.mesh.vertex_atom.assign(m_.mesh.vertices.size(), no_index);
    m_.surface = extract_surface(m_.mesh, progress_);
    report_.tetrahedra = m_.mesh.tetrahedra.size();
    add_notes();
    progress_.update(1.0);
    return std::move(m_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(path_, 0, message); }

  // ---- cells

  // visit(cell, corners as points, odd) for all cells with volume; corners of a polyhedron with the numbers of its
  // faces, `odd` for every other hexahedron of a block.
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    for (std::size_t c = 0; c < cells_.kinds.size(); ++c) {
      if (c % items_per_check == 0) progress_.check();
      if (cells_.kinds[c] == FileCell::without_volume || cells_.kinds[c] == FileCell::unknown) continue;
      visit(c, std::span(cells_.corners).subspan(cells_.first[c], cells_.first[c + 1] - cells_.first[c]), false);
    }
    for (const StructuredBlock& block : cells_.blocks) {
      const auto& [ni, nj, nk] = block.points;
      std::uint64_t cell = block.first_cell;
      for (std::uint64_t k = 0; k + 1 < nk; ++k) {
        for (std::uint64_t j = 0; j + 1 < nj; ++j) {
          progress_.check();
          for (std::uint64_t i = 0; i + 1 < ni; ++i, ++cell) {
            const std::uint64_t p = block.first_point + i + ni * (j + nj * k);
            const std::uint64_t up = ni * nj;
            const std::array<std::uint64_t, 8> corners{p,      p + 1,      p + 1 + ni,      p + ni,
                                                       p + up, p + 1 + up, p + 1 + ni + up, p + ni + up};
            visit(cell, std::span<const std::uint64_t>(corners), (i + j + k) % 2 == 1);
          }
        }
      }
    }
  }

  bool is_polyhedron(std::size_t cell) const {
    return cell < cells_.kinds.size() && cells_.kinds[cell] == FileCell::polyhedron;
  }

  // The points of a cell, without the counts of a polyhedron's faces.
  template <class Visit>
  void for_each_corner(std::size_t cell, std::span<const std::uint64_t> corners, Visit&& visit) const {
    if (!is_polyhedron(cell)) {
      for (const std::uint64_t p : corners) visit(p);
      return;
    }
    for (std::size_t at = 0; at < corners.size(); at += corners[at] + 1) {
      for (const std::uint64_t p : corners.subspan(at + 1, corners[at])) visit(p);
    }
  }

  void choose_cells() {
    used_.assign(cells_.points.size(), false);
    std::uint64_t tetrahedra = 0;
    report_.skipped =
        static_cast<std::uint64_t>(std::count(cells_.kinds.begin(), cells_.kinds.end(), FileCell::without_volume));
    for_each_cell([&](std::size_t cell, std::span<const std::uint64_t> corners, bool) {
      bool blanked = !cells_.blanked_cells.empty() && cells_.blanked_cells[cell];
      for_each_corner(cell, corners, [&](std::uint64_t p) {
        if (p >= cells_.points.size()) {
          fail("cell " + std::to_string(cell) + " names point " + std::to_string(static_cast<std::int64_t>(p)) +
               ", but there are " + std::to_string(cells_.points.size()));
        }
        blanked = blanked || (!cells_.blanked_points.empty() && cells_.blanked_points[p]);
      });
      if (blanked_.size() <= cell) blanked_.resize(cell + 1, false);
      blanked_[cell] = blanked;
      if (blanked) {
        ++report_.blanked;
        return;
      }
      ++report_.cells;
      tetrahedra += corners.size() == 4 ? 1 : corners.size() == 8 && cells_.kinds.empty() ? 5 : corners.size();
      for_each_corner(cell, corners, [&](std::uint64_t p) { used_[p] = true; });
    });
    if (report_.cells == 0) {
      fail(report_.blanked > 0 ? "all its cells are blanked" : "has no cells with volume; nothing can be drawn of it");
    }
    if (tetrahedra >= no_index) fail("more than 4,294,967,294 tetrahedra");
    if (cells_.points.size() >= no_index) fail("more than 4,294,967,294 points");
    // The mesh, who shares its faces, and the points on their way to be vertices.
    require_memory("splitting " + std::to_string(report_.cells) + " cells into tetrahedra",
                   48 * tetrahedra + (64 + 8 * cells_.point_fields.size()) * cells_.points.size(),
                   "Cut or thin out the mesh first, or use a machine with more memory.");
  }

  void check_points() const {
    // Volumes are third powers, which must be finite too.
    constexpr double largest = 1e100;
    for (std::size_t p = 0; p < used_.size(); ++p) {
      if (!used_[p]) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double c = cells_.points[p][axis];
        if (!std::isfinite(c)) fail("a coordinate of point " + std::to_string(p) + " is not a finite number");
        if (std::abs(c) > largest) fail("a coordinate of point " + std::to_string(p) + " is beyond 1e100");
      }
    }
  }

  // ---- fields

  std::string unique_name(std::string name) {
    for (char& c : name) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    }
    const std::string stem = name;
    for (int i = 2; !names_.insert(name).second; ++i) name = stem + "_" + std::to_string(i);
    return name;
  }

  void choose_fields() {
    const auto choose = [&](const std::vector<VertexField>& fields, auto&& counts, const char* of) {
      std::vector<const VertexField*> kept;
      for (const VertexField& field : fields) {
        std::size_t bad = 0;
        for (std::size_t i = 0; i < field.values.size(); ++i) bad += counts(i) && !std::isfinite(field.values[i]);
        if (bad == 0) {
          kept.push_back(&field);
          continue;
        }
        report_.notes.push_back("field " + field.name + " was left out: it is not a finite number at " +
                                std::to_string(bad) + " " + of);
      }
      return kept;
    };
    point_fields_ = choose(
        cells_.point_fields, [&](std::size_t p) { return used_[p]; }, "points");
    cell_fields_ = choose(
        cells_.cell_fields, [&](std::size_t c) { return c < blanked_.size() && !blanked_[c]; }, "cells");
    for (const VertexField* field : point_fields_) m_.fields.push_back({unique_name(field->name), {}});
    for (const VertexField* field : cell_fields_) {
      m_.fields.push_back({unique_name(names_.contains(field->name) ? field->name + "_cell" : field->name), {}});
    }
  }

  // ---- vertices

  // Points of one place and equal values become one vertex: grids that close on themselves, blocks that touch,
  // collapsed edges and cells that do not share their points hold together. Where the values differ there is a jump to
  // keep; any number of points may share a place, so the values are hashed too.
  void merge_points() {
    const auto hash = [&](std::size_t p) {
      std::uint64_t h = PositionHash{}(cells_.points[p]);
      for (const VertexField* field : point_fields_) {
        h = (h ^ std::bit_cast<std::uint32_t>(field->values[p] + 0.0F)) * 0x9E3779B97F4A7C15U;
        h ^= h >> 32U;
      }
      return static_cast<std::size_t>(h);
    };
    const auto same = [&](std::size_t a, std::size_t b) {
      return cells_.points[a] == cells_.points[b] &&
             std::all_of(point_fields_.begin(), point_fields_.end(),
                         [&](const VertexField* field) { return field->values[a] == field->values[b]; });
    };
    vertex_of_.assign(cells_.points.size(), no_index);
    std::unordered_set<std::size_t, decltype(hash), decltype(same)> first(cells_.points.size(), hash, same);  // points
    for (std::size_t p = 0; p < used_.size(); ++p) {
      if (p % items_per_check == 0) progress_.check();
      if (!used_[p]) continue;
      const auto [at, fresh] = first.insert(p);
      if (!fresh) {
        vertex_of_[p] = vertex_of_[*at];
        ++merged_;
        continue;
      }
      vertex_of_[p] = static_cast<Index>(m_.mesh.vertices.size());
      m_.mesh.vertices.push_back(cells_.points[p]);
      for (std::size_t f = 0; f < point_fields_.size(); ++f) {
        m_.fields[f].values.push_back(point_fields_[f]->values[p]);
      }
    }
  }

  // ---- tetrahedra

  void split_cell_into(std::size_t cell, std::span<const std::uint64_t> corners, bool odd,
                       std::vector<Tetrahedron>& pieces) {
    vertices_.clear();
    if (!is_polyhedron(cell)) {
      for (const std::uint64_t p : corners) vertices_.push_back(vertex_of_[p]);
      if (cells_.kinds.empty()) {
        const auto seam = seams_.find(cell);
        const unsigned diagonals = seam != seams_.end() ? seam->second : odd ? 63U : 0U;
        split_hexahedron(std::span<const Index, 8>(vertices_.data(), 8), diagonals, pieces);
      } else {
        split_cell(cells_.shapes[cell], vertices_, pieces);
      }
      return;
    }
    std::vector<std::vector<Index>> faces;
    for (std::size_t at = 0; at < corners.size(); at += corners[at] + 1) {
      faces.emplace_back();
      for (const std::uint64_t p : corners.subspan(at + 1, corners[at])) faces.back().push_back(vertex_of_[p]);
    }
    split_polyhedron(faces, pieces);
  }

  void split() {
    std::vector<Vec3>& vertices = m_.mesh.vertices;
    std::vector<std::vector<double>> sums(cell_fields_.size(), std::vector<double>(vertices.size(), 0.0));
    std::vector<Index> touching(cell_fields_.empty() ? 0 : vertices.size(), 0);
    std::vector<Tetrahedron> pieces;
    seams_ = seam_diagonals(cells_.blocks, vertex_of_, blanked_);
    for_each_cell([&](std::size_t cell, std::span<const std::uint64_t> corners, bool odd) {
      if (blanked_[cell]) return;
      pieces.clear();
      split_cell_into(cell, corners, odd, pieces);
      if (pieces.empty()) ++report_.flat;
      std::uint64_t upright = 0;
      std::uint64_t inside_out = 0;
      for (Tetrahedron& t : pieces) {
        const int sign = orientation(vertices[t[0]], vertices[t[1]], vertices[t[2]], vertices[t[3]]);
        report_.flat += sign == 0 ? 1 : 0;
        if (sign == 0) continue;
        ++(sign < 0 ? inside_out : upright);
        if (sign < 0) std::swap(t[2], t[3]);
        m_.mesh.tetrahedra.push_back(t);
      }
      // A cell all of whose pieces are inside out is listed so; one with pieces of both senses is folded.
      if (upright == 0) report_.turned += inside_out;
      folded_ += upright > 0 && inside_out > 0 ? 1 : 0;
      if (cell_fields_.empty()) return;
      for_each_corner(cell, corners, [&](std::uint64_t p) {
        ++touching[vertex_of_[p]];
        for (std::size_t f = 0; f < sums.size(); ++f) sums[f][vertex_of_[p]] += cell_fields_[f]->values[cell];
      });
    });
    if (m_.mesh.tetrahedra.empty()) fail("all its cells are flat; nothing can be drawn of it");
    for (std::size_t f = 0; f < sums.size(); ++f) {
      std::vector<float>& values = m_.fields[point_fields_.size() + f].values;
      values.resize(vertices.size());
      for (std::size_t v = 0; v < values.size(); ++v) {
        values[v] = touching[v] == 0 ? 0.0F : static_cast<float>(sums[f][v] / touching[v]);
      }
    }
  }

  // A mesh may share a face once, between two tetrahedra on its two sides. Of what a file stacks on one side all but
  // one get vertices of their own: nothing is lost, and what is left of the mesh is sound.
  void separate_overlapping() {
    TetMesh& mesh = m_.mesh;
    constexpr std::uint8_t twin = 1, overlapping = 2;
    const SharedFaces faces(mesh, progress_);
    const auto sense = [&](const FaceEntry& entry) {
      const Tetrahedron& t = mesh.tetrahedra[entry.tetrahedron];
      std::array<Index, 3> c{};
      for (std::size_t i = 0; i < 3; ++i) c[i] = t[static_cast<std::size_t>(face_corners[entry.face][i])];
      return ((c[0] < c[1] ? 1 : 0) + (c[1] < c[2] ? 1 : 0) + (c[2] < c[0] ? 1 : 0)) % 2 == 0;
    };
    // visit(tetrahedra on one side of a face), where these are more than one.
    const auto for_each_heap = [&](auto&& visit) {
      faces.for_each(
          [&](std::size_t, Index, std::span<const FaceEntry> sharing) {
            if (sharing.size() == 1 || (sharing.size() == 2 && sense(sharing[0]) != sense(sharing[1]))) return;
            for (const bool side : {false, true}) {
              std::vector<Index> heap;
              for (const FaceEntry& entry : sharing) {
                if (sense(entry) == side) heap.push_back(entry.tetrahedron);
              }
              if (heap.size() > 1) visit(heap);
            }
          },
          progress_);
    };
    std::vector<Index> heaps(mesh.tetrahedra.size(), 0);  // that a tetrahedron is in
    std::atomic<bool> any{false};
    for_each_heap([&](const std::vector<Index>& heap) {
      any = true;
      for (const Index t : heap) std::atomic_ref(heaps[t]).fetch_add(1, std::memory_order_relaxed);
    });
    if (!any) return;
    std::vector<std::uint8_t> marks(mesh.tetrahedra.size(), 0);
    const auto corners = [&](Index t) {
      Tetrahedron sorted = mesh.tetrahedra[t];
      std::sort(sorted.begin(), sorted.end());
      return sorted;
    };
    for_each_heap([&](const std::vector<Index>& heap) {
      // One that folds back lies over most of its neighbours, each of which lies over it alone.
      const Index kept = *std::min_element(
          heap.begin(), heap.end(), [&](Index a, Index b) { return std::pair(heaps[a], a) < std::pair(heaps[b], b); });
      for (const Index t : heap) {
        if (t == kept) continue;
        std::atomic_ref(marks[t]).fetch_or(corners(t) == corners(kept) ? twin : overlapping, std::memory_order_relaxed);
      }
    });
    std::vector<Tetrahedron> sound;
    sound.reserve(mesh.tetrahedra.size());
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      if ((marks[t] & twin) != 0) {
        ++twins_;
        continue;
      }
      Tetrahedron tetrahedron = mesh.tetrahedra[t];
      if (marks[t] != 0) {
        ++overlapping_;
        for (Index& v : tetrahedron) v = copy_of(v);
      }
      sound.push_back(tetrahedron);
    }
    mesh.tetrahedra = std::move(sound);
  }

  Index copy_of(Index v) {
    const auto copy = static_cast<Index>(m_.mesh.vertices.size());
    if (copy == no_index) fail("more than 4,294,967,294 vertices");
    m_.mesh.vertices.push_back(Vec3(m_.mesh.vertices[v]));
    for (VertexField& field : m_.fields) field.values.push_back(float(field.values[v]));
    return copy;
  }

  void drop_unused_vertices() {
    TetMesh& mesh = m_.mesh;
    std::vector<Index> to(mesh.vertices.size(), no_index);
    for (const Tetrahedron& t : mesh.tetrahedra) {
      for (const Index v : t) to[v] = 0;
    }
    Index kept = 0;
    for (std::size_t v = 0; v < to.size(); ++v) {
      if (to[v] == no_index) continue;
      to[v] = kept;
      mesh.vertices[kept] = mesh.vertices[v];
      for (VertexField& field : m_.fields) field.values[kept] = field.values[v];
      ++kept;
    }
    mesh.vertices.resize(kept);
    for (VertexField& field : m_.fields) field.values.resize(kept);
    for (Tetrahedron& t : mesh.tetrahedra) {
      for (Index& v : t) v = to[v];
    }
  }

  void add_notes() {
    const auto note = [&](std::uint64_t count, const std::string& text) {
      if (count > 0) report_.notes.push_back(std::to_string(count) + " " + text);
    };
    note(report_.skipped, "cells without volume (points, lines, polygons) were left out");
    note(report_.blanked, "blanked cells were left out");
    note(report_.flat, "flat tetrahedra were left out");
    note(report_.turned, report_.turned == report_.tetrahedra ? "tetrahedra, all of them, are listed inside out"
                                                              : "tetrahedra that are listed inside out were turned");
    note(folded_, "cells are folded or not convex; their tetrahedra overlap");
    note(twins_, "tetrahedra that stand twice were left out once");
    note(overlapping_, "tetrahedra overlap another at a face; they got faces of their own, which the surface shows");
    note(count_inner_walls(m_.surface, m_.mesh.vertices),
         "faces of the surface lie back to back inside the mesh (hanging vertices, faces that neighbours split "
         "differently, or values that jump); they stay as inner walls");
    note(merged_, "points that repeat another's place and values were merged with it");
    if (m_.fields.empty()) {
      report_.notes.emplace_back("there is no scalar in it: mode volume shows nothing, the other modes its shape");
    }
  }

  const MeshCells& cells_;
  const std::string& path_;
  MeshFileReport& report_;
  Progress& progress_;
  std::vector<bool> used_;     // points
  std::vector<bool> blanked_;  // cells
  std::vector<const VertexField*> point_fields_;
  std::vector<const VertexField*> cell_fields_;
  std::set<std::string> names_;
  std::vector<Index> vertex_of_;                       // points
  std::unordered_map<std::uint64_t, unsigned> seams_;  // cells
  std::vector<Index> vertices_;                        // of the cell at hand
  std::uint64_t merged_ = 0;
  std::uint64_t folded_ = 0;  // cells
  std::uint64_t twins_ = 0;
  std::uint64_t overlapping_ = 0;
  Material m_;
};

}  // namespace

Material build_mesh(const MeshCells& cells, const std::string& path, MeshFileReport& report, Progress& progress) {
  return MeshBuilder(cells, path, report, progress).build();
}

}  // namespace atomesh::cli
