#include "render/gl/cell_order.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/tet_mesh.h"

namespace atomesh::gl {

namespace {

constexpr std::size_t cells_per_range = 1 << 13;

// How far a Delaunay cell's point is drawn towards its centroid: breaks ties, and moves circumcentres hardly further
// than vertices rounded to float do.
constexpr double tie_share = 1e-5;
double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// With L the linear function that equals |x - centroid|² at the corners, the power of x is |x - centroid|² - L(x).
OrderPoint order_point(const std::array<Vec3, 4>& corners, bool delaunay) {
  const Vec3 centroid = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::array<Vec3, 4> arm;
  double size = 0.0;
  for (int k = 0; k < 4; ++k) {
    arm[k] = corners[k] - centroid;
    size += glm::dot(arm[k], arm[k]);
  }
  const double volume6 = glm::dot(glm::cross(arm[1] - arm[0], arm[2] - arm[0]), arm[3] - arm[0]);
  Vec3 slope(0.0);  // of L
  double share = 0.0;
  if (delaunay && volume6 * volume6 > 1e-26 * size * size * size) {
    for (int k = 0; k < 4; ++k) {
      const auto& [a, b, c] = face_corners[k];
      const Vec3 outward = glm::cross(arm[b] - arm[a], arm[c] - arm[a]);
      slope -= glm::dot(arm[k], arm[k]) / volume6 * outward;
    }
    share = 1.0 - tie_share;
  }
  const Vec3 p = centroid + 0.5 * share * slope;
  // |eye - centroid|² - share · L(eye), with L(eye) = slope · (eye - centroid) + size / 4, without |eye|²
  const double weight = glm::dot(centroid, centroid) + share * (glm::dot(slope, centroid) - 0.25 * size);
  return {Vec3f(p), static_cast<float>(weight)};
}

// For each face of a cell whether the eye is on its outer side, as bits. Both cells of a face compute the same numbers
// for it, so that they agree.
class FaceSides {
 public:
  FaceSides(const Camera& camera, const Scene& scene)
      : scene_(scene),
        eye_(camera.eye - scene.center),
        right_(camera.right),
        up_(camera.up),
        perspective_(camera.projection == Projection::perspective) {}

