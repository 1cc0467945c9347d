// The kernel of cell projection compiled for AVX-512.
#define ATOMESH_ISA cell_projection_avx512
#include "render/cpu/lanes.h"

// After lanes.h.
#include "render/cpu/cell_projection_kernel.h"
#include "render/shared/segment.h"

// After those.
#include "render/cpu/cell_projection_setup.inl"

// Last.
#include "render/cpu/cell_projection_block.inl"

namespace atomesh::cell_projection {

const Kernel* avx512_kernel() {
  static const Kernel kernel{"avx512", ATOMESH_ISA::setup, ATOMESH_ISA::draw_block};
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                 __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")
             ? &kernel
             : nullptr;
}

}  // namespace atomesh::cell_projection
