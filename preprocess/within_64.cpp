#include "preprocess/within_64.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define ATOMESH_X86_WITHIN
#include <immintrin.h>
#endif

namespace atomesh {

namespace {

// Products and sums are rounded one by one (no fused multiply-add) in each of the three, so that they agree.
std::uint64_t within_plain(const float* x, const float* y, const float* z, const float* centre, float limit) {
  std::uint64_t hits = 0;
#if defined(ATOMESH_X86_WITHIN)
  // Four at a time: what every x86-64 processor has.
  const __m128 cx = _mm_set1_ps(centre[0]);
  const __m128 cy = _mm_set1_ps(centre[1]);
  const __m128 cz = _mm_set1_ps(centre[2]);
  const __m128 most = _mm_set1_ps(limit);
  for (unsigned n = 0; n < 64; n += 4) {
    const __m128 dx = _mm_sub_ps(_mm_loadu_ps(x + n), cx);
    const __m128 dy = _mm_sub_ps(_mm_loadu_ps(y + n), cy);
    const __m128 dz = _mm_sub_ps(_mm_loadu_ps(z + n), cz);
    const __m128 d2 = _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    hits |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(d2, most)))) << n;
  }
#else
  for (unsigned n = 0; n < 64; ++n) {
    const float dx = x[n] - centre[0];
    const float dy = y[n] - centre[1];
    const float dz = z[n] - centre[2];
    hits |= std::uint64_t{dx * dx + dy * dy + dz * dz <= limit} << n;
  }
#endif
  return hits;
}

#if defined(ATOMESH_X86_WITHIN)
__attribute__((target("avx2"))) std::uint64_t within_avx2(const float* x, const float* y, const float* z,
                                                          const float* centre, float limit) {
  std::uint64_t hits = 0;
  const __m256 cx = _mm256_set1_ps(centre[0]);
  const __m256 cy = _mm256_set1_ps(centre[1]);
  const __m256 cz = _mm256_set1_ps(centre[2]);
  const __m256 most = _mm256_set1_ps(limit);
  for (unsigned n = 0; n < 64; n += 8) {
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x + n), cx);
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y + n), cy);
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z + n), cz);
    const __m256 d2 = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    const int mask = _mm256_movemask_ps(_mm256_cmp_ps(d2, most, _CMP_LE_OQ));
    hits |= static_cast<std::uint64_t>(static_cast<unsigned>(mask)) << n;
  }
  return hits;
}

__attribute__((target("avx512f"))) std::uint64_t within_avx512(const float* x, const float* y, const float* z,
                                                               const float* centre, float limit) {
  std::uint64_t hits = 0;
  const __m512 cx = _mm512_set1_ps(centre[0]);
  const __m512 cy = _mm512_set1_ps(centre[1]);
  const __m512 cz = _mm512_set1_ps(centre[2]);
  const __m512 most = _mm512_set1_ps(limit);
  for (unsigned n = 0; n < 64; n += 16) {
    const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(x + n), cx);
    const __m512 dy = _mm512_sub_ps(_mm512_loadu_ps(y + n), cy);
    const __m512 dz = _mm512_sub_ps(_mm512_loadu_ps(z + n), cz);
    const __m512 d2 = _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy)), _mm512_mul_ps(dz, dz));
    hits |= static_cast<std::uint64_t>(_mm512_cmp_ps_mask(d2, most, _CMP_LE_OQ)) << n;
  }
  return hits;
}
#endif

}  // namespace

Within64 within_64_kernel(int n) {
  if (n == 0) return within_plain;
#if defined(ATOMESH_X86_WITHIN)
  if (n == 1 && __builtin_cpu_supports("avx2")) return within_avx2;
  if (n == 2 && __builtin_cpu_supports("avx512f")) return within_avx512;
#endif
  return nullptr;
}

Within64 within_64() {
  for (int n = within_64_kernels - 1; n > 0; --n) {
    if (const Within64 kernel = within_64_kernel(n)) return kernel;
  }
  return within_plain;
}

}  // namespace atomesh
