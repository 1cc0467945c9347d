#include "samples/fourier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/parallel.h"

namespace atomesh {

namespace {
constexpr std::size_t lanes = 8;               // lines transformed side by side, so that the inner loops vectorise
constexpr std::size_t points_a_range = 32768;  // less is not worth sharing
}  // namespace

FourierTransform::FourierTransform(std::size_t n) : n_(n), reversed_(n), cosine_(n / 2), sine_(n / 2) {
  if (n < lanes || (n & (n - 1)) != 0) throw std::invalid_argument("the grid of a Fourier transform is a power of two");
  for (std::size_t i = 1; i < n; ++i) reversed_[i] = reversed_[i / 2] / 2 + (i % 2 == 1 ? n / 2 : 0);
  for (std::size_t k = 0; k < n / 2; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    cosine_[k] = std::cos(angle);
    sine_[k] = std::sin(angle);
  }
}

void FourierTransform::inverse(std::vector<double>& re, std::vector<double>& im) const {
  transform(re, im, 1.0);
  const double scale = 1.0 / static_cast<double>(re.size());
  for (double& v : re) v *= scale;
  for (double& v : im) v *= scale;
}

void FourierTransform::transform(std::vector<double>& re, std::vector<double>& im, double sign) const {
  const std::size_t plane = n_ * n_;
  const std::size_t planes_a_range = std::max<std::size_t>(1, points_a_range / plane);
  parallel_for(n_, planes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin * plane; z < end * plane; z += plane) {
      for (std::size_t y = 0; y < n_; y += lanes) along(&re[z + y * n_], &im[z + y * n_], 1, n_, sign);
      for (std::size_t x = 0; x < n_; x += lanes) along(&re[z + x], &im[z + x], n_, 1, sign);
    }
  });
  parallel_for(n_, planes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin * n_; at < end * n_; at += lanes) along(&re[at], &im[at], plane, 1, sign);
  });
}

// Radix-2 transform of `lanes` lines that start `lane_stride` apart and step by `stride`.
void FourierTransform::along(double* re, double* im, std::size_t stride, std::size_t lane_stride, double sign) const {
  using Lane = std::array<double, lanes>;
  std::vector<Lane> real(n_);
  std::vector<Lane> imaginary(n_);
  for (std::size_t e = 0; e < n_; ++e) {
    const std::size_t to = reversed_[e];
    for (std::size_t l = 0; l < lanes; ++l) {
      real[to][l] = re[e * stride + l * lane_stride];
      imaginary[to][l] = im[e * stride + l * lane_stride];
    }
  }
  for (std::size_t half = 1; half < n_; half *= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      const double c = cosine_[k * (n_ / 2 / half)];
      const double s = sign * sine_[k * (n_ / 2 / half)];
      for (std::size_t low = k; low < n_; low += 2 * half) {
        Lane& ar = real[low];
        Lane& ai = imaginary[low];
        Lane& br = real[low + half];
        Lane& bi = imaginary[low + half];
        for (std::size_t l = 0; l < lanes; ++l) {
          const double tr = br[l] * c - bi[l] * s;
          const double ti = br[l] * s + bi[l] * c;
          br[l] = ar[l] - tr;
          bi[l] = ai[l] - ti;
          ar[l] += tr;
          ai[l] += ti;
        }
      }
    }
  }
  for (std::size_t e = 0; e < n_; ++e) {
    for (std::size_t l = 0; l < lanes; ++l) {
      re[e * stride + l * lane_stride] = real[e][l];
      im[e * stride + l * lane_stride] = imaginary[e][l];
    }
  }
}

}  // namespace atomesh
