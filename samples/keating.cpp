#include "samples/keating.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t grain = 4096;  // atoms a range; also the unit in which sums are taken, whatever the threads

std::size_t range_count(std::size_t atoms) {
  return (atoms + grain - 1) / grain;
}

// An angle's stiffness and natural product of bond lengths.
struct Angle {
  double weight;   // 3β/(8 d₁d₂)
  double product;  // d₁d₂/3
};

Angle angle_of(const KeatingBond& a, const KeatingBond& b) {
  const double lengths = a.length * b.length;
  return {0.375 * std::sqrt(a.beta * b.beta) / lengths, lengths / 3.0};
}

// Tables over bond kinds, so that inner loops look up instead of taking roots.
struct Terms {
  explicit Terms(const std::vector<KeatingBond>& kinds) : count(kinds.size()) {
    for (const KeatingBond& a : kinds) {
      squared_length.push_back(a.length * a.length);
      bond_weight.push_back(0.375 * a.alpha / (a.length * a.length));
      for (const KeatingBond& b : kinds) angles.push_back(angle_of(a, b));
    }
  }
  const Angle& angle(std::size_t a, std::size_t b) const { return angles[a * count + b]; }

  std::size_t count;
  std::vector<double> squared_length, bond_weight;
  std::vector<Angle> angles;
};

// Energy at distance t along a direction: c[0] + c[1] t + … + c[4] t⁴.
struct Quartic {
  std::array<double, 5> c{};

  void add_square(double weight, double q0, double q1, double q2) {
    c[0] += weight * q0 * q0;
    c[1] += weight * 2.0 * q0 * q1;
    c[2] += weight * (q1 * q1 + 2.0 * q0 * q2);
    c[3] += weight * 2.0 * q1 * q2;
    c[4] += weight * q2 * q2;
  }
  double slope(double t) const { return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * 4.0 * c[4])); }

  // The first t > 0 where the slope turns from downhill to level; 0 when it is not downhill.
  double minimum() const {
    if (!(c[1] < 0.0)) return 0.0;
    double high = c[2] > 0.0 ? -c[1] / (2.0 * c[2]) : 1.0;
    for (int n = 0; slope(high) < 0.0; ++n) {
      if (n == 60) return 0.0;
      high *= 2.0;
    }
    double low = 0.0;
    for (int n = 0; n < 80 && high - low > 1e-15 * high; ++n) {
      const double middle = 0.5 * (low + high);
      (slope(middle) < 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

Quartic energy_along(const KeatingNetwork& network, const Terms& terms, const std::vector<Vec3>& positions,
                     const std::vector<Vec3>& direction) {
  std::vector<Quartic> partial(range_count(positions.size()));
  parallel_for(positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    Quartic sum;
    std::array<Vec3, 4> r;
    std::array<Vec3, 4> s;
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t bonds = 0;
      for (; bonds < 4 && network.neighbours[i][bonds] != no_index; ++bonds) {
        const Index j = network.neighbours[i][bonds];
        r[bonds] = positions[j] - positions[i];
        s[bonds] = direction[j] - direction[i];
      }
      for (std::size_t a = 0; a < bonds; ++a) {
        const std::size_t kind = network.kind[i][a];
        // Half, as the bond is met again from its other end.
        sum.add_square(0.5 * terms.bond_weight[kind], glm::dot(r[a], r[a]) - terms.squared_length[kind],
                       2.0 * glm::dot(r[a], s[a]), glm::dot(s[a], s[a]));
        for (std::size_t b = 0; b < a; ++b) {
          const Angle& angle = terms.angle(kind, network.kind[i][b]);
          sum.add_square(angle.weight, glm::dot(r[a], r[b]) + angle.product,
                         glm::dot(r[a], s[b]) + glm::dot(s[a], r[b]), glm::dot(s[a], s[b]));
        }
      }
    }
    partial[begin / grain] = sum;
  });
  Quartic total;
  for (const Quartic& part : partial) {
    for (std::size_t n = 0; n < 5; ++n) total.c[n] += part.c[n];
  }
  return total;
}

double energy_and_gradient(const KeatingNetwork& network, const Terms& terms, const std::vector<Vec3>& positions,
                           std::vector<std::array<Vec3, 4>>& by_bond, std::vector<Vec3>& gradient) {
  const std::size_t atoms = positions.size();
  by_bond.resize(atoms);
  gradient.resize(atoms);
  std::vector<double> partial(range_count(atoms));
  // What each atom's own bonds and angles pull at the ends of its bonds; then each atom gathers what concerns it, so no
  // two threads write to one place.
  parallel_for(atoms, grain, [&](std::size_t begin, std::size_t end) {
    double energy = 0.0;
    std::array<Vec3, 4> r;
    for (std::size_t i = begin; i < end; ++i) {
      std::array<Vec3, 4>& pull = by_bond[i];
      pull.fill(Vec3(0.0));
      for (std::size_t a = 0; a < 4 && network.neighbours[i][a] != no_index; ++a) {
        const std::size_t kind = network.kind[i][a];
        r[a] = positions[network.neighbours[i][a]] - positions[i];
        const double stretch = glm::dot(r[a], r[a]) - terms.squared_length[kind];
        const double weight = 0.5 * terms.bond_weight[kind];
        energy += weight * stretch * stretch;
        pull[a] += 4.0 * weight * stretch * r[a];
        for (std::size_t b = 0; b < a; ++b) {
          const Angle& angle = terms.angle(kind, network.kind[i][b]);
          const double bend = glm::dot(r[a], r[b]) + angle.product;
          energy += angle.weight * bend * bend;
          pull[a] += 2.0 * angle.weight * bend * r[b];
          pull[b] += 2.0 * angle.weight * bend * r[a];
        }
      }
    }
    partial[begin / grain] = energy;
  });
  parallel_for(atoms, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum(0.0);
      for (std::size_t a = 0; a < 4 && network.neighbours[i][a] != no_index; ++a) {
        sum += by_bond[network.neighbours[i][a]][network.reverse[i][a]] - by_bond[i][a];
      }
      gradient[i] = sum;
    }
  });
  double total = 0.0;
  for (const double part : partial) total += part;
  return total;
}

