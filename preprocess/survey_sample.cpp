#include "preprocess/survey_sample.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "preprocess/examine_atoms.h"
#include "preprocess/thermal_noise.h"

namespace atomesh {

namespace {

constexpr std::size_t asked_atoms = 2000;
constexpr std::size_t few_atoms = 200;
// A frame is believed where so many of the atoms agree with it.
constexpr double agreeing = 2.0 / 3.0;
// A cell that is off by so much of what noise hides is worth fitting.
constexpr double worth_fitting = 0.25;
constexpr std::size_t least_voices = 20;
constexpr double largest_change = 0.05;
// Neighbours move together, so that differences along a row find less than the displacements between neighbours are;
// up to so much less. What exceeds that is strain.
constexpr double correlation = 1.6;
constexpr std::size_t most_pairs = 10000;
constexpr std::size_t most_steps = 6;

// A neighbour in place: entry of the kind, and where it is.
struct Seen {
  std::uint32_t entry;
  Vec3 d;
};

struct Voice {
  std::uint16_t kind;
  bool whole;  // all near entries are occupied
  std::size_t first, count;
};

struct Voices {
  std::vector<Voice> atoms;
  std::vector<Seen> seen;

  std::span<const Seen> of(const Voice& voice) const { return {seen.data() + voice.first, voice.count}; }
};

Voices collect(const SampleView& sample, Survey& survey, Progress& progress) {
  Voices voices;
  const std::span<const Index> homes = sample.grid.home_slots();
  const std::size_t stride = std::max<std::size_t>(homes.size() / asked_atoms, 1);
  Examiner examiner(sample, no_glance(), false);
  std::size_t asked = 0;
  for (std::size_t n = 0; n < homes.size(); n += stride) {
    progress.check();
    if (!sample.features.in_crystal[sample.species(homes[n])]) continue;
    ++asked;
    const Match* match = examiner.match(homes[n]);
    if (match == nullptr || !match->reliable()) continue;
    const SiteKind& kind = sample.features.kinds[match->kind];
    Voice voice{match->kind, match->near_matched == kind.near, voices.seen.size(), 0};
    for (std::size_t e = 0; e < std::max(kind.near, kind.counted); ++e) {
      if (match->neighbour[e] < 0) continue;
      voices.seen.push_back({static_cast<std::uint32_t>(e), examiner.neighbours()[match->neighbour[e]].d});
    }
    voice.count = voices.seen.size() - voice.first;
    voices.atoms.push_back(voice);
  }
  survey.recognised = homes.size() < few_atoms || 5 * voices.atoms.size() >= asked;
  return voices;
}

// Least squares of d = (1 + change)·offset over one atom's neighbours.
bool fit_change(const SiteKind& kind, std::span<const Seen> seen, Mat3& change) {
  Mat3 moment(0.0);
  Mat3 cross(0.0);
  for (const Seen& s : seen) {
    const Vec3& r = kind.entries[s.entry].offset;
    moment += glm::outerProduct(r, r);
    cross += glm::outerProduct(s.d - r, r);
  }
  const double scale = (moment[0][0] + moment[1][1] + moment[2][2]) / 3.0;
  if (!(glm::determinant(moment) > 1e-3 * scale * scale * scale)) return false;
  change = cross * glm::inverse(moment);
  return true;
}

// Component by component, so that strained parts and defects do not matter while they are the lesser part.
Mat3 median_change(const SampleView& sample, const Voices& voices, std::uint16_t grain) {
  std::array<std::vector<double>, 9> components;
  for (const Voice& voice : voices.atoms) {
    const SiteKind& kind = sample.features.kinds[voice.kind];
    Mat3 change;
    if (!voice.whole || kind.grain != grain || !fit_change(kind, voices.of(voice), change)) continue;
    for (int k = 0; k < 9; ++k) components[static_cast<std::size_t>(k)].push_back(change[k / 3][k % 3]);
  }
  Mat3 median(0.0);
  if (components[0].size() < least_voices) return median;
  for (int k = 0; k < 9; ++k) {
    std::vector<double>& values = components[static_cast<std::size_t>(k)];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[k / 3][k % 3] = *middle;
  }
  return median;
}

// The share of a grain's atoms all of whose neighbours are within `limit` of where the changed cell has them.
double agreement(const SampleView& sample, const Voices& voices, std::uint16_t grain, const Mat3& change,
                 double limit) {
  std::size_t asked = 0;
  std::size_t agreed = 0;
  for (const Voice& voice : voices.atoms) {
    const SiteKind& kind = sample.features.kinds[voice.kind];
    if (kind.grain != grain) continue;
    const auto seen = voices.of(voice);
    ++asked;
    agreed += std::all_of(seen.begin(), seen.end(), [&](const Seen& s) {
      const Vec3& r = kind.entries[s.entry].offset;
      return glm::length(s.d - r - change * r) <= limit;
    });
  }
  return asked > 0 ? static_cast<double>(agreed) / static_cast<double>(asked) : 1.0;
}

// The shortest lattice vectors, one of each pair of opposite ones: entries that lead to the site's own kind.
std::vector<Vec3> row_steps(const FeatureSet& features) {
  std::vector<Vec3> steps;
  for (const FeatureEntry& entry : features.kinds.front().entries) {
    if (features.kinds.front().grain != features.kinds[entry.kind].grain || entry.kind != 0) continue;
    const bool known = std::any_of(steps.begin(), steps.end(), [&](const Vec3& step) {
      return glm::length(step + entry.offset) < 0.1 * features.nearest;
    });
    if (!known && steps.size() < most_steps) steps.push_back(entry.offset);
  }
  return steps;
}

double estimate_amplitude(const SampleView& sample, const Voices& voices, const std::vector<Mat3>& change,
                          Progress& progress) {
  const std::vector<Vec3> steps = row_steps(sample.features);
  const double rows = measure_row_noise(sample.atoms, sample.grid, steps, sample.features.tolerance, progress);
  if (rows == 0.0) return 0.0;
  // Pairs of the outer half of what counts: the further apart, the less neighbours move together.
  const std::size_t stride = std::max<std::size_t>(voices.seen.size() / most_pairs, 1);
  std::vector<Vec3> pairs;
  for (const Voice& voice : voices.atoms) {
    const SiteKind& kind = sample.features.kinds[voice.kind];
    for (std::size_t n = voice.first / stride * stride; n < voice.first + voice.count; n += stride) {
      if (n < voice.first || 2 * voices.seen[n].entry < kind.counted || voices.seen[n].entry >= kind.counted) continue;
      const Vec3& r = kind.entries[voices.seen[n].entry].offset;
      pairs.push_back((voices.seen[n].d - r - change[kind.grain] * r) / std::sqrt(2.0));
    }
  }
  if (pairs.size() < least_rows) return rows;
  return std::clamp(softest_amplitude(pairs), rows, correlation * rows);
}

}  // namespace

Survey survey_sample(const SampleView& sample, std::size_t grains, std::optional<double> amplitude, double factor,
                     Progress& progress) {
  Survey survey;
  survey.frame.assign(grains, Mat3(1.0));
  const Voices voices = collect(sample, survey, progress);
  if (!survey.recognised) {
    survey.amplitude = amplitude.value_or(0.0);
    return survey;
  }
  std::vector<Mat3> change;
  for (std::size_t g = 0; g < grains; ++g) {
    change.push_back(median_change(sample, voices, static_cast<std::uint16_t>(g)));
  }
  survey.amplitude = amplitude ? *amplitude : estimate_amplitude(sample, voices, change, progress);
  const double rounding = sample.features.rounding;
  if (!amplitude && factor * survey.amplitude <= rounding) survey.amplitude = 0.0;
  const double limit = std::max(rounding, factor * survey.amplitude);
  for (std::size_t g = 0; g < grains; ++g) {
    const auto grain = static_cast<std::uint16_t>(g);
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, glm::length(change[g][k]));
    if (largest == 0.0 || largest > largest_change) continue;
    const double given = agreement(sample, voices, grain, Mat3(0.0), limit);
    const double fitted = agreement(sample, voices, grain, change[g], limit);
    // In noise most atoms agree with either; without it a cell must explain more to be preferred to the one given.
    const double off = largest * sample.features.farthest_counted();
    const bool better =
        survey.amplitude > 0.0 ? off >= worth_fitting * limit && fitted >= given : 1.0 - fitted < 0.5 * (1.0 - given);
    if (fitted >= agreeing && better) survey.frame[g] = Mat3(1.0) + change[g];
  }
  return survey;
}

}  // namespace atomesh
