// How often each value of the digit comes in each tile.
layout(local_size_x = 256) in;

#include "radix.glsl"

shared uint counts[digit_values];

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (thread < digit_values) counts[thread] = 0u;
  barrier();
  for (uint i = 0u; i < cells_each; ++i) {
    uint place = gl_WorkGroupID.x * tile_size + i * group_size + thread;
    if (place < count) atomicAdd(counts[digit_of(from[place].x)], 1u);
  }
  barrier();
  if (thread < digit_values) places[thread * gl_NumWorkGroups.x + gl_WorkGroupID.x] = counts[thread];
}
