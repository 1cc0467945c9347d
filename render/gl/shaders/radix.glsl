// What the passes of render/gl/radix_sort.h share: sixteen values of a digit, and a tile of cells a work group.
const uint digit_values = 16u;
const uint group_size = 256u;
const uint cells_each = 8u;
const uint tile_size = group_size * cells_each;

uniform uint count;  // cells
uniform uint shift;  // of the digit

layout(std430, binding = 0) readonly buffer From { uvec2 from[]; };  // key, cell
layout(std430, binding = 1) writeonly buffer To { uvec2 to[]; };
layout(std430, binding = 2) buffer Places { uint places[]; };  // of digit d in tile t: places[d · tiles + t]

uint digit_of(uint key) {
  return key >> shift & (digit_values - 1u);
}