  std::uint8_t fronts_of(Index cell) const {
    const Tetrahedron& tetrahedron = scene_.tetrahedra[cell];
    std::array<int, 4> rank{0, 1, 2, 3};  // corners by ascending vertex
    bool odd = false;
    const auto order = [&](int a, int b) {
      if (tetrahedron[rank[a]] < tetrahedron[rank[b]]) return;
      std::swap(rank[a], rank[b]);
      odd = !odd;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = seen(scene_.vertices[tetrahedron[rank[k]]]);
    // det[k]: of the ascending corners but the k-th, below zero where the eye sees them counter-clockwise. Seen from
    // outside they run so for even k, unless the sorting was an odd permutation.
    const Vec3 c23 = glm::cross(p[2], p[3]);
    const std::array<double, 4> det{glm::dot(p[1], c23), glm::dot(p[0], c23), glm::dot(p[0], glm::cross(p[1], p[3])),
                                    glm::dot(p[0], glm::cross(p[1], p[2]))};
    std::uint8_t fronts = 0;
    for (int k = 0; k < 4; ++k) {
      const bool outward = (k % 2 == 0) != odd;
      if (outward ? det[k] < 0.0 : det[k] > 0.0) fronts = static_cast<std::uint8_t>(fronts | 1U << rank[k]);
    }
    return fronts;
  }

 private:
  Vec3 seen(const Vec3f& vertex) const {
    const Vec3 p = Vec3(vertex) - eye_;
    // From infinity the determinant's sign is that of the area on the image plane, the other way round.
    return perspective_ ? p : Vec3(glm::dot(p, up_), glm::dot(p, right_), 1.0);
  }

  const Scene& scene_;
  Vec3 eye_;
  Vec3 right_;
  Vec3 up_;
  bool perspective_;
};

// A cell's state while the order by faces is found: which of its faces are still to be looked behind, and the rest.
constexpr unsigned fronts_mask = 0xF;
constexpr unsigned waiting = 0x10;  // its turn is to come
constexpr unsigned open = 0x20;     // waits for the cells before it
constexpr unsigned late = 0x40;     // one that has to come before it has a greater key
constexpr unsigned hidden = 0x80;   // is not drawn

}  // namespace

KeyScale key_scale(const Camera& camera, const Scene& scene) {
  Vec3 low(scene.bounds.min - scene.center);
  Vec3 high(scene.bounds.max - scene.center);
  if (scene.bounds.empty()) low = high = Vec3(0.0);
  KeyScale scale{};
  double nearest = 0.0;
  double furthest = 0.0;
  if (camera.projection == Projection::perspective) {
    const Vec3 eye = camera.eye - scene.center;
    scale.direction = -2.0 * eye;
    scale.weight_factor = 1.0;
    const Vec3 near = glm::clamp(eye, low, high) - eye;
    const Vec3 far = glm::max(glm::abs(low - eye), glm::abs(high - eye));
    nearest = glm::dot(near, near) - glm::dot(eye, eye);
    furthest = glm::dot(far, far) - glm::dot(eye, eye);
  } else {
    scale.direction = camera.forward;
    scale.weight_factor = 0.0;
    const Vec3 middle = 0.5 * (low + high);
    const double reach = glm::dot(0.5 * (high - low), glm::abs(camera.forward));
    nearest = glm::dot(middle, camera.forward) - reach;
    furthest = glm::dot(middle, camera.forward) + reach;
  }
  scale.low = nearest;
  scale.over_range = furthest > nearest ? 1.0 / (furthest - nearest) : 1.0;
  return scale;
}

std::uint32_t key_of(const KeyScale& scale, const OrderPoint& point) {
  const double value =
      scale.weight_factor * static_cast<double>(point.weight) + glm::dot(scale.direction, Vec3(point.p));
  const double u = (value - scale.low) * scale.over_range;
  // (-∞, 0] to (0, 1], [0, 1] to [1, 2], [1, ∞) to [2, 3)
  const double v = u < 0.0 ? 1.0 / (1.0 - u) : (u <= 1.0 ? 1.0 + u : 3.0 - 1.0 / u);
  return static_cast<std::uint32_t>(std::clamp(v * (0x1p32 / 3.0), 0.0, 0x1p32 - 1.0));
}

CellOrder::CellOrder(const Scene& scene, bool by_faces, Progress& progress)
    : scene_(scene), points_(scene.tetrahedra.size()) {
  parallel_for(points_.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t cell = begin; cell < end; ++cell) {
      std::array<Vec3, 4> corners;
      for (int k = 0; k < 4; ++k) corners[k] = Vec3(scene.vertices[scene.tetrahedra[cell][k]]);
      points_[cell] = order_point(corners, scene.delaunay);
    }
  });
  if (!by_faces) return;
  TetMesh mesh;
  mesh.vertices.resize(scene.vertices.size());
  mesh.tetrahedra.assign(scene.tetrahedra.begin(), scene.tetrahedra.end());
  try {
    neighbours_ = face_neighbours(mesh, progress);
  } catch (const CancelledError&) {
    throw;
  } catch (const Error&) {
    neighbours_.clear();
    return;
  }
  find_outside(progress);
}

void CellOrder::find_outside(Progress& progress) {
  std::vector<std::vector<OutsideFace>> found((neighbours_.size() + cells_per_range - 1) / cells_per_range);
  std::atomic<bool> turned{false};
  parallel_for(neighbours_.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = scene_.tetrahedra[i];
      const Vec3 origin(scene_.vertices[t[0]]);
      const auto arm = [&](int k) { return Vec3(scene_.vertices[t[k]]) - origin; };
      if (glm::dot(glm::cross(arm(1), arm(2)), arm(3)) < 0.0) turned = true;
      for (int face = 0; face < 4; ++face) {
        if (neighbours_[i][static_cast<std::size_t>(face)] != no_index) continue;
        found[begin / cells_per_range].push_back({static_cast<Index>(i), face});
      }
    }
  });
  if (turned) return;
  for (const std::vector<OutsideFace>& faces : found) outside_.insert(outside_.end(), faces.begin(), faces.end());
}

