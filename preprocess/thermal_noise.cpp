#include "preprocess/thermal_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace atomesh {

namespace {

constexpr std::size_t asked_atoms = 2000;
constexpr int directions = 31;
// A quarter of a normal number's magnitudes is below this many standard deviations.
constexpr double quartile = 0.31863936;

}  // namespace

double softest_amplitude(std::span<const Vec3> vectors) {
  if (vectors.empty()) return 0.0;
  std::vector<double> along(vectors.size());
  const auto at = along.begin() + static_cast<std::ptrdiff_t>(vectors.size() / 4);
  double largest = 0.0;
  for (int n = 0; n < directions; ++n) {
    // Half a sphere of directions (Fibonacci lattice): a direction and its opposite are one.
    const double z = (n + 0.5) / directions;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = n * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Vec3 direction(r * std::cos(angle), r * std::sin(angle), z);
    for (std::size_t i = 0; i < vectors.size(); ++i) along[i] = std::abs(glm::dot(vectors[i], direction));
    std::nth_element(along.begin(), at, along.end());
    largest = std::max(largest, *at);
  }
  return largest / quartile;
}

namespace {

// Walks along rows of sites from atom to atom.
class RowWalk {
 public:
  static constexpr int reach = 3;  // atoms on each side of the centre

  RowWalk(const Atoms& atoms, const NeighbourGrid& grid, double tolerance)
      : atoms_(atoms), grid_(grid), tolerance_(tolerance) {}

  // How many atoms on each side of a slot's were found, 0 to reach; then place(n) is there for |n| up to that, Å from
  // the slot's.
  int walk(Index slot, const Vec3& step) {
    const Vec3 centre = grid_.position(slot);
    const std::uint16_t species = atoms_.species[grid_.point(slot)];
    place_[reach] = Vec3(0.0);
    point_[reach] = grid_.point(slot);
    for (int n = 1; n <= reach; ++n) {
      if (!follow(centre, reach + n - 1, reach + n, species, step)) return n - 1;
      if (!follow(centre, reach - n + 1, reach - n, species, -step)) return n - 1;
      // In a small periodic box a row meets itself, and what it says no longer averages out.
      const auto first = point_.begin() + (reach - n);
      const auto last = point_.begin() + (reach + n);
      if (std::find(first + 1, last, *first) != last || std::find(first, last, *last) != last) return n - 1;
    }
    return reach;
  }
  const Vec3& place(int n) const { return place_[static_cast<std::size_t>(reach + n)]; }

 private:
  bool follow(const Vec3& centre, int from, int to, std::uint16_t species, const Vec3& step) {
    const Vec3 expected = place_[static_cast<std::size_t>(from)] + step;
    const Vec3 target = grid_.wrap(centre + expected);
    grid_.find(target, tolerance_, slots_);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Index slot : slots_) {
      const Vec3 d = grid_.position(slot) - target;
      if (atoms_.species[grid_.point(slot)] != species || glm::dot(d, d) >= nearest) continue;
      nearest = glm::dot(d, d);
      point_[static_cast<std::size_t>(to)] = grid_.point(slot);
      place_[static_cast<std::size_t>(to)] = expected + d;
    }
    return std::isfinite(nearest);
  }

  const Atoms& atoms_;
  const NeighbourGrid& grid_;
  double tolerance_;
  std::vector<Index> slots_;
  std::array<Vec3, 2 * reach + 1> place_{};
  std::array<Index, 2 * reach + 1> point_{};
};

}  // namespace

double measure_row_noise(const Atoms& atoms, const NeighbourGrid& grid, std::span<const Vec3> steps, double tolerance,
                         Progress& progress) {
  const std::span<const Index> homes = grid.home_slots();
  const std::size_t stride = std::max<std::size_t>(homes.size() / asked_atoms, 1);
  RowWalk row(atoms, grid, tolerance);
  std::vector<Vec3> fourth;
  std::vector<Vec3> sixth;
  for (std::size_t h = 0; h < homes.size(); h += stride) {
    progress.check();
    for (const Vec3& step : steps) {
      const int found = row.walk(homes[h], step);
      if (found < 2) continue;
      fourth.push_back((row.place(-2) + row.place(2) - 4.0 * (row.place(-1) + row.place(1))) / std::sqrt(70.0));
      if (found < 3) continue;
      const Vec3 near = row.place(-1) + row.place(1);
      sixth.push_back((row.place(-3) + row.place(3) - 6.0 * (row.place(-2) + row.place(2)) + 15.0 * near) /
                      std::sqrt(924.0));
    }
  }
  if (sixth.size() >= least_rows) return softest_amplitude(sixth);
  return fourth.size() >= least_rows ? softest_amplitude(fourth) : 0.0;
}

}  // namespace atomesh
