#include "preprocess/glance.h"

#include <algorithm>
#include <cmath>

namespace atomesh {

namespace {

constexpr std::uint16_t nobody = 0xFFFF;
// A voxel that two entries' spheres meet; what lies there is left to the full comparison.
constexpr std::uint16_t ambiguous = 0xFFFE;
constexpr std::size_t most_entries = 0xFFF0;
constexpr double coarsest_voxel = 0.3;  // of the nearest-neighbour distance
constexpr int most_voxels = 96;         // along an edge
// The list of candidates is made in single precision; a hair more than the radius is taken.
constexpr double hair = 1e-4;  // of the radius

}  // namespace

GlanceTables::GlanceTables(const FeatureSet& features) {
  for (const SiteKind& kind : features.kinds) tables_.push_back(make_table(features, kind));
}

const GlanceTables& no_glance() {
  static const GlanceTables none;
  return none;
}

GlanceTables::Table GlanceTables::make_table(const FeatureSet& features, const SiteKind& kind) {
  Table table;
  table.farthest = std::max(kind.near, kind.counted);
  if (kind.entries.empty() || kind.entries.size() > most_entries) return table;
  const double margin = features.margin + hair * features.nearest;
  const double half = features.glance_radius + hair * features.glance_radius + margin;
  // Spheres are at least `nearest` apart, centre to centre: no voxel this small meets two.
  const double voxel = std::min(coarsest_voxel, 0.55 * std::max(1.0 - 2.0 * margin / features.nearest, 0.2));
  table.size = std::clamp(static_cast<int>(std::ceil(2.0 * half / (voxel * features.nearest))), 1, most_voxels);
  const double edge = 2.0 * half / table.size;
  table.half = static_cast<float>(half);
  table.per_voxel = static_cast<float>(1.0 / edge);
  const auto n = static_cast<std::size_t>(table.size);
  table.entry.assign(n * n * n, nobody);
  for (std::size_t e = 0; e < kind.entries.size(); ++e) {
    const Vec3& offset = kind.entries[e].offset;
    const Vec3 low = glm::clamp(glm::floor((offset - margin + half) / edge), 0.0, table.size - 1.0);
    const Vec3 high = glm::clamp(glm::floor((offset + margin + half) / edge), 0.0, table.size - 1.0);
    for (double z = low.z; z <= high.z; ++z) {
      for (double y = low.y; y <= high.y; ++y) {
        for (double x = low.x; x <= high.x; ++x) {
          const Vec3 corner = Vec3(x, y, z) * edge - half;
          if (glm::distance(offset, glm::clamp(offset, corner, corner + edge)) > margin) continue;
          std::uint16_t& named = table.entry[static_cast<std::size_t>((z * table.size + y) * table.size + x)];
          named = named == nobody ? static_cast<std::uint16_t>(e) : ambiguous;
        }
      }
    }
  }
  return table;
}

Glance::Glance(const SampleView& sample, const GlanceTables& tables) : sample_(sample), tables_(tables) {
  std::size_t most = 0;
  for (const SiteKind& kind : sample.features.kinds) most = std::max(most, kind.entries.size());
  square_.resize(most);
  seen_.assign(most, 0);
}

bool Glance::explains(std::uint16_t kind_number, std::size_t near, const Vec3& centre, double& all, double& counted) {
  const SiteKind& kind = sample_.features.kinds[kind_number];
  const GlanceTables::Table& table = tables_.tables_[kind_number];
  if (table.entry.empty() || near < table.farthest) return false;
  const double limit = sample_.features.margin * sample_.features.margin;
  const int last = table.size - 1;
  ++look_;
  std::size_t filled = 0;
  double largest = 0.0;
  all = 0.0;
  for (std::size_t n = 0; n < near; ++n) {
    const Index slot = near_[n];
    const Vec3 d = sample_.grid.position(slot) - centre;
    // Within the table by construction, but for the rounding of the last voxel.
    const auto voxel = [&](double v) {
      return std::clamp(static_cast<int>((static_cast<float>(v) + table.half) * table.per_voxel), 0, last);
    };
    const std::uint16_t e =
        table.entry[static_cast<std::size_t>((voxel(d.z) * table.size + voxel(d.y)) * table.size + voxel(d.x))];
    if (e >= ambiguous) return false;
    const FeatureEntry& entry = kind.entries[e];
    const Vec3 off = d - entry.offset;
    const double square = glm::dot(off, off);
    if (square > limit || seen_[e] == look_ || entry.species != sample_.species(slot)) return false;
    seen_[e] = look_;
    square_[e] = square;
    all += square;
    largest = std::max(largest, square);
    filled += e < table.farthest ? 1 : 0;
  }
  if (filled != table.farthest) return false;
  counted = 0.0;
  const double noise2 = sample_.features.noise * sample_.features.noise;
  if (largest <= noise2) return true;
  for (std::size_t e = 0; e < kind.counted; ++e) {
    if (square_[e] > noise2) counted += square_[e];
  }
  return true;
}

bool Glance::settled(Index slot, std::span<const std::uint16_t> kinds, GlanceResult& result) {
  if (tables_.tables_.empty()) return false;
  const FeatureSet& features = sample_.features;
  const double radius = features.glance_radius * (1.0 + hair);
  sample_.grid.gather(slot, radius, block_);
  // Many times what a crystal holds; the full comparison knows what to do with it.
  if (block_.count > 4096 && block_.count > 64 * square_.size()) return false;
  const std::size_t near = sample_.grid.find_in(block_, slot, radius, near_);
  const Vec3 centre = sample_.grid.position(slot);
  const double rounding2 = features.rounding * features.rounding;
  double least = 0.0;
  bool found = false;
  for (const std::uint16_t kind : kinds) {
    double all = 0.0;
    double counted = 0.0;
    if (!explains(kind, near, centre, all, counted) || (found && all >= least)) continue;
    found = true;
    least = all;
    result = {kind, counted};
    if (all <= rounding2) break;
  }
  return found;
}

}  // namespace atomesh
