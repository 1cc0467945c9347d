#include "preprocess/lattice_translations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/unit_cell.h"

namespace atomesh {

namespace {

// Of the nearest-neighbour distance: how far from p + t an atom may be. Noise of 3 % leaves 4σ of a difference of
// differences within it.
constexpr double pair_reach = 0.25;
// A chance hit in a glass has a probability of about a tenth.
constexpr double least_share = 0.35;

struct Outcome {
  std::vector<unsigned> asked, met;  // by species
  Vec3 mean{0.0};                    // Å, deviation from the translation
  double width = 0.0;
  double share() const {
    const unsigned all = std::accumulate(asked.begin(), asked.end(), 0U);
    const unsigned hits = std::accumulate(met.begin(), met.end(), 0U);
    return all == 0 ? 0.0 : static_cast<double>(hits) / all;
  }
};

class Search {
 public:
  Search(const LocalCluster& cluster, const NeighbourGrid& grid, const LocalScale& scale,
         const TranslationOptions& options)
      : cluster_(cluster), grid_(grid), scale_(scale), kind_(cluster.species) {
    if (!options.tell_species) std::fill(kind_.begin(), kind_.end(), std::uint16_t{0});
    // Few kinds are in a cluster: number them from 0.
    std::vector<std::uint16_t> names(kind_);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (std::uint16_t& kind : kind_) {
      kind = static_cast<std::uint16_t>(std::lower_bound(names.begin(), names.end(), kind) - names.begin());
    }
    kinds_ = names.size();
    choose_seeds(options.seeds);
  }

  const std::vector<Index>& seeds() const { return seeds_; }
  std::uint16_t kind(Index point) const { return kind_[point]; }

  // Asks `count` of the seeds; gives up early where hopeless.
  Outcome ask(const Vec3& t, std::size_t count) const {
    Outcome outcome{std::vector<unsigned>(kinds_), std::vector<unsigned>(kinds_), Vec3(0.0), 0.0};
    const double reach = pair_reach * scale_.nearest;
    unsigned asked = 0;
    unsigned met = 0;
    double square = 0.0;
    count = std::min(count, seeds_.size());
    for (std::size_t n = 0; n < count; ++n) {
      const Index seed = seeds_[n];
      const Vec3 target = cluster_.points[seed] + t;
      Vec3 nearest(0.0);
      double best = reach * reach;
      bool found = false;
      grid_.find(target, reach, slots_);
      for (const Index s : slots_) {
        const Vec3 d = grid_.position(s) - target;
        if (kind_[grid_.point(s)] != kind_[seed] || glm::dot(d, d) > best) continue;
        best = glm::dot(d, d);
        nearest = d;
        found = true;
      }
      if (!found && !inside(target)) continue;
      ++asked;
      ++outcome.asked[kind_[seed]];
      if (found) {
        ++met;
        ++outcome.met[kind_[seed]];
        outcome.mean += nearest;
        square += best;
      }
      if ((asked == 12 && met < 2) || (asked == 24 && met < 6)) break;
    }
    if (met > 0) {
      outcome.mean /= static_cast<double>(met);
      outcome.width = std::sqrt(std::max(0.0, square / met - glm::dot(outcome.mean, outcome.mean)) / 3.0);
    }
    return outcome;
  }

 private:
  bool inside(const Vec3& place) const {
    grid_.find(place, scale_.glance, around_);
    return 10 * around_.size() >= 7 * scale_.crowd;
  }

  // Those inside the sample, nearest to the centre; asked in a mixed order, so that the first ones are spread as the
  // others are.
  void choose_seeds(std::size_t count) {
    std::vector<Index> order(cluster_.points.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [this](Index a, Index b) {
      return glm::dot(cluster_.points[a], cluster_.points[a]) < glm::dot(cluster_.points[b], cluster_.points[b]);
    });
    std::vector<Index> chosen;
    for (const Index i : order) {
      if (chosen.size() == count) break;
      if (inside(cluster_.points[i])) chosen.push_back(i);
    }
    std::size_t step = chosen.size() * 5 / 8 + 1;
    while (std::gcd(step, std::max<std::size_t>(chosen.size(), 1)) != 1) ++step;
    for (std::size_t n = 0; n < chosen.size(); ++n) seeds_.push_back(chosen[n * step % chosen.size()]);
  }

