// Sixteen floats side by side, on whatever the instruction set of the including file offers. Kernels are compiled once
// per instruction set, each time in a namespace of its own (ATOMESH_ISA), so that the linker never hands code made for
// one processor to another; for the same reason kernels call no inline function of other headers that is not a
// template over these types.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef ATOMESH_ISA
#error "define ATOMESH_ISA as a namespace before including this header"
#endif

namespace atomesh::ATOMESH_ISA {

inline constexpr int lane_count = 16;

#if defined(__AVX512F__)

struct Mask {
  __mmask16 m;
  friend Mask operator&(Mask a, Mask b) { return {static_cast<__mmask16>(a.m & b.m)}; }
  friend Mask operator!(Mask a) { return {static_cast<__mmask16>(~a.m)}; }
};
struct Lanes {
  __m512 v;
  Lanes() = default;
  Lanes(__m512 value) : v(value) {}
  explicit Lanes(float value) : v(_mm512_set1_ps(value)) {}
  friend Lanes operator+(Lanes a, Lanes b) { return _mm512_add_ps(a.v, b.v); }
  friend Lanes operator-(Lanes a, Lanes b) { return _mm512_sub_ps(a.v, b.v); }
  friend Lanes operator*(Lanes a, Lanes b) { return _mm512_mul_ps(a.v, b.v); }
  friend Lanes operator/(Lanes a, Lanes b) { return _mm512_div_ps(a.v, b.v); }
  friend Mask operator<(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)}; }
  friend Mask operator>(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)}; }
  friend Mask operator==(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)}; }
  friend Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return _mm512_fmadd_ps(a.v, b.v, c.v); }
  friend Lanes min(Lanes a, Lanes b) { return _mm512_min_ps(a.v, b.v); }
  friend Lanes max(Lanes a, Lanes b) { return _mm512_max_ps(a.v, b.v); }
  friend Lanes sqrt(Lanes a) { return _mm512_sqrt_ps(a.v); }
};
inline Lanes select(Mask mask, Lanes yes, Lanes no) {
  return _mm512_mask_blend_ps(mask.m, no.v, yes.v);
}
inline unsigned bits(Mask mask) {
  return mask.m;
}
inline Mask mask_of(unsigned bits) {
  return {static_cast<__mmask16>(bits)};
}
inline Lanes load(const float* p) {
  return _mm512_loadu_ps(p);
}
inline void store(float* p, Lanes a) {
  _mm512_storeu_ps(p, a.v);
}

#else

// Native vectors of `width` floats, several to make sixteen; GCC's vector extensions carry them on any processor.
#if defined(__AVX__)
inline constexpr int width = 8;
#else
inline constexpr int width = 4;
#endif
inline constexpr int parts = lane_count / width;
typedef float Native __attribute__((vector_size(4 * width)));
typedef std::int32_t NativeMask __attribute__((vector_size(4 * width)));

struct Mask {
  NativeMask m[parts];
  friend Mask operator&(Mask a, Mask b) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.m[i] = a.m[i] & b.m[i];
    return r;
  }
  friend Mask operator!(const Mask& a) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.m[i] = ~a.m[i];
    return r;
  }
};

struct Lanes {
  Native v[parts];
  Lanes() = default;
  explicit Lanes(float value) {
    for (int i = 0; i < parts; ++i) v[i] = value - Native{};
  }
  template <class Operation>
  static Lanes map(Operation operation) {
    Lanes r;
    for (int i = 0; i < parts; ++i) r.v[i] = operation(i);
    return r;
  }
  template <class Operation>
  static Mask compare(Operation operation) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.m[i] = operation(i);
    return r;
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] + b.v[i]; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] - b.v[i]; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] * b.v[i]; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] / b.v[i]; });
  }
  friend Mask operator<(const Lanes& a, const Lanes& b) {
    return compare([&](int i) { return a.v[i] < b.v[i]; });
  }
  friend Mask operator>(const Lanes& a, const Lanes& b) {
    return compare([&](int i) { return a.v[i] > b.v[i]; });
  }
  friend Mask operator==(const Lanes& a, const Lanes& b) {
    return compare([&](int i) { return a.v[i] == b.v[i]; });
  }
#if defined(__AVX2__) && defined(__FMA__)
  friend Lanes multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
    return map([&](int i) { return Native(_mm256_fmadd_ps(a.v[i], b.v[i], c.v[i])); });
  }
#else
  friend Lanes multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
    return a * b + c;
  }
#endif
#if defined(__AVX__)
  friend Lanes min(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return Native(_mm256_min_ps(a.v[i], b.v[i])); });
  }
  friend Lanes max(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return Native(_mm256_max_ps(a.v[i], b.v[i])); });
  }
  friend Lanes sqrt(const Lanes& a) {
    return map([&](int i) { return Native(_mm256_sqrt_ps(a.v[i])); });
  }
#elif defined(__SSE2__)
  friend Lanes min(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return Native(_mm_min_ps(a.v[i], b.v[i])); });
  }
  friend Lanes max(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return Native(_mm_max_ps(a.v[i], b.v[i])); });
  }
  friend Lanes sqrt(const Lanes& a) {
    return map([&](int i) { return Native(_mm_sqrt_ps(a.v[i])); });
  }
