// The phase field and its Fourier transform against closed forms, and the sponge they make.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <numeric>

#include "samples/fourier.h"
#include "samples/random.h"
#include "samples/samples.h"
#include "samples/spinodal.h"
#include "tests/samples/sample_checks.h"

namespace atomesh {
namespace {

TEST(Fourier, AgreesWithTheSum) {
  const std::size_t n = 8;
  std::vector<double> re(n * n * n);
  std::vector<double> im(n * n * n);
  Random random(3);
  for (std::size_t i = 0; i < re.size(); ++i) {
    re[i] = random.uniform();
    im[i] = random.uniform();
  }
  const std::vector<double> re0 = re;
  const std::vector<double> im0 = im;
  FourierTransform(n).forward(re, im);
  for (const std::array<std::size_t, 3> k :
       {std::array<std::size_t, 3>{0, 0, 0}, {1, 0, 0}, {0, 3, 0}, {0, 0, 5}, {7, 2, 4}}) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < re.size(); ++i) {
      const auto phase = static_cast<double>(k[0] * (i % n) + k[1] * (i / n % n) + k[2] * (i / n / n));
      sum += std::complex<double>(re0[i], im0[i]) *
             std::polar(1.0, -2.0 * std::numbers::pi * phase / static_cast<double>(n));
    }
    const std::size_t at = (k[2] * n + k[1]) * n + k[0];
    EXPECT_NEAR(re[at], sum.real(), 1e-11);
    EXPECT_NEAR(im[at], sum.imag(), 1e-11);
  }
}

TEST(Fourier, InvertsItself) {
  for (const std::size_t n : {8, 16, 64}) {
    std::vector<double> re(n * n * n);
    std::vector<double> im(n * n * n, 0.0);
    for (std::size_t i = 0; i < re.size(); ++i) re[i] = Random::uniform_of(n, i);
    const std::vector<double> before = re;
    const FourierTransform fourier(n);
    fourier.forward(re, im);
    fourier.inverse(re, im);
    for (std::size_t i = 0; i < re.size(); ++i) {
      ASSERT_NEAR(re[i], before[i], 1e-13);
      ASSERT_NEAR(im[i], 0.0, 1e-13);
    }
  }
}

TEST(Fourier, TakesPowersOfTwoOnly) {
  EXPECT_THROW(FourierTransform(4), std::invalid_argument);
  EXPECT_THROW(FourierTransform(24), std::invalid_argument);
}

TEST(Spinodal, GrowsSmallWavesAsTheLinearTheorySays) {
  SpinodalOptions options;
  options.side = 100.0;
  options.noise = 1e-6;
  const auto spectrum = [&](double duration) {
    options.duration = duration;
    PhaseField field = decompose(options);
    std::vector<double> im(field.values.size(), 0.0);
    FourierTransform(field.n).forward(field.values, im);
    std::vector<double> magnitude(im.size());
    for (std::size_t i = 0; i < im.size(); ++i) magnitude[i] = std::hypot(field.values[i], im[i]);
    return std::pair(magnitude, field.n);
  };
  const auto [early, n] = spectrum(5.0);
  const auto [late, same] = spectrum(10.0);
  ASSERT_EQ(n, same);
  const double mean = 2.0 * options.minority - 1.0;
  const double curvature = 3.0 * mean * mean - 1.0;
  for (const std::array<std::size_t, 3> index :
       {std::array<std::size_t, 3>{1, 0, 0}, {0, 2, 0}, {1, 1, 1}, {0, 2, 3}, {4, 4, 1}}) {
    double kk = 0.0;
    for (const std::size_t i : index) {
      kk += std::pow(2.0 * std::numbers::pi * static_cast<double>(i) * options.interface_width / options.side, 2);
    }
    const double growth = (1.0 + kk * (2.0 - curvature)) / (1.0 + kk * (2.0 + kk));
    const std::size_t at = (index[2] * n + index[1]) * n + index[0];
    EXPECT_NEAR(late[at] / early[at], std::pow(growth, 5), 1e-4 * std::pow(growth, 5));
  }
}

