// The atoms around whom everything is in place, which most are, recognised at a glance.
#pragma once

#include <span>
#include <vector>

#include "preprocess/sample_view.h"

namespace atomesh {

// What a glance found: everybody within FeatureSet::glance_radius is within the margin of an entry of this kind, no two
// of one entry, and no entry that counts or is near is empty.
struct GlanceResult {
  std::uint16_t kind;
  // Å², Σ over the counted entries of the squared displacement where it is above FeatureSet::noise.
  double squares;
};

// The kinds' entries laid out for the look-up; made once, used by all threads.
class GlanceTables {
 public:
  GlanceTables() = default;
  explicit GlanceTables(const FeatureSet& features);

 private:
  friend class Glance;
  // A voxel names the one entry whose sphere of margin meets it.
  struct Table {
    float half = 0.0F;  // Å, the table covers [-half, half)³
    float per_voxel = 1.0F;
    int size = 0;
    std::vector<std::uint16_t> entry;
    std::size_t farthest = 0;  // entries that count or are near
  };
  static Table make_table(const FeatureSet& features, const SiteKind& kind);

  std::vector<Table> tables_;
};

// Tables with which nothing is settled at a glance.
const GlanceTables& no_glance();

// Atoms further away than the glance reaches are displaced by more than the margin from any entry that matters, so
// nobody can hold one better than who was found: a full comparison would say the same. Atoms of one cell of the grid
// share the list of candidates, so visiting home_slots() in order is fast. One per thread.
class Glance {
 public:
  Glance(const SampleView& sample, const GlanceTables& tables);

  // Whether all is in place around the atom for one of `kinds` (of several the one with the least squares).
  bool settled(Index slot, std::span<const std::uint16_t> kinds, GlanceResult& result);

 private:
  // False when this kind does not explain the neighbours; else the squares of all and of those that count.
  bool explains(std::uint16_t kind, std::size_t near, const Vec3& centre, double& all, double& counted);

  const SampleView& sample_;
  const GlanceTables& tables_;
  GridBlock block_;
  std::vector<Index> near_;  // slots within the glance
  std::vector<double> square_;
  std::vector<std::uint32_t> seen_;  // of each entry: the look that found somebody there
  std::uint32_t look_ = 0;
};

}  // namespace atomesh
