#include "preprocess/local_cluster.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t grain = 65536;

bool before(const Vec3& a, const Vec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// Calls body(difference from `center`, atom) for every image within the radius.
class ImageWalk {
 public:
  ImageWalk(const Atoms& atoms, const Vec3& center, double radius)
      : atoms_(atoms), center_(center), radius2_(radius * radius) {
    const Box& box = atoms.box;
    if (!box.any_periodic()) return;
    const double product = glm::length(box.vectors[0]) * glm::length(box.vectors[1]) * glm::length(box.vectors[2]);
    if (!(std::abs(box.volume()) > 1e-9 * product) || !std::isfinite(product)) {
      throw Error("the box is periodic but its vectors span no volume; give three independent vectors");
    }
    to_fraction_ = glm::inverse(box.matrix());
    double count = 1.0;
    for (int k = 0; k < 3; ++k) {
      if (!box.periodic[k]) continue;
      const double reach = radius * glm::length(Vec3(to_fraction_[0][k], to_fraction_[1][k], to_fraction_[2][k]));
      const double images = std::max(0.0, std::ceil(reach - 0.5));
      count *= 2.0 * images + 1.0;
      if (!(count < 100000.0)) throw Error("the periodic box is too thin to look for a unit cell in it; repeat it");
      images_[k] = static_cast<int>(images);
    }
  }

  template <class Body>
  void visit(Index atom, Body&& body) const {
    Vec3 d = atoms_.positions[atom] - center_;
    if (!(std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z))) {
      throw Error("atom " + std::to_string(atom + 1) + " has a position that is not finite");
    }
    const Box& box = atoms_.box;
    if (!box.any_periodic()) {
      if (glm::dot(d, d) <= radius2_) body(d, atom);
      return;
    }
    const Vec3 fraction = to_fraction_ * d;
    for (int k = 0; k < 3; ++k) {
      if (box.periodic[k]) d -= std::round(fraction[k]) * box.vectors[k];
    }
    for (int a = -images_[0]; a <= images_[0]; ++a) {
      for (int b = -images_[1]; b <= images_[1]; ++b) {
        for (int c = -images_[2]; c <= images_[2]; ++c) {
          const Vec3 image = d + static_cast<double>(a) * box.vectors[0] + static_cast<double>(b) * box.vectors[1] +
                             static_cast<double>(c) * box.vectors[2];
          if (glm::dot(image, image) <= radius2_) body(image, atom);
        }
      }
    }
  }

 private:
  const Atoms& atoms_;
  Vec3 center_;
  double radius2_;
  Mat3 to_fraction_{1.0};
  std::array<int, 3> images_{0, 0, 0};
};

// The atom nearest to `target` (no images); of several the first by coordinates, so that the atoms' order is nothing.
Vec3 nearest_atom(const Atoms& atoms, const Vec3& target) {
  const std::size_t ranges = (atoms.size() + grain - 1) / grain;
  std::vector<Vec3> best(ranges, Vec3(0.0));
  const auto nearer = [&target](const Vec3& p, const Vec3& q) {
    const double a = glm::dot(p - target, p - target);
    const double b = glm::dot(q - target, q - target);
    return a != b ? a < b : before(p, q);
  };
  parallel_for(atoms.size(), grain, [&](std::size_t begin, std::size_t end) {
    Vec3 nearest = atoms.positions[begin];
    for (std::size_t i = begin; i < end; ++i) {
      if (nearer(atoms.positions[i], nearest)) nearest = atoms.positions[i];
    }
    best[begin / grain] = nearest;
  });
  return *std::min_element(best.begin(), best.end(), nearer);
}

}  // namespace

LocalCluster collect_cluster(const Atoms& atoms, const Vec3& center, double radius) {
  struct Member {
    Vec3 position;
    std::uint16_t species;
  };
  const ImageWalk walk(atoms, center, radius);
  std::vector<std::vector<Member>> parts((atoms.size() + grain - 1) / grain);
  parallel_for(atoms.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<Member>& part = parts[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      walk.visit(static_cast<Index>(i), [&](const Vec3& d, Index atom) { part.push_back({d, atoms.species[atom]}); });
    }
  });
  std::vector<Member> members;
  for (const auto& part : parts) members.insert(members.end(), part.begin(), part.end());
  std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
    return a.position != b.position ? before(a.position, b.position) : a.species < b.species;
  });
  LocalCluster cluster{center, radius, {}, {}};
  cluster.points.reserve(members.size());
  cluster.species.reserve(members.size());
  for (const Member& m : members) {
    cluster.points.push_back(m.position);
    cluster.species.push_back(m.species);
  }
  return cluster;
}

