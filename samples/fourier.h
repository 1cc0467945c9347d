// Discrete Fourier transform of a field on a cubic grid.
#pragma once

#include <cstddef>
#include <vector>

namespace atomesh {

// Transforms n³ complex numbers, given as real and imaginary parts with x fastest, in place. n is a power of two, at
// least 8 (std::invalid_argument otherwise).
class FourierTransform {
 public:
  explicit FourierTransform(std::size_t n);
  // F(k) = Σ f(x) exp(-2πi k·x/n).
  void forward(std::vector<double>& re, std::vector<double>& im) const { transform(re, im, -1.0); }
  // f(x) = n⁻³ Σ F(k) exp(+2πi k·x/n).
  void inverse(std::vector<double>& re, std::vector<double>& im) const;

 private:
  void transform(std::vector<double>& re, std::vector<double>& im, double sign) const;
  void along(double* re, double* im, std::size_t stride, std::size_t lane_stride, double sign) const;

  std::size_t n_;
  std::vector<std::size_t> reversed_;  // bit reversal of 0…n-1
  std::vector<double> cosine_, sine_;  // of 2πk/n, k < n/2
};

}  // namespace atomesh