  const LocalCluster& cluster_;
  const NeighbourGrid& grid_;
  const LocalScale& scale_;
  std::vector<std::uint16_t> kind_;
  std::size_t kinds_ = 0;
  std::vector<Index> seeds_;
  mutable std::vector<Index> slots_, around_;
};

struct Candidate {
  Vec3 vector;
  Outcome outcome;
};

bool same_vector(const Vec3& a, const Vec3& b, double tolerance) {
  const Vec3 difference = a - b;
  const Vec3 sum = a + b;
  return std::min(glm::dot(difference, difference), glm::dot(sum, sum)) < tolerance * tolerance;
}

bool is_box_translation(const Box& box, const Vec3& t) {
  if (!box.any_periodic()) return false;
  const Vec3 f = glm::inverse(box.matrix()) * t;
  Vec3 whole = glm::round(f);
  for (int k = 0; k < 3; ++k) {
    if (!box.periodic[k]) whole[k] = 0.0;
  }
  return whole != Vec3(0.0) && glm::length(t - box.matrix() * whole) < 1e-6 * glm::length(t);
}

// Adds to `good` the candidates that hold as well as the best of them do, for each species on its own, and as sharply.
void select_good(const std::vector<Candidate>& candidates, const LocalScale& scale, std::vector<Candidate>& good) {
  std::vector<double> best;
  for (const Candidate& c : candidates) {
    best.resize(c.outcome.asked.size());
    for (std::size_t k = 0; k < best.size(); ++k) {
      if (c.outcome.asked[k] >= 12) {
        best[k] = std::max(best[k], static_cast<double>(c.outcome.met[k]) / c.outcome.asked[k]);
      }
    }
  }
  const auto holds = [&best](const Outcome& o) {
    bool voted = false;
    for (std::size_t k = 0; k < best.size(); ++k) {
      if (best[k] < least_share || o.asked[k] < 8) continue;
      voted = true;
      const double f = static_cast<double>(o.met[k]) / o.asked[k];
      const double doubt = 1.5 * std::sqrt(f * (1.0 - f) / o.asked[k]);
      if (f + doubt < 0.87 * best[k]) return false;
    }
    return voted;
  };
  double width = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates) {
    if (holds(c.outcome)) width = std::min(width, c.outcome.width);
  }
  const double limit = std::max(1.5 * width, 0.03 * scale.nearest);
  for (const Candidate& c : candidates) {
    if (holds(c.outcome) && c.outcome.width <= limit) good.push_back(c);
  }
}

// Leaves in `left` what is clearly out of the line or plane of the good ones. False when they span space, or nothing is
// left.
bool outside_span(const std::vector<Candidate>& good, std::vector<Candidate>& left) {
  if (good.empty()) return false;
  Vec3 first = good.front().vector;
  for (const Candidate& c : good) {
    if (glm::length(c.vector) < glm::length(first)) first = c.vector;
  }
  Vec3 normal(0.0);
  for (const Candidate& c : good) {
    const Vec3 cross = glm::cross(glm::normalize(first), glm::normalize(c.vector));
    if (glm::length(cross) > glm::length(normal)) normal = cross;
  }
  const bool plane = glm::length(normal) > 0.1;
  const auto outside = [&](const Candidate& c) {
    const Vec3 direction = glm::normalize(c.vector);
    return plane ? std::abs(glm::dot(direction, glm::normalize(normal))) > 0.15
                 : glm::length(glm::cross(direction, glm::normalize(first))) > 0.15;
  };
  if (plane && std::any_of(good.begin(), good.end(), outside)) return false;
  std::erase_if(left, [&](const Candidate& c) { return !outside(c); });
  return !left.empty();
}

}  // namespace

