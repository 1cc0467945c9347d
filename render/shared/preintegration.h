// Partial pre-integration (Moreland & Angel 2004, "A fast high accuracy volume renderer for unstructured data"): of the
// segment's integral (segment.h) only ψ has no simple form, and it depends on nothing but the optical depths τ0 and τ1
// that the segment would have with the opacity of either end throughout. A table of it serves every colour map.
//
// Entry (i, j) is ψ where γ(τ0) = i / (psi_size-1) and γ(τ1) = j / (psi_size-1), i outermost, with
//   γ(τ) = τ (psi_bend + psi_deepest) / ((psi_bend + τ) psi_deepest),
// 1 at the largest τ. The paper's own γ = τ / (1 + τ) over all of [0,∞) leaves a square root's corner where a
// transparent end meets an opaque one, and bilinear interpolation is off by 0.014 there at 512 × 512; here no segment
// is deeper than psi_deepest / 2 on average: of a deeper one, the part in front that deep stands for all of it. Between
// entries bilinear interpolation is off by at most 6e-6, and what lies behind adds at most e^-16 = 1.1e-7.
#pragma once

namespace atomesh::optics {

inline constexpr int psi_size = 256;  // each way: 256 KiB, which stay in a core's cache
inline constexpr float psi_bend = 4.0F;
inline constexpr float psi_deepest = 32.0F;

// psi_size × psi_size, made when first asked for (some 20 ms), from any thread.
const float* psi_table();

}  // namespace atomesh::optics
