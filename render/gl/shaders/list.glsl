// Lists of fragments, one a pixel, the last that came first: next (0: none, else its place + 1), depth, light.
#include "repair.glsl"

layout(std430, binding = 5) buffer Heads { uint heads[]; };
layout(std430, binding = 6) buffer Nodes { uvec4 nodes[]; };

void add_to_list(float depth, vec4 light) {
  if (light == vec4(0.0)) return;
  uint place = atomicAdd(repair.fragments, 1u);
  if (place >= repair.capacity) return;
  uint next = atomicExchange(heads[pixel_of_part()], place + 1u);
  nodes[place] = uvec4(next, floatBitsToUint(depth), packed_light(light));
}