LocalScale measure_scale(const LocalCluster& cluster) {
  LocalScale scale;
  if (cluster.points.size() < 16) return scale;
  // The nearest few hundred to the centre stand for all.
  std::vector<Index> asked(cluster.points.size());
  std::iota(asked.begin(), asked.end(), Index{0});
  std::stable_sort(asked.begin(), asked.end(), [&](Index a, Index b) {
    return glm::dot(cluster.points[a], cluster.points[a]) < glm::dot(cluster.points[b], cluster.points[b]);
  });
  asked.resize(std::min<std::size_t>(asked.size(), 300));
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(cluster.radius, 3);
  const double guess = std::cbrt(volume / static_cast<double>(cluster.points.size()));
  const NeighbourGrid grid(cluster.points, Box{}, guess, guess);
  std::vector<Index> slots;
  std::vector<double> values;
  const auto upper = [&values](double share) {
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
  };
  for (const Index i : asked) {
    const Vec3& p = cluster.points[i];
    double best = 0.0;
    for (double radius = guess; best == 0.0 && radius < 4.0 * cluster.radius; radius *= 2.0) {
      grid.find(p, radius, slots);
      double nearest = 2.0 * radius * radius;
      for (const Index s : slots) {
        const Vec3 d = grid.position(s) - p;
        if (grid.point(s) != i) nearest = std::min(nearest, glm::dot(d, d));
      }
      if (slots.size() > 1) best = std::sqrt(nearest);
    }
    if (best > 0.0) values.push_back(best);
  }
  if (values.empty()) return scale;
  scale.nearest = upper(0.5);
  // The ball grows until it holds some thirty atoms where it is fullest, that is away from surfaces.
  for (scale.glance = 1.5 * scale.nearest; scale.glance < cluster.radius; scale.glance *= 1.15) {
    values.clear();
    for (const Index i : asked) {
      if (glm::length(cluster.points[i]) + scale.glance > cluster.radius) continue;
      grid.find(cluster.points[i], scale.glance, slots);
      values.push_back(static_cast<double>(slots.size()));
    }
    if (values.empty()) return LocalScale{};
    const double count = upper(0.7);
    if (count < 28.0) continue;
    scale.crowd = static_cast<std::size_t>(count);
    scale.spacing = scale.glance * std::cbrt(4.0 / 3.0 * std::numbers::pi / count);
    return scale;
  }
  return LocalScale{};
}

NeighbourGrid grid_of(const LocalCluster& cluster, const LocalScale& scale) {
  return NeighbourGrid(cluster.points, Box{}, scale.spacing, scale.spacing);
}

LocalCluster probe(const Atoms& atoms, const Vec3& target, std::size_t wanted) {
  const Box& box = atoms.box;
  const Bounds bounds = bounds_of(atoms.positions);
  const Vec3 extent = glm::max(bounds.extent(), Vec3(1e-3 * bounds.diagonal()));
  const double volume = box.any_periodic() ? std::abs(box.volume()) : extent.x * extent.y * extent.z;
  const double count = static_cast<double>(atoms.size());
  double radius = std::cbrt(volume / count * static_cast<double>(wanted) * 3.0 / (4.0 * std::numbers::pi));
  Vec3 center = nearest_atom(atoms, target);
  LocalCluster cluster;
  // Twice inwards; then, with the density known, to the size that was asked for.
  for (int round = 0; round < 6; ++round) {
    cluster = collect_cluster(atoms, center, radius);
    const double ratio =
        static_cast<double>(wanted) / static_cast<double>(std::max<std::size_t>(cluster.points.size(), 1));
    const bool fits = ratio > 0.5 && ratio < 1.5;
    const bool all = !box.any_periodic() && cluster.points.size() == atoms.size();
    if (round >= 2 && (fits || (all && ratio > 1.0))) break;
    if (!fits) radius *= std::clamp(std::cbrt(ratio), 0.2, 3.0);
    if (round >= 2) continue;
    Vec3 middle(0.0);
    for (const Vec3& p : cluster.points) middle += p;
    if (!cluster.points.empty()) middle /= static_cast<double>(cluster.points.size());
    Vec3 inner(0.0);
    for (const Vec3& p : cluster.points) {
      if (glm::dot(p - middle, p - middle) < glm::dot(inner - middle, inner - middle)) inner = p;
    }
    center += inner;
  }
  return cluster;
}

}  // namespace atomesh
