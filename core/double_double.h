// Unevaluated sums of two doubles, about 106 bits (algorithms 6 and 12 with their error bounds: Joldes, Muller,
// Popescu, Tight and rigorous error bounds for basic building blocks of double-word arithmetic, 2017,
// doi 10.1145/3121432). Relative to the exact sum or product, + and - err by at most 3u² + 13u³ and * by at most 7u², u
// = 2^-53.
#pragma once

#include "core/expansion.h"

namespace atomesh {

struct DoubleDouble {
  double high;
  double low;
};

// Exact.
inline DoubleDouble double_double_difference(double a, double b) {
  DoubleDouble result;
  two_sum(a, -b, result.high, result.low);
  return result;
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  double high, low, tail_high, tail_low;
  two_sum(a.high, b.high, high, low);
  two_sum(a.low, b.low, tail_high, tail_low);
  low += tail_high;
  DoubleDouble result;
  fast_two_sum(high, low, high, low);
  low += tail_low;
  fast_two_sum(high, low, result.high, result.low);
  return result;
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + DoubleDouble{-b.high, -b.low};
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  double product, tail;
  two_product(a.high, b.high, product, tail);
  tail += a.high * b.low + a.low * b.high;
  DoubleDouble result;
  fast_two_sum(product, tail, result.high, result.low);
  return result;
}

}  // namespace atomesh
