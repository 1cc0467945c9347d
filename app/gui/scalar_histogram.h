// How often each scalar occurs in what the volume shows: what lies behind the colour map's curve, and *Create Scalar
// Histogram* of the manual (B.6.3.3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/material.h"
#include "core/parameters.h"
#include "core/progress.h"

namespace atomesh::gui {

// Bin i holds the scalars from i/n up to, but not with, (i+1)/n; the last one holds 1 too. Scalars are those that the
// colour map is asked for (Scene::scalars), but told apart from what lies outside of the range.
struct ScalarHistogram {
  std::string name;  // "defects", or the field's
  // One count for each atom; of a field, for each vertex of the mesh.
  bool of_atoms = false;
  double low = 0.0;   // what scalar 0 stands for: 0, or the low end of the field's range
  double high = 1.0;  // and 1: the largest weighted sum of defect values, or the high end; high = low where all is one
  std::vector<std::uint64_t> counts;
  std::uint64_t below = 0;  // values below `low`, which have the colour of scalar 0
  std::uint64_t above = 0;  // values above `high`

  std::uint64_t total() const;
  std::uint64_t largest() const;  // of the counts
  // Of a scalar: low + scalar · (high - low), and back.
  double value(double scalar) const;
  double scalar(double value) const;
};

inline constexpr int default_bins = 256;
inline constexpr int max_bins = 4096;

// Needs the material's fields, or its atoms, tetrahedra and defects. A material without defect values has the scalar 0
// everywhere. Throws UsageError for bins outside 1 to max_bins, an unknown field and an empty range; CancelledError.
ScalarHistogram scalar_histogram(const Material& material, const VolumeParameters& parameters, int bins = default_bins,
                                 Progress& progress = no_progress());

// "scalar_from,scalar_to,value_from,value_to,count", then one line for each bin, upwards. Where values lie outside of
// the range, a first line from -inf and a last one to inf. Numbers read back to the same bits.
std::string histogram_csv(const ScalarHistogram& histogram);
// Throws Error with the system's reason; a file that was there is kept then.
void write_histogram_csv(const std::string& path, const ScalarHistogram& histogram);

// Height of a count's bar, 0 to 1, against the largest count: count/largest, or log(1 + count)/log(1 + largest).
double bar_height(std::uint64_t count, std::uint64_t largest, bool logarithmic);

}  // namespace atomesh::gui