// After order_by_faces(), when rank_ has each cell's place.
void CellOrder::order_outside(const Camera& camera, const Progress& progress) {
  const FaceSides sides(camera, scene_);
  keyed_.resize(outside_.size());
  parallel_for(outside_.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const auto [cell, face] = outside_[i];
      const bool front = (sides.fronts_of(cell) >> face & 1U) != 0;
      keyed_[i] = {2U * rank_[cell] + (front ? 0U : 1U), static_cast<Index>(i)};
    }
  });
  sort_by_key(keyed_, scratch_, progress);
  outside_in_order_.resize(outside_.size());
  std::ranges::transform(keyed_, outside_in_order_.begin(), [&](const KeyedCell& k) { return outside_[k.cell]; });
}

void CellOrder::sort(const Camera& camera, std::span<const Index> cells, std::span<const Index> unseen,
                     std::vector<Index>& order, CellOrderStats& stats, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  outside_in_order_.clear();
  if (!by_faces()) unseen = {};
  const KeyScale scale = key_scale(camera, scene_);
  keyed_.resize(cells.size() + unseen.size());
  const auto add_keys = [&](std::span<const Index> of, KeyedCell* keyed) {
    parallel_for(of.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t i = begin; i < end; ++i) keyed[i] = {key_of(scale, points_[of[i]]), of[i]};
    });
  };
  add_keys(cells, keyed_.data());
  add_keys(unseen, keyed_.data() + cells.size());
  sort_by_key(keyed_, scratch_, progress);
  order.resize(cells.size());
  if (!by_faces()) std::ranges::transform(keyed_, order.begin(), &KeyedCell::cell);
  stats.keys_ms += ms_since(start);
  if (by_faces()) order_by_faces(camera, cells, unseen, order, stats, progress);
}

// In the order of their keys cells are drawn, each after those before its faces: depth first. A cell that by the keys
// comes after all of those needs no look at them unless another one calls for it before its turn; in a Delaunay mesh
// nearly all are so.
void CellOrder::order_by_faces(const Camera& camera, std::span<const Index> cells, std::span<const Index> unseen,
                               std::vector<Index>& order, CellOrderStats& stats, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  rank_.assign(neighbours_.size(), no_index);
  parallel_for(keyed_.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) rank_[keyed_[i].cell] = static_cast<Index>(i);
  });
  state_.resize(neighbours_.size());
  const FaceSides sides(camera, scene_);
  const auto look = [&](std::span<const Index> at, unsigned kind) {
    parallel_for(at.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t i = begin; i < end; ++i) {
        const Index cell = at[i];
        const unsigned fronts = sides.fronts_of(cell);
        unsigned state = kind;
        for (unsigned f = 0; f < 4; ++f) {
          const Index before = neighbours_[cell][f];
          if ((fronts >> f & 1U) == 0 || before == no_index || rank_[before] == no_index) continue;
          state |= 1U << f | (rank_[before] > rank_[cell] ? late : 0U);
        }
        state_[cell] = static_cast<std::uint8_t>(state);
      }
    });
  };
  look(cells, waiting);
  look(unseen, waiting | hidden);
  std::size_t drawn = 0;
  Index rank = 0;
  const std::uint64_t circles_before = stats.circles;
  const auto draw = [&](Index cell) {
    if ((state_[cell] & hidden) == 0) order[drawn++] = cell;
    state_[cell] = 0;
    rank_[cell] = rank++;
    if (rank % cells_per_range == 0) progress.check();
  };
  for (const KeyedCell& next : keyed_) {
    const unsigned state = state_[next.cell];
    if ((state & waiting) == 0) continue;
    if ((state & late) == 0) {
      draw(next.cell);
      continue;
    }
    path_.assign(1, next.cell);
    while (!path_.empty()) {
      const Index cell = path_.back();
      const unsigned fronts = state_[cell] & fronts_mask;
      if (fronts == 0) {
        draw(cell);
        path_.pop_back();
        continue;
      }
      // the lowest of its faces is looked behind
      state_[cell] = static_cast<std::uint8_t>((state_[cell] & (state_[cell] - 1U)) | open);
      const Index before = neighbours_[cell][static_cast<std::size_t>(std::countr_zero(fronts))];
      if ((state_[before] & open) != 0) ++stats.circles;
      if ((state_[before] & (open | waiting)) == waiting) path_.push_back(before);
    }
  }
  const bool all = rank == neighbours_.size();
  if (all && stats.circles == circles_before && !outside_.empty()) order_outside(camera, progress);
  stats.faces_ms += ms_since(start);
}

}  // namespace atomesh::gl
