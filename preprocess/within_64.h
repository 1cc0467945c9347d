// The inner loop of the search for neighbours, in the widest instructions that the processor has.
#pragma once

#include <cstdint>

namespace atomesh {

// Which of 64 places (x[n], y[n], z[n]) lie within √limit of a centre, as bits. Every kernel rounds alike.
using Within64 = std::uint64_t (*)(const float* x, const float* y, const float* z, const float* centre, float limit);

// The fastest for this processor.
Within64 within_64();
// Those there are, the plainest first, for tests to compare; nullptr for what this processor lacks.
inline constexpr int within_64_kernels = 3;
Within64 within_64_kernel(int n);

}  // namespace atomesh