TranslationSearch find_translations(const LocalCluster& cluster, const NeighbourGrid& grid, const LocalScale& scale,
                                    const TranslationOptions& options) {
  TranslationSearch result;
  const Search search(cluster, grid, scale, options);
  if (search.seeds().size() < 12) return result;
  const double same = 0.35 * scale.nearest;

  // A translation may miss at one atom (a vacancy where it leads): three atoms propose.
  std::vector<Candidate> candidates;
  std::vector<Vec3> rejected;
  std::vector<Index> slots;
  const std::size_t proposers = std::min<std::size_t>(search.seeds().size(), 4);
  for (std::size_t n = 0; n < proposers; ++n) {
    const Index from = search.seeds()[n];
    grid.find(cluster.points[from], options.reach, slots);
    const auto known = [&](const Vec3& t) {
      return std::any_of(candidates.begin(), candidates.end(),
                         [&](const Candidate& c) { return same_vector(c.vector, t, same); });
    };
    // Later proposers only fill gaps; where the first found nothing at all there is hardly a crystal.
    const std::size_t before = candidates.size();
    for (const Index s : slots) {
      const Index to = grid.point(s);
      const Vec3 t = cluster.points[to] - cluster.points[from];
      if (to == from || search.kind(to) != search.kind(from) || known(t)) continue;
      if (n > 0 &&
          std::any_of(rejected.begin(), rejected.end(), [&](const Vec3& r) { return same_vector(r, t, 0.5 * same); })) {
        continue;
      }
      if (n >= 2 && before == 0) break;
      Vec3 vector = t;
      Outcome outcome = search.ask(vector, 24);
      const bool hopeful = outcome.share() >= 0.25;
      if (hopeful) {
        vector += outcome.mean;
        outcome = search.ask(vector, options.seeds);
      }
      const unsigned asked = std::accumulate(outcome.asked.begin(), outcome.asked.end(), 0U);
      if (!hopeful || outcome.share() < 0.8 * least_share || asked < 12 || 4 * asked < search.seeds().size()) {
        rejected.push_back(t);
        continue;
      }
      vector += outcome.mean;
      if (!known(vector)) candidates.push_back({vector, outcome});
    }
  }

  // Box translations hold whatever is in the box: they say nothing about what is good.
  std::vector<Candidate> trivial;
  std::erase_if(candidates, [&](const Candidate& c) {
    if (!is_box_translation(options.box, c.vector)) return false;
    trivial.push_back(c);
    return true;
  });
  for (const Candidate& c : candidates) result.best = std::max(result.best, c.outcome.share());

  // Directions may differ: within layers that slide or shake against each other a translation holds better than from
  // layer to layer. So what is out of the plane of those that are found is measured by its own best.
  std::vector<Candidate> good;
  std::vector<Candidate> left = candidates;
  for (int round = 0; round < 3; ++round) {
    select_good(left, scale, good);
    for (const Candidate& t : trivial) good.push_back(t);
    trivial.clear();
    if (!outside_span(good, left)) break;
  }
  for (const Candidate& c : good) result.found.push_back({c.vector, c.outcome.share(), c.outcome.width});
  std::stable_sort(result.found.begin(), result.found.end(), [](const Translation& a, const Translation& b) {
    return glm::dot(a.vector, a.vector) < glm::dot(b.vector, b.vector);
  });
  return result;
}

std::optional<Mat3> lattice_of(const std::vector<Translation>& translations, const LocalScale& scale) {
  // The three shortest independent ones are a basis of the lattice (true in three dimensions: H. Minkowski). A cell
  // holds an atom at least.
  const double atom_volume = std::pow(scale.spacing, 3);
  std::vector<Vec3> chosen;
  for (const Translation& t : translations) {
    const Vec3& v = t.vector;
    if (chosen.empty()) {
      chosen.push_back(v);
    } else if (chosen.size() == 1) {
      const double sine = glm::length(glm::cross(chosen[0], v)) / (glm::length(chosen[0]) * glm::length(v));
      if (sine > 0.1) chosen.push_back(v);
    } else if (std::abs(glm::determinant(Mat3(chosen[0], chosen[1], v))) > 0.6 * atom_volume) {
      chosen.push_back(v);
      break;
    }
  }
  if (chosen.size() < 3) return std::nullopt;
  Mat3 lattice(chosen[0], chosen[1], chosen[2]);
  // All of them together give the vectors better than three do.
  for (int round = 0; round < 3; ++round) {
    const Mat3 to_fraction = glm::inverse(lattice);
    Mat3 cross(0.0);
    Mat3 spread(0.0);
    std::size_t agree = 0;
    for (const Translation& t : translations) {
      const Vec3 n = glm::round(to_fraction * t.vector);
      if (glm::length(t.vector - lattice * n) > 0.25 * scale.nearest) continue;
      ++agree;
      cross += glm::outerProduct(t.vector, n);
      spread += glm::outerProduct(n, n);
    }
    if (2 * agree < translations.size()) return std::nullopt;
    lattice = cross * glm::inverse(spread);
  }
  const std::array<Vec3, 3> reduced = reduce_lattice({lattice[0], lattice[1], lattice[2]});
  return Mat3(reduced[0], reduced[1], reduced[2]);
}

}  // namespace atomesh
