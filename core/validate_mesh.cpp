#include <algorithm>
#include <cmath>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/predicates.h"
#include "core/tet_mesh.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_check = 1 << 14;

// Collects complaints; full() once there are enough.
class Complaints {
 public:
  explicit Complaints(std::size_t limit) : limit_(limit) {}
  bool full() const { return found_.size() >= limit_; }
  void add(std::string complaint) {
    if (!full()) found_.push_back(std::move(complaint));
  }
  bool none() const { return found_.empty(); }
  std::vector<std::string> take() { return std::move(found_); }

 private:
  std::size_t limit_;
  std::vector<std::string> found_;
};

std::string name(std::string_view kind, std::size_t index) {
  return std::string(kind) + " " + std::to_string(index);
}

void check_vertices(const TetMesh& mesh, Complaints& complaints) {
  for (std::size_t v = 0; v < mesh.vertices.size() && !complaints.full(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      complaints.add(name("vertex", v) + " has a coordinate that is not finite");
    }
  }
  if (mesh.vertex_atom.size() != mesh.vertices.size()) {
    complaints.add(std::to_string(mesh.vertices.size()) + " vertices but " + std::to_string(mesh.vertex_atom.size()) +
                   " entries in vertex_atom");
  }
  std::vector<Index> atoms = mesh.vertex_atom;
  std::erase(atoms, no_index);
  std::sort(atoms.begin(), atoms.end());
  for (auto i = std::adjacent_find(atoms.begin(), atoms.end()); i != atoms.end() && !complaints.full();
       i = std::adjacent_find(i + 1, atoms.end())) {
    complaints.add(name("atom", *i) + " has more than one vertex");
  }
}

// False when the indices are such that geometry cannot be looked at.
bool check_indices(const TetMesh& mesh, Complaints& complaints, Progress& progress) {
  bool usable = true;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (t % tetrahedra_per_check == 0) progress.check();
    Tetrahedron sorted = mesh.tetrahedra[t];
    std::sort(sorted.begin(), sorted.end());
    if (sorted[3] >= mesh.vertices.size()) {
      usable = false;
      complaints.add(name("tetrahedron", t) + " names vertex " + std::to_string(sorted[3]) + " of " +
                     std::to_string(mesh.vertices.size()));
    } else if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      usable = false;
      complaints.add(name("tetrahedron", t) + " names a vertex twice");
    }
  }
  return usable;
}

// Which face of `tet` has `other` behind it; 4 when none.
int face_towards(const std::array<Index, 4>& neighbours, Index other) {
  return static_cast<int>(std::find(neighbours.begin(), neighbours.end(), other) - neighbours.begin());
}

// True when triangle b runs through the corners of a the other way round.
bool opposite_sense(const Triangle& a, const Triangle& b) {
  const int start = static_cast<int>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return start < 3 && b[(start + 1) % 3] == a[2] && b[(start + 2) % 3] == a[1];
}

Triangle face_of(const Tetrahedron& tet, int f) {
  return {tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]};
}

bool deep_inside(const Sphere& sphere, const Vec3& p) {
  return sphere.radius - glm::length(p - sphere.center) > delaunay_tolerance * sphere.radius;
}

void check_faces(const TetMesh& mesh, Complaints& complaints, Progress& progress) {
  std::vector<std::array<Index, 4>> neighbours;
  try {
    neighbours = face_neighbours(mesh, progress);
  } catch (const CancelledError&) {
    throw;
  } catch (const std::exception& error) {
    complaints.add(error.what());
    return;
  }
  for (std::size_t t = 0; t < mesh.tetrahedra.size() && !complaints.full(); ++t) {
    if (t % tetrahedra_per_check == 0) progress.check();
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int f = 0; f < 4; ++f) {
      const Index other = neighbours[t][f];
      if (other == no_index || other < t) continue;
      const int g = face_towards(neighbours[other], static_cast<Index>(t));
      const std::string pair = "tetrahedra " + std::to_string(t) + " and " + std::to_string(other);
      if (std::count(neighbours[t].begin(), neighbours[t].end(), other) > 1 ||
          !opposite_sense(face_of(tet, f), face_of(mesh.tetrahedra[other], g))) {
        complaints.add(pair + " lie on the same side of the face they share");
      } else if (mesh.delaunay) {
        const auto& v = mesh.vertices;
        const Vec3& apex = v[mesh.tetrahedra[other][g]];
        if (in_sphere(v[tet[0]], v[tet[1]], v[tet[2]], v[tet[3]], apex) > 0 &&
            deep_inside(circumsphere(v[tet[0]], v[tet[1]], v[tet[2]], v[tet[3]]), apex)) {
          complaints.add(pair + " are not Delaunay: each has a vertex inside the other's circumsphere");
        }
      }
    }
  }
}

}  // namespace

std::vector<std::string> validate(const TetMesh& mesh, std::size_t limit, Progress& progress) {
  Complaints complaints(limit);
  check_vertices(mesh, complaints);
  if (!check_indices(mesh, complaints, progress)) return complaints.take();
  for (std::size_t t = 0; t < mesh.tetrahedra.size() && !complaints.full(); ++t) {
    if (t % tetrahedra_per_check == 0) progress.check();
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const int sign = orientation(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]);
    if (sign == 0) complaints.add(name("tetrahedron", t) + " is flat");
    if (sign < 0) complaints.add(name("tetrahedron", t) + " is inverted");
  }
  // Flat and inverted tetrahedra would only repeat themselves as faults of their faces.
  if (complaints.none()) check_faces(mesh, complaints, progress);
  return complaints.take();
}

}  // namespace atomesh
