#include "preprocess/stamp_seam.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/parallel.h"
#include "core/tet_mesh.h"

namespace atomesh {

namespace {

constexpr std::size_t items_per_range = 512;

// A triangle as a filled or stamped cell has it, counter-clockwise seen from outside that.
struct Face {
  Triangle sorted;
  bool odd = false;  // the other way round than `sorted`
  bool stamped = false;
  Triangle seen;

  auto key() const { return std::tie(sorted, odd, stamped); }
};

Face face_of(const Triangle& t, bool stamped) {
  Face face{t, false, stamped, t};
  auto& s = face.sorted;
  for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
    if (s[i] <= s[j]) continue;
    std::swap(s[i], s[j]);
    face.odd = !face.odd;
  }
  return face;
}

bool is_asked(const OpenPoints& points, Index v) {
  return points.role[v] == OpenPoints::unique || points.role[v] == OpenPoints::model;
}

// Stamped triangles with nothing stamped behind and all corners open. Those with a closed corner have nothing missing
// behind them.
void add_stamped(const StampedSample& sample, const OpenPoints& points, std::vector<Face>& faces) {
  const std::vector<Index>& open = points.open;
  std::vector<std::vector<Face>> parts((open.size() + items_per_range - 1) / items_per_range);
  const auto is_open = [&](Index v) { return std::binary_search(open.begin(), open.end(), v); };
  parallel_for(open.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Index v = open[n];
      const StampedPatch* patch = sample.patch_of(v);
      if (patch == nullptr || !is_asked(points, v)) continue;
      patch->each_outside_face(sample.site(v), [&](const Triangle& t) {
        const bool first = std::none_of(t.begin(), t.end(), [&](Index w) { return w < v && is_asked(points, w); });
        if (first && is_open(t[0]) && is_open(t[1]) && is_open(t[2])) {
          parts[begin / items_per_range].push_back(face_of(t, true));
        }
        return true;
      });
    }
  });
  for (const auto& part : parts) faces.insert(faces.end(), part.begin(), part.end());
}

void add_filled(const std::vector<Tetrahedron>& filled, const OpenPoints& points, std::vector<Face>& faces) {
  for (const Tetrahedron& t : filled) {
    for (const auto& c : face_corners) {
      const Triangle face{t[c[0]], t[c[1]], t[c[2]]};
      if (std::any_of(face.begin(), face.end(), [&](Index v) { return is_asked(points, v); })) {
        faces.push_back(face_of(face, false));
      }
    }
  }
}

// Whether a cell of at most the largest radius should lie behind a triangle, on the side its normal points to. Of the
// spheres through the triangle's corners, what lies on that side in a smaller one lies in a larger one too, as long as
// the centre moves to that side: it is enough to look into the largest.
bool misses_cell(const StampedSample& sample, const Triangle& t, std::vector<Index>& slots) {
  const auto points = sample.points();
  const double largest = sample.options().largest_radius;
  const Vec3 &a = points[t[0]], u = points[t[1]] - a, v = points[t[2]] - a;
  const Vec3 normal = glm::cross(u, v);
  const double area2 = glm::dot(normal, normal);
  const Vec3 center = a + glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) * (0.5 / area2);
  const double radius2 = glm::dot(center - a, center - a);
  const double height = std::sqrt(std::max(largest * largest - radius2, 0.0)) * (1.0 - 1e-6);
  const Vec3 up = normal / std::sqrt(area2);
  const double flat = 10.0 * tolerance_of(sample).sphere * largest;
  return !sample.each_in_ball(center + height * up, std::sqrt(radius2 + height * height), slots,
                              [&](Index p) { return glm::dot(points[p] - a, up) <= flat; });
}

}  // namespace

std::vector<Index> seam_conflicts(const StampedSample& sample, const OpenPoints& points,
                                  const std::vector<Tetrahedron>& filled, Progress& progress) {
  std::vector<Face> faces;
  add_stamped(sample, points, faces);
  add_filled(filled, points, faces);
  progress.check();
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key() < b.key(); });
  progress.check();
  std::vector<Index> conflict;
  std::vector<Triangle> alone;
  for (std::size_t i = 0; i < faces.size();) {
    const std::size_t first = i;
    std::size_t stamped = 0;
    std::array<std::size_t, 2> side{};
    for (; i < faces.size() && faces[i].sorted == faces[first].sorted; ++i) {
      ++side[faces[i].odd ? 1 : 0];
      stamped += faces[i].stamped ? 1 : 0;
    }
    const Triangle& t = faces[first].sorted;
    if (side[0] > 1 || side[1] > 1) {
      conflict.insert(conflict.end(), t.begin(), t.end());
    } else if (i - first == 1 || stamped == 2) {
      for (std::size_t n = first; n < i; ++n) alone.push_back(faces[n].seen);
    }
  }
  std::vector<std::vector<Index>> parts((alone.size() + items_per_range - 1) / items_per_range);
  parallel_for(alone.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t n = begin; n < end; ++n) {
      if (!misses_cell(sample, alone[n], slots)) continue;
      auto& part = parts[begin / items_per_range];
      part.insert(part.end(), alone[n].begin(), alone[n].end());
    }
  });
  for (const auto& part : parts) conflict.insert(conflict.end(), part.begin(), part.end());
  return conflict;
}

}  // namespace atomesh