double inner_product(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
  return sum;
}

double longest(const std::vector<Vec3>& vectors) {
  double squared = 0.0;
  for (const Vec3& v : vectors) squared = std::max(squared, glm::dot(v, v));
  return std::sqrt(squared);
}

}  // namespace

double keating_energy(const KeatingNetwork& network, const std::vector<Vec3>& positions, std::vector<Vec3>& gradient) {
  std::vector<std::array<Vec3, 4>> by_bond;
  return energy_and_gradient(network, Terms(network.kinds), positions, by_bond, gradient);
}

RelaxReport relax(const KeatingNetwork& network, const std::vector<bool>& held, std::vector<Vec3>& positions,
                  const RelaxOptions& options, Progress& progress) {
  const Terms terms(network.kinds);
  std::vector<std::array<Vec3, 4>> by_bond;
  std::vector<Vec3> gradient;
  const auto evaluate = [&] {
    const double energy = energy_and_gradient(network, terms, positions, by_bond, gradient);
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      if (held[i]) gradient[i] = Vec3(0.0);
    }
    return energy;
  };

  RelaxReport report;
  report.energy_before = report.energy_after = evaluate();
  report.largest_force = longest(gradient);
  const double first_force = report.largest_force;
  std::vector<Vec3> direction(positions.size(), Vec3(0.0));
  std::vector<Vec3> previous;
  double squared = inner_product(gradient, gradient);
  double carry = 0.0;
  while (report.largest_force > options.largest_force && report.steps < options.steps) {
    // Forces fall roughly geometrically from the first to the wanted one.
    progress.update(std::clamp(
        std::log(first_force / report.largest_force) / std::log(first_force / options.largest_force), 0.0, 1.0));
    for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = carry * direction[i] - gradient[i];
    double step = energy_along(network, terms, positions, direction).minimum();
    if (step == 0.0) {
      if (carry == 0.0) break;  // steepest descent finds nothing either: the rounding floor
      carry = 0.0;
      continue;
    }
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += step * direction[i];
    previous = gradient;
    report.energy_after = evaluate();
    report.largest_force = longest(gradient);
    const double next_squared = inner_product(gradient, gradient);
    carry = std::max(0.0, (next_squared - inner_product(gradient, previous)) / squared);
    squared = next_squared;
    ++report.steps;
  }
  report.converged = report.largest_force <= options.largest_force;
  return report;
}

}  // namespace atomesh
