// Lists of fragments, one a pixel, the last that came first: next (0: none, else its place + 1), depth, light.
#include "repair.glsl"

layout(std430, binding = 5) buffer Heads { uint heads[]; };
layout(std430, binding = 6) buffer Nodes { uvec4 nodes[]; };

// Depths are compared by their bits, as if none were negative: where the sample begins rounding makes some a little less
// than nothing (depths are clamped for the depth test alone).
void add_to_list(float depth, vec4 light) {
  if (light == vec4(0.0)) return;
  uint place = atomicAdd(repair.fragments, 1u);
  if (place >= repair.capacity) return;
  uint next = atomicExchange(heads[pixel_of_part()], place + 1u);
  nodes[place] = uvec4(next, depth > 0.0 ? floatBitsToUint(depth) : 0u, packed_light(light));
}
