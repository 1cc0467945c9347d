#include "preprocess/smooth_positional.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/parallel.h"
#include "preprocess/examine_atoms.h"

namespace atomesh {

namespace {

constexpr std::size_t piece = 1024;
constexpr int followed_rounds = 3;

// Σw² of the atom on a site of this kind.
double squared_weights(const FeatureSet& features, std::uint16_t kind, int rounds) {
  struct Site {
    Vec3 place{0.0};
    std::uint16_t kind = 0;
    double weight = 0.0;
  };
  using Key = std::array<std::int64_t, 3>;
  const auto key_of = [&](const Vec3& place) {
    Key key;
    for (int k = 0; k < 3; ++k) key[static_cast<std::size_t>(k)] = std::llround(place[k] / (0.1 * features.nearest));
    return key;
  };
  std::map<Key, Site> sites{{Key{}, {Vec3(0.0), kind, 1.0}}};
  for (int round = 0; round < rounds; ++round) {
    std::map<Key, Site> next;
    for (const auto& [key, site] : sites) {
      const SiteKind& around = features.kinds[site.kind];
      const double share = site.weight / static_cast<double>(around.counted + 1);
      const auto add = [&](const Vec3& place, std::uint16_t of) {
        Site& target = next[key_of(place)];
        target = {place, of, target.weight + share};
      };
      add(site.place, site.kind);
      for (std::size_t e = 0; e < around.counted; ++e) {
        add(site.place + around.entries[e].offset, around.entries[e].kind);
      }
    }
    sites = std::move(next);
  }
  double sum = 0.0;
  for (const auto& [key, site] : sites) sum += site.weight * site.weight;
  return sum;
}

}  // namespace

double smoothed_share(const FeatureSet& features, int rounds) {
  double most = 0.0;
  for (std::size_t k = 0; k < features.kinds.size() && features.kinds[k].grain == 0; ++k) {
    most = std::max(most, squared_weights(features, static_cast<std::uint16_t>(k), std::min(rounds, followed_rounds)));
  }
  return std::sqrt(most);
}

void smooth_positional(const SampleView& sample, int rounds, const NoiseLevel& noise,
                       const std::vector<std::uint16_t>& standing, Defects& defects, Progress& progress) {
  const FeatureSet& features = sample.features;
  const std::span<const Index> homes = sample.grid.home_slots();
  const double limit = std::max(features.rounding, noise.factor * noise.amplitude * smoothed_share(features, rounds));
  const double nearest2 = features.nearest * features.nearest;
  // From where each atom is to where it was averaged to, Å.
  using Shift = glm::vec3;
  std::vector<Shift> shifts(sample.atoms.size(), Shift(0.0F));
  std::vector<Shift> next(shifts);
  // Calls body(atom, counted neighbours, Σ of their displacements, Σ of the squares beyond the limit).
  const auto look_at_all = [&](auto&& body) {
    parallel_for(homes.size(), piece, [&](std::size_t begin, std::size_t end) {
      progress.check();
      Examiner examiner(sample, no_glance(), false);
      for (std::size_t h = begin; h < end; ++h) {
        const Index atom = sample.grid.point(homes[h]);
        if (standing[atom] == no_grain) continue;
        const Match* match = examiner.match(homes[h]);
        if (match == nullptr || match->kind == no_kind) continue;
        const SiteKind& kind = features.kinds[match->kind];
        std::size_t matched = 0;
        Vec3 sum(0.0);
        double squares = 0.0;
        for (std::size_t e = 0; e < kind.counted; ++e) {
          const int n = match->neighbour[e];
          if (n < 0) continue;
          const Vec3 d = examiner.neighbours()[n].d - kind.entries[e].offset +
                         Vec3(shifts[sample.grid.point(examiner.slots()[n])]) - Vec3(shifts[atom]);
          ++matched;
          sum += d;
          if (glm::dot(d, d) > limit * limit) squares += glm::dot(d, d);
        }
        body(atom, matched, sum, squares);
      }
    });
  };
  for (int round = 0; round < rounds; ++round) {
    look_at_all([&](Index atom, std::size_t matched, const Vec3& sum, double) {
      next[atom] = shifts[atom] + Shift(sum / static_cast<double>(matched + 1));
    });
    std::swap(shifts, next);
  }
  look_at_all([&](Index atom, std::size_t, const Vec3&, double squares) {
    defects.positional[atom] = static_cast<float>(squares / nearest2);
  });
}

}  // namespace atomesh
