// Exact sums and products of doubles as expansions: a number is the unevaluated sum of doubles that do not overlap,
// least significant first, zeros dropped (J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates, 1997, doi 10.1007/PL00009321; the theorem numbers below are that paper's). Exact as long as no
// partial product leaves the range of double; needs rounding to nearest even and no fused or extended arithmetic.
#pragma once

#include <cmath>

namespace atomesh {

// sum + tail == a + b exactly (Theorem 7).
inline void two_sum(double a, double b, double& sum, double& tail) {
  sum = a + b;
  const double b_virtual = sum - a;
  tail = (a - (sum - b_virtual)) + (b - b_virtual);
}

// The same for |a| >= |b| or a == 0 (Theorem 6).
inline void fast_two_sum(double a, double b, double& sum, double& tail) {
  sum = a + b;
  tail = b - (sum - a);
}

// product + tail == a * b exactly (Theorem 18, with Dekker's splitting into halves of 26 bits).
inline void two_product(double a, double b, double& product, double& tail) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  product = a * b;
  const double a_big = splitter * a;
  const double a_high = a_big - (a_big - a);
  const double a_low = a - a_high;
  const double b_big = splitter * b;
  const double b_high = b_big - (b_big - b);
  const double b_low = b - b_high;
  tail = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
}

// At most N components; `size` of them are in use.
template <int N>
struct Expansion {
  double component[N];  // deliberately not initialised: the large ones live on the stack of a predicate
  int size = 0;

  Expansion() {}
  void push(double value) {
    if (value != 0.0) component[size++] = value;
  }
  // The sign of the whole is the sign of its largest component.
  int sign() const {
    if (size == 0) return 0;
    return component[size - 1] > 0.0 ? 1 : -1;
  }
};

// a - b as two components, or one when the difference of doubles is exact.
inline Expansion<2> exact_difference(double a, double b) {
  Expansion<2> result;
  double sum, tail;
  two_sum(a, -b, sum, tail);
  result.push(tail);
  result.push(sum);
  return result;
}

inline Expansion<1> as_expansion(double a) {
  Expansion<1> result;
  result.component[0] = a;
  result.size = a != 0.0 ? 1 : 0;
  return result;
}

// Fast expansion sum (Theorem 13): merges by magnitude, then carries upwards. f_sign is 1 or -1.
template <int N, int M>
Expansion<N + M> add(const Expansion<N>& e, const Expansion<M>& f, double f_sign = 1.0) {
  Expansion<N + M> result;
  int i = 0;
  int j = 0;
  const auto next = [&]() {
    if (j >= f.size || (i < e.size && std::abs(e.component[i]) < std::abs(f.component[j]))) return e.component[i++];
    return f_sign * f.component[j++];
  };
  const int total = e.size + f.size;
  if (total == 0) return result;
  double q = next();
  for (int k = 1; k < total; ++k) {
    double sum, tail;
    two_sum(q, next(), sum, tail);
    result.push(tail);
    q = sum;
  }
  result.push(q);
  return result;
}

template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
  return add(e, f);
}
template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& e, const Expansion<M>& f) {
  return add(e, f, -1.0);
}

// Expansion times double (Theorem 19).
template <int N>
Expansion<2 * N> scale(const Expansion<N>& e, double b) {
  Expansion<2 * N> result;
  if (e.size == 0 || b == 0.0) return result;
  double q, tail;
  two_product(e.component[0], b, q, tail);
  result.push(tail);
  for (int i = 1; i < e.size; ++i) {
    double product, product_tail, sum;
    two_product(e.component[i], b, product, product_tail);
    two_sum(q, product_tail, sum, tail);
    result.push(tail);
    fast_two_sum(product, sum, q, tail);
    result.push(tail);
  }
  result.push(q);
  return result;
}

// The shorter factor should stand right: one scaling and one sum for each of its components.
template <int N, int M>
Expansion<2 * N * M> operator*(const Expansion<N>& e, const Expansion<M>& f) {
  if constexpr (M == 1) {
    return f.size == 0 ? Expansion<2 * N>() : scale(e, f.component[0]);
  } else {
    Expansion<2 * N * M> result;
    for (int j = 0; j < f.size; ++j) {
      const auto sum = add(result, scale(e, f.component[j]));
      result.size = sum.size;
      for (int k = 0; k < sum.size; ++k) result.component[k] = sum.component[k];
    }
    return result;
  }
}

}  // namespace atomesh
