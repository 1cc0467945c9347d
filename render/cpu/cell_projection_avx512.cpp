// The kernel of cell projection compiled for AVX-512.
#define ATOMESH_ISA cell_projection_avx512
#include "render/cpu/lanes.h"

// After lanes.h.
#include "render/cpu/cell_projection_kernel.h"
#include "render/shared/preintegration.h"
#include "render/shared/segment.h"

// After those, each needs the one before it.
// clang-format off
#include "render/cpu/cell_projection_blocks.inl"
#include "render/cpu/cell_projection_setup.inl"
#include "render/cpu/cell_projection_values.inl"
#include "render/cpu/cell_projection_light.inl"
#include "render/cpu/cell_projection_segment.inl"
#include "render/cpu/cell_projection_table.inl"
#include "render/cpu/cell_projection_colors.inl"
#include "render/cpu/cell_projection_mapped.inl"
#include "render/cpu/cell_projection_integrate.inl"
#include "render/cpu/cell_projection_layers.inl"
#include "render/cpu/cell_projection_block.inl"
// clang-format on

namespace atomesh::cell_projection {

const Kernel* avx512_kernel() {
  static const Kernel kernel{"avx512", ATOMESH_ISA::setup, ATOMESH_ISA::draw_block};
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                 __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")
             ? &kernel
             : nullptr;
}

}  // namespace atomesh::cell_projection