TEST(Spinodal, KeepsItsCompositionAndSeparates) {
  SpinodalOptions options;
  options.side = 120.0;
  const PhaseField field = decompose(options);
  const auto points = static_cast<double>(field.values.size());
  EXPECT_NEAR(std::accumulate(field.values.begin(), field.values.end(), 0.0) / points, -0.2, 1e-12);
  double separated = 0.0;
  for (const double c : field.values) {
    EXPECT_LT(std::abs(c), 1.3);
    separated += c > 0.5 || c < -0.5 ? 1.0 : 0.0;
  }
  EXPECT_GT(separated, 0.7 * points);
  // Interpolation meets the grid and wraps around.
  const double h = field.side / static_cast<double>(field.n);
  EXPECT_NEAR(field.at(Vec3(2 * h, 3 * h, 5 * h)), field.values[(5 * field.n + 3) * field.n + 2], 1e-9);
  EXPECT_NEAR(field.at(Vec3(2 * h + field.side, 3 * h - field.side, 5 * h)), field.at(Vec3(2 * h, 3 * h, 5 * h)), 1e-9);
}

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }
  // Members of the largest group among those of `wanted`.
  template <class Wanted>
  std::size_t largest(Wanted&& wanted) {
    std::vector<std::size_t> size(parent_.size(), 0);
    for (std::size_t i = 0; i < parent_.size(); ++i) size[root(i)] += wanted(i) ? 1 : 0;
    return *std::max_element(size.begin(), size.end());
  }

 private:
  std::vector<std::size_t> parent_;
};

// Both phases of the field are one connected piece each but for crumbs: a sponge, neither droplets nor pores.
TEST(Spinodal, IsBicontinuousWithThirtyPercentSilicon) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SpinodalOptions options;
    options.side = 178.0;
    options.seed = seed;
    const PhaseField field = decompose(options);
    const std::size_t n = field.n;
    std::vector<double> sorted = field.values;
    const auto level = sorted.begin() + static_cast<std::ptrdiff_t>(0.7 * static_cast<double>(sorted.size()));
    std::nth_element(sorted.begin(), level, sorted.end());
    const auto silicon = [&](std::size_t i) { return field.values[i] >= *level; };
    Groups groups(field.values.size());
    // Across the periodic boundary too.
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      const std::size_t x = i % n;
      const std::size_t y = i / n % n;
      const std::size_t z = i / n / n;
      for (const std::size_t j :
           {i - x + (x + 1) % n, i - n * y + n * ((y + 1) % n), i - n * n * z + n * n * ((z + 1) % n)}) {
        if (silicon(i) == silicon(j)) groups.join(i, j);
      }
    }
    const auto points = static_cast<double>(field.values.size());
    EXPECT_GT(static_cast<double>(groups.largest(silicon)), 0.95 * 0.3 * points) << "seed " << seed;
    EXPECT_GT(static_cast<double>(groups.largest([&](std::size_t i) { return !silicon(i); })), 0.99 * 0.7 * points)
        << "seed " << seed;
  }
}

TEST(Sponge, FillsThirtyPercentInOnePiece) {
  const Sample sample = make_sample("sponge", {80000, 1});
  ASSERT_EQ(sample.atoms.size(), 80000);
  const Vec3 cells = glm::ceil(bounds_of(sample.atoms.positions).extent() / 5.431);
  EXPECT_NEAR(80000.0 / (8.0 * cells.x * cells.y * cells.z), 0.3, 0.01);

  const test::NearGrid grid(sample.atoms.positions, 2.8);
  Groups groups(sample.atoms.size());
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    grid.near(sample.atoms.positions[i], [&](Index j, double) {
      if (j < i) groups.join(i, j);
    });
  }
  EXPECT_GT(groups.largest([](std::size_t) { return true; }), 74000);
}

}  // namespace
}  // namespace atomesh
