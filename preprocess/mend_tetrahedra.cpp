#include "preprocess/mend_tetrahedra.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/circumsphere.h"
#include "core/parallel.h"
#include "core/predicates.h"
#include "preprocess/local_mesh.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;
constexpr std::size_t most_cavity_vertices = 48;
constexpr std::size_t most_steps = 2'000;

int sign(const Tetrahedron& t, std::span<const Vec3> p) {
  return orientation(p[t[0]], p[t[1]], p[t[2]], p[t[3]]);
}

double volume_of(const Tetrahedron& t, std::span<const Vec3> p) {
  return signed_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]);
}

// Searches a filling of a cavity whose outward faces are given.
class CavityFiller {
 public:
  CavityFiller(std::vector<Triangle> faces, std::vector<Index> vertices, double volume, std::span<const Vec3> points,
               const Progress& progress)
      : points_(points), vertices_(std::move(vertices)), room_(volume * (1.0 + 1e-9)), progress_(progress) {
    for (const Triangle& face : faces) front_.insert(rotated(face));
  }

  bool fill() { return step() && all_used(); }
  const std::vector<Tetrahedron>& filling() const { return filling_; }

 private:
  struct Apex {
    double radius;
    Index vertex;
  };

  // The vertices that make a positive tetrahedron with the face and none of the others in it, small circumspheres
  // first.
  std::vector<Apex> apexes(const Triangle& face) const {
    std::vector<Apex> found;
    for (const Index v : vertices_) {
      if (v == face[0] || v == face[1] || v == face[2]) continue;
      const Tetrahedron tet{face[0], face[2], face[1], v};
      if (sign(tet, points_) <= 0 || !is_empty(tet)) continue;
      const auto& p = points_;
      found.push_back({circumsphere(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]).radius, v});
    }
    std::sort(found.begin(), found.end(), [](const Apex& a, const Apex& b) {
      return a.radius != b.radius ? a.radius < b.radius : a.vertex < b.vertex;
    });
    return found;
  }

  bool is_empty(const Tetrahedron& tet) const {
    return std::none_of(vertices_.begin(), vertices_.end(), [&](Index v) {
      if (std::find(tet.begin(), tet.end(), v) != tet.end()) return false;
      for (int f = 0; f < 4; ++f) {
        const Triangle face = outward_face(tet, f);
        if (sign({face[0], face[2], face[1], v}, points_) < 0) return false;
      }
      return true;
    });
  }

  bool step() {
    if (front_.empty()) return true;
    if (++steps_ > most_steps) return false;
    progress_.check();
    // The face with the fewest choices.
    Triangle face{};
    std::vector<Apex> choices;
    bool any = false;
    for (const Triangle& candidate : front_) {
      std::vector<Apex>& known = apexes_[candidate];
      if (known.empty()) known = apexes(candidate);
      std::vector<Apex> possible;
      for (const Apex& apex : known) {
        if (fits({candidate[0], candidate[2], candidate[1], apex.vertex})) possible.push_back(apex);
      }
      if (possible.empty()) return false;
      if (any && possible.size() >= choices.size()) continue;
      any = true;
      face = candidate;
      choices = std::move(possible);
      if (choices.size() == 1) break;
    }
    for (const Apex& apex : choices) {
      const Tetrahedron tet{face[0], face[2], face[1], apex.vertex};
      const double volume = volume_of(tet, points_);
      std::vector<Triangle> added;
      std::vector<Triangle> met;
      place(tet, added, met);
      room_ -= volume;
      filling_.push_back(tet);
      if (step()) return true;
      filling_.pop_back();
      room_ += volume;
      for (const Triangle& t : added) front_.erase(t);
      for (const Triangle& t : met) front_.insert(t);
      if (steps_ > most_steps) return false;
    }
    return false;
  }

  // Whether the tetrahedron overlaps nothing that is outside what is to be filled, as far as faces tell.
  bool fits(const Tetrahedron& tet) const {
    if (volume_of(tet, points_) > room_) return false;
    for (int f = 0; f < 4; ++f) {
      const Triangle face = outward_face(tet, f);
      if (front_.contains(rotated({face[0], face[2], face[1]}))) return false;
    }
    return true;
  }

  // Takes the tetrahedron out of what is to be filled.
  void place(const Tetrahedron& tet, std::vector<Triangle>& added, std::vector<Triangle>& met) {
    for (int f = 0; f < 4; ++f) {
      const Triangle face = rotated(outward_face(tet, f));
      if (front_.erase(face) > 0) {
        met.push_back(face);
        continue;
      }
      added.push_back(rotated({face[0], face[2], face[1]}));
      front_.insert(added.back());
    }
  }

  bool all_used() const {
    return std::all_of(vertices_.begin(), vertices_.end(), [&](Index v) {
      return std::any_of(filling_.begin(), filling_.end(),
                         [&](const Tetrahedron& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
    });
  }

  std::span<const Vec3> points_;
  std::vector<Index> vertices_;
  std::set<Triangle> front_;  // outward faces of what is to be filled
  std::map<Triangle, std::vector<Apex>> apexes_;
  std::vector<Tetrahedron> filling_;
  double room_;
  const Progress& progress_;
  std::size_t steps_ = 0;
};

class Mender {
 public:
  Mender(LocalMesh& mesh, std::span<const Vec3> points, MendReport& report, const Progress& progress)
      : mesh_(mesh), points_(points), report_(report), progress_(progress) {}

  bool mend(std::vector<Index> bad) {
    // From the outside inward: what one removal uncovers may go next.
    for (bool changed = true; changed;) {
      changed = false;
      progress_.check();
      for (Index& t : bad) {
        if (t == no_index || !mesh_.alive(t) || !is_outside(t)) continue;
        remove(t);
        ++report_.removed;
        t = no_index;
        changed = true;
      }
    }
    for (const Index t : bad) {
      progress_.check();
      if (t == no_index || !mesh_.alive(t)) continue;  // gone with a neighbour
      if (!replace(t)) return false;
    }
    return true;
  }

 private:
  bool is_outside(Index t) const {
    for (int f = 0; f < 4; ++f) {
      if (mesh_.neighbour(t, f) == no_index && !mesh_.on_rim(t, f)) return true;
    }
    return false;
  }

  void remove(Index t) {
    const Tetrahedron tet = mesh_.tetrahedron(t);
    mesh_.remove(t);
    for (const Index v : tet) {
      if (mesh_.at(v).empty()) report_.lost.push_back(v);
    }
  }

  bool is_bad(Index t) const { return sign(mesh_.tetrahedron(t), points_) <= 0; }

  // All bad ones that hang together with it, and around them what shares a face, an edge, a vertex.
  std::vector<Index> cavity(Index bad, int reach) const {
    std::set<Index> found{bad};
    std::vector<Index> todo{bad};
    while (!todo.empty()) {
      const Index t = todo.back();
      todo.pop_back();
      for (const Index v : mesh_.tetrahedron(t)) {
        for (const Index other : mesh_.at(v)) {
          if (found.contains(other)) continue;
          int shared = 0;
          for (const Index w : mesh_.tetrahedron(other)) {
            const Tetrahedron& tet = mesh_.tetrahedron(t);
            shared += std::find(tet.begin(), tet.end(), w) != tet.end() ? 1 : 0;
          }
          if (shared < reach) continue;
          found.insert(other);
          if (is_bad(other)) todo.push_back(other);
        }
      }
    }
    return {found.begin(), found.end()};
  }

  // All that hang together with the bad one, and the whole star of a vertex.
  std::vector<Index> star_cavity(Index bad, Index vertex) const {
    const std::vector<Index> core = cavity(bad, 3);
    std::set<Index> found(core.begin(), core.end());
    found.insert(mesh_.at(vertex).begin(), mesh_.at(vertex).end());
    return {found.begin(), found.end()};
  }

  bool replace(Index bad) {
    const Tetrahedron tet = mesh_.tetrahedron(bad);
    if (refill(cavity(bad, 3)) || refill(cavity(bad, 2))) return true;
    for (const Index v : tet) {
      if (refill(star_cavity(bad, v))) return true;
    }
    return refill(cavity(bad, 1));
  }

  bool refill(const std::vector<Index>& cavity) {
    std::set<Triangle> faces;
    std::set<Index> vertices;
    double volume = 0.0;
    std::size_t bad = 0;
    for (const Index t : cavity) {
      const Tetrahedron& tet = mesh_.tetrahedron(t);
      volume += volume_of(tet, points_);
      bad += is_bad(t) ? 1 : 0;
      vertices.insert(tet.begin(), tet.end());
      for (int f = 0; f < 4; ++f) {
        const Triangle face = rotated(outward_face(tet, f));
        if (faces.erase(rotated({face[0], face[2], face[1]})) == 0) faces.insert(face);
      }
    }
    if (vertices.size() > most_cavity_vertices) return false;
    CavityFiller filler({faces.begin(), faces.end()}, {vertices.begin(), vertices.end()}, volume, points_, progress_);
    if (!filler.fill()) return false;
    for (const Index t : cavity) mesh_.remove(t);
    for (const Tetrahedron& t : filler.filling()) mesh_.add(t);
    report_.replaced += bad;
    return true;
  }

  LocalMesh& mesh_;
  std::span<const Vec3> points_;
  MendReport& report_;
  const Progress& progress_;
};

}  // namespace

