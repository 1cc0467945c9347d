#include "samples/spinodal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "samples/fourier.h"
#include "samples/random.h"

namespace atomesh {

namespace {

constexpr double finest = 1.4;      // largest grid spacing in units of ε; the interface is about 3 ε wide
constexpr double step = 1.0;        // time, units of ε²/mobility
constexpr double stabiliser = 2.0;  // at least half the largest |f''| = |3c² - 1| on [-1,1], so no step can run away

}  // namespace

double PhaseField::at(const Vec3& p) const {
  const Vec3 u = p * (static_cast<double>(n) / side);
  const Vec3 floor = glm::floor(u);
  const Vec3 f = u - floor;
  std::array<std::array<std::size_t, 2>, 3> corner{};
  for (int axis = 0; axis < 3; ++axis) {
    // n is a power of two, so wrapping is a mask, also of negative numbers.
    const auto low = static_cast<std::uint64_t>(static_cast<std::int64_t>(floor[axis]));
    corner[static_cast<std::size_t>(axis)] = {low & (n - 1), (low + 1) & (n - 1)};
  }
  const auto along_x = [&](std::size_t y, std::size_t z) {
    const double* row = &values[(corner[2][z] * n + corner[1][y]) * n];
    return row[corner[0][0]] * (1.0 - f.x) + row[corner[0][1]] * f.x;
  };
  return (along_x(0, 0) * (1.0 - f.y) + along_x(1, 0) * f.y) * (1.0 - f.z) +
         (along_x(0, 1) * (1.0 - f.y) + along_x(1, 1) * f.y) * f.z;
}

PhaseField decompose(const SpinodalOptions& options, Progress& progress) {
  const double width = options.interface_width;
  PhaseField field;
  field.side = options.side;
  field.n = 16;
  while (options.side > finest * width * static_cast<double>(field.n)) field.n *= 2;
  const std::size_t n = field.n;
  const std::size_t points = n * n * n;
  const double mean = 2.0 * options.minority - 1.0;

  // Noise of one strength per volume, whatever the grid.
  const double noise = options.noise * std::pow(width * static_cast<double>(n) / options.side, 1.5);
  field.values.resize(points);
  double drift = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    field.values[i] = noise * (2.0 * Random::uniform_of(options.seed, i) - 1.0);
    drift += field.values[i];
  }
  for (double& c : field.values) c += mean - drift / static_cast<double>(points);

  // (ε k)² of each index along one axis.
  std::vector<double> squared(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double cycles = i <= n / 2 ? static_cast<double>(i) : static_cast<double>(i) - static_cast<double>(n);
    squared[i] = std::pow(2.0 * std::numbers::pi * cycles * width / options.side, 2);
  }

  const FourierTransform fourier(n);
  std::vector<double> c_re = field.values;
  std::vector<double> c_im(points, 0.0);
  fourier.forward(c_re, c_im);
  std::vector<double> work_re(points);
  std::vector<double> work_im(points);
  const std::size_t plane = n * n;
  const std::size_t planes_a_range = std::max<std::size_t>(1, 32768 / plane);  // less is not worth sharing
  const int steps = static_cast<int>(std::ceil(options.duration / step));
  for (int t = 0; t < steps; ++t) {
    progress.update(static_cast<double>(t) / steps);
    parallel_for(n, planes_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * plane; i < end * plane; ++i) {
        const double c = field.values[i];
        work_re[i] = c * c * c - c;
        work_im[i] = 0.0;
      }
    });
    fourier.forward(work_re, work_im);
    parallel_for(n, planes_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t z = begin; z < end; ++z) {
        for (std::size_t y = 0; y < n; ++y) {
          for (std::size_t x = 0; x < n; ++x) {
            const std::size_t i = (z * n + y) * n + x;
            const double kk = squared[x] + squared[y] + squared[z];
            const double keep = 1.0 + step * kk * stabiliser;
            const double scale = 1.0 / (keep + step * kk * kk);
            c_re[i] = (keep * c_re[i] - step * kk * work_re[i]) * scale;
            c_im[i] = (keep * c_im[i] - step * kk * work_im[i]) * scale;
          }
        }
      }
    });
    work_re = c_re;
    work_im = c_im;
    fourier.inverse(work_re, work_im);
    field.values.swap(work_re);
  }
  return field;
}

}  // namespace atomesh