#else
  friend Lanes min(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
  }
  friend Lanes max(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
  }
  friend Lanes sqrt(const Lanes& a) {
    Lanes r;
    for (int i = 0; i < parts; ++i) {
      for (int l = 0; l < width; ++l) r.v[i][l] = __builtin_sqrtf(a.v[i][l]);
    }
    return r;
  }
#endif
};
inline Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) {
  return Lanes::map([&](int i) { return mask.m[i] ? yes.v[i] : no.v[i]; });
}
inline unsigned bits(const Mask& mask) {
  unsigned r = 0;
  for (int i = 0; i < parts; ++i) {
#if defined(__AVX__)
    r |= static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask.m[i]))) << (i * width);
#elif defined(__SSE2__)
    r |= static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask.m[i]))) << (i * width);
#else
    for (int l = 0; l < width; ++l) r |= (mask.m[i][l] != 0 ? 1U : 0U) << (i * width + l);
#endif
  }
  return r;
}
inline Mask mask_of(unsigned bits) {
  Mask r;
  for (int i = 0; i < parts; ++i) {
    NativeMask lane;
    for (int l = 0; l < width; ++l) lane[l] = 1 << (i * width + l);
    r.m[i] = (static_cast<std::int32_t>(bits) & lane) != 0;
  }
  return r;
}
inline Lanes load(const float* p) {
  Lanes r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void store(float* p, const Lanes& a) {
  std::memcpy(p, &a, sizeof a);
}

#endif

// 1 / a to a rounding or two, for a of ordinary size.
#if defined(__AVX512F__)
inline Lanes reciprocal(const Lanes& a) {
  const Lanes rough = _mm512_rcp14_ps(a.v);
  return multiply_add(rough, _mm512_fnmadd_ps(a.v, rough.v, _mm512_set1_ps(1.0F)), rough);
}
#else
inline Lanes reciprocal(const Lanes& a) {
  return Lanes(1.0F) / a;
}
#endif

// Smallest and largest of the sixteen.
inline float smallest(const Lanes& a) {
#if defined(__AVX512F__)
  return _mm512_reduce_min_ps(a.v);
#elif defined(__SSE2__)
#if defined(__AVX__)
  const __m256 eight = _mm256_min_ps(a.v[0], a.v[1]);
  const __m128 four = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
#else
  const __m128 four = _mm_min_ps(_mm_min_ps(a.v[0], a.v[1]), _mm_min_ps(a.v[2], a.v[3]));
#endif
  const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
#else
  float least = a.v[0][0];
  for (int i = 0; i < parts; ++i) {
    for (int l = 0; l < width; ++l) least = a.v[i][l] < least ? a.v[i][l] : least;
  }
  return least;
#endif
}
inline float largest(const Lanes& a) {
  return -smallest(Lanes(0.0F) - a);
}

inline bool any(const Mask& mask) {
  return bits(mask) != 0;
}
inline Lanes magnitude(const Lanes& a) {
#if defined(__AVX512F__)
  return _mm512_abs_ps(a.v);
#else
  return max(a, Lanes(0.0F) - a);
#endif
}
inline Lanes clamp(const Lanes& a, float low, float high) {
  return min(max(a, Lanes(low)), Lanes(high));
}

// e^{-x} for x >= 0, relative error 3e-7 down to the smallest normal float, 0 beyond x = 87. 2^-n is split off and put
// into the float's exponent; ln 2 comes in two parts, the first short enough that n times it is exact.
inline Lanes exp_minus(const Lanes& x) {
  const Lanes bounded = min(x, Lanes(87.0F));
  // Adding 1.5·2^23 rounds to the nearest integer, which then stands in the low bits.
  const Lanes magic(12582912.0F);
  const Lanes shifted = multiply_add(bounded, Lanes(1.44269504F), magic);
  const Lanes n = shifted - magic;
  const Lanes rest = multiply_add(n, Lanes(2.12194440e-4F), multiply_add(n, Lanes(-0.693359375F), bounded));
  Lanes e = multiply_add(rest, Lanes(-1.0F / 5040.0F), Lanes(1.0F / 720.0F));
  e = multiply_add(rest, e, Lanes(-1.0F / 120.0F));
  e = multiply_add(rest, e, Lanes(1.0F / 24.0F));
  e = multiply_add(rest, e, Lanes(-1.0F / 6.0F));
  e = multiply_add(rest, e, Lanes(0.5F));
  e = multiply_add(rest, e, Lanes(-1.0F));
  e = multiply_add(rest, e, Lanes(1.0F));
  alignas(64) float exponent[lane_count];
  store(exponent, n);
  alignas(64) std::int32_t power[lane_count];
  for (int i = 0; i < lane_count; ++i) power[i] = (127 - static_cast<std::int32_t>(exponent[i])) << 23;
  float scale[lane_count];
  std::memcpy(scale, power, sizeof scale);
  return select(x < Lanes(87.0F), e * load(scale), Lanes(0.0F));
}

}  // namespace atomesh::ATOMESH_ISA
