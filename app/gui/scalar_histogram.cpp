#include "app/gui/scalar_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/parameter_text.h"
#include "core/text_file.h"
#include "render/scene_parts.h"

namespace atomesh::gui {

namespace {

constexpr std::size_t values_per_piece = 1 << 16;

// Counts normalised(i) for i in [0, count) into the histogram's bins; outside of [0,1], below and above.
template <class Normalised>
void count_scalars(ScalarHistogram& histogram, std::size_t count, Progress& progress, const Normalised& normalised) {
  const std::size_t bins = histogram.counts.size();
  const std::size_t pieces = (count + values_per_piece - 1) / values_per_piece;
  // One piece's counts at a time would keep threads waiting; a few dozen in flight cost little.
  constexpr std::size_t at_once = 64;
  std::vector<std::vector<std::uint64_t>> partial(std::min(pieces, at_once));
  for (std::size_t first = 0; first < pieces; first += at_once) {
    progress.update(static_cast<double>(first) / static_cast<double>(pieces));
    const std::size_t now = std::min(at_once, pieces - first);
    parallel_for(now, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        std::vector<std::uint64_t>& mine = partial[p];
        mine.assign(bins + 2, 0);
        const std::size_t from = (first + p) * values_per_piece;
        const std::size_t to = std::min(count, from + values_per_piece);
        for (std::size_t i = from; i < to; ++i) {
          const double scalar = normalised(i);
          if (scalar < 0.0) {
            ++mine[bins];
          } else if (scalar > 1.0) {
            ++mine[bins + 1];
          } else {
            ++mine[std::min(static_cast<std::size_t>(scalar * static_cast<double>(bins)), bins - 1)];
          }
        }
      }
    });
    for (std::size_t p = 0; p < now; ++p) {
      for (std::size_t b = 0; b < bins; ++b) histogram.counts[b] += partial[p][b];
      histogram.below += partial[p][bins];
      histogram.above += partial[p][bins + 1];
    }
  }
  progress.update(1.0);
}

void count_field(ScalarHistogram& histogram, const VertexField& field, const VolumeParameters& parameters,
                 Progress& progress) {
  const FieldRange range = field_range(field, parameters);
  histogram.name = field.name;
  histogram.low = range.low;
  histogram.high = range.high;
  if (range.low >= range.high) {  // one value everywhere: the middle of the map, as field_scalars() has it
    count_scalars(histogram, field.values.size(), progress, [](std::size_t) { return 0.5; });
    return;
  }
  const double half = 0.5 * range.high - 0.5 * range.low;
  count_scalars(histogram, field.values.size(), progress,
                [&](std::size_t v) { return (0.5 * field.values[v] - 0.5 * range.low) / half; });
}

void count_defects(ScalarHistogram& histogram, const Material& material, const VolumeParameters& parameters,
                   Progress& progress) {
  const Defects& defects = material.defects;
  const std::size_t atoms = material.atoms.size();
  histogram.name = "defects";
  histogram.of_atoms = true;
  const auto sum = [&](std::size_t a) {
    return weighted_defects({defects.positional[a], defects.extra[a], defects.vacancy[a]}, parameters);
  };
  const double top = largest_weighted_defects(material, parameters);
  histogram.high = top;
  if (!(top > 0.0)) {
    count_scalars(histogram, atoms, progress, [](std::size_t) { return 0.0; });
  } else {
    count_scalars(histogram, atoms, progress, [&](std::size_t a) { return sum(a) / top; });
  }
}

}  // namespace

std::uint64_t ScalarHistogram::total() const {
  return std::accumulate(counts.begin(), counts.end(), below + above);
}

std::uint64_t ScalarHistogram::largest() const {
  return counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

double ScalarHistogram::value(double scalar) const {
  // Not low + scalar · (high - low), whose range can be too long for a double, and which misses `high` at 1.
  return low * (1.0 - scalar) + high * scalar;
}

double ScalarHistogram::scalar(double value) const {
  const double half = 0.5 * high - 0.5 * low;
  return half > 0.0 ? (0.5 * value - 0.5 * low) / half : 0.5;
}

ScalarHistogram scalar_histogram(const Material& material, const VolumeParameters& parameters, int bins,
                                 Progress& progress) {
  if (bins < 1 || bins > max_bins) {
    throw UsageError("a histogram has 1 to " + std::to_string(max_bins) + " bins, not " + std::to_string(bins));
  }
  progress.stage("scalar_histogram");
  ScalarHistogram histogram;
  histogram.counts.assign(static_cast<std::size_t>(bins), 0);
  if (const VertexField* field = shown_field(material, parameters)) {
    count_field(histogram, *field, parameters, progress);
  } else {
    count_defects(histogram, material, parameters, progress);
  }
  return histogram;
}

std::string histogram_csv(const ScalarHistogram& histogram) {
  std::string csv = "scalar_from,scalar_to,value_from,value_to,count\n";
  const auto line = [&](double from, double to, double value_from, double value_to, std::uint64_t count) {
    csv += real_text(from) + ',' + real_text(to) + ',' + real_text(value_from) + ',' + real_text(value_to) + ',' +
           std::to_string(count) + '\n';
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (histogram.below > 0) line(-infinity, 0.0, -infinity, histogram.low, histogram.below);
  const double bins = static_cast<double>(histogram.counts.size());
  for (std::size_t b = 0; b < histogram.counts.size(); ++b) {
    const double from = static_cast<double>(b) / bins;
    const double to = static_cast<double>(b + 1) / bins;
    line(from, to, histogram.value(from), histogram.value(to), histogram.counts[b]);
  }
  if (histogram.above > 0) line(1.0, infinity, histogram.high, infinity, histogram.above);
  return csv;
}

void write_histogram_csv(const std::string& path, const ScalarHistogram& histogram) {
  AtomicFile file(path);
  file.write(histogram_csv(histogram));
  file.commit();
}

double bar_height(std::uint64_t count, std::uint64_t largest, bool logarithmic) {
  if (count == 0 || largest == 0) return 0.0;
  const double part = static_cast<double>(count);
  const double whole = static_cast<double>(largest);
  return logarithmic ? std::log1p(part) / std::log1p(whole) : part / whole;
}

}  // namespace atomesh::gui