bool mend_tetrahedra(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points, std::size_t most,
                     MendReport& report, Progress& progress) {
  report = {};
  const std::size_t ranges = (tetrahedra.size() + tetrahedra_per_range - 1) / tetrahedra_per_range;
  std::vector<std::vector<Index>> found(ranges);
  parallel_for(tetrahedra.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t t = begin; t < end; ++t) {
      if (sign(tetrahedra[t], points) <= 0) found[begin / tetrahedra_per_range].push_back(static_cast<Index>(t));
    }
  });
  std::vector<bool> marked(points.size(), false);
  for (const auto& range : found) {
    report.bad += range.size();
    for (const Index t : range) {
      for (const Index v : tetrahedra[t]) marked[v] = true;
    }
  }
  if (report.bad == 0) return true;
  if (report.bad > most) return false;
  // Everything that a cavity may need: what touches a neighbour of a bad one.
  std::vector<bool> wider = marked;
  std::size_t looked = 0;
  for (const Tetrahedron& t : tetrahedra) {
    if (looked++ % tetrahedra_per_range == 0) progress.check();
    if (!marked[t[0]] && !marked[t[1]] && !marked[t[2]] && !marked[t[3]]) continue;
    for (const Index v : t) wider[v] = true;
  }
  LocalMesh mesh(tetrahedra, wider, progress);
  std::vector<Index> bad;
  for (Index t = 0; t < mesh.size(); ++t) {
    if (sign(mesh.tetrahedron(t), points) <= 0) bad.push_back(t);
  }
  Mender mender(mesh, points, report, progress);
  const bool mended = mender.mend(std::move(bad));
  mesh.give_back(tetrahedra);
  std::sort(report.lost.begin(), report.lost.end());
  return mended;
}

}  // namespace atomesh
