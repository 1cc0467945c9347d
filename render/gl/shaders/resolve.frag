// The pixel's light of what was gathered for it: by SORT the list in order of depth, by REPLAY the list in the order in
// which it came through a k-buffer, else what the k-buffer in memory has composed and still keeps.
layout(early_fragment_tests) in;

out vec4 light;

#if defined(SORT) || defined(REPLAY)
#include "list.glsl"
#else
#include "kept_fragments.glsl"
#endif

#ifdef SORT

#include "sort_lists.glsl"

uniform bool first_draw;

void main() {
  uint list = heads[pixel_of_part()];
  if (!first_draw && list == 0u) discard;  // is done
  bool sorted = sort_list(list, first_draw);
  if (!sorted) {
    heads[pixel_of_part()] = list;
    atomicAdd(repair.unsorted, 1u);
    discard;
  }
  heads[pixel_of_part()] = 0u;
  light = vec4(0.0);
  uint count = 0u;
  uint last = 0u;
  bool wrong = false;
  while (list != 0u && count < 2u * most_steps) {
    uvec4 node = nodes[list - 1u];
    wrong = wrong || node.y < last;
    last = node.y;
    light += (1.0 - light.a) * unpacked_light(node.zw);
    list = node.x;
    ++count;
  }
  if (wrong || list != 0u) atomicAdd(repair.wrong_pixels, 1u);
  atomicMax(repair.longest, count);
}

#else

#ifdef REPLAY
float slot_depths[K];
uvec2 slot_lights[K];
#define SLOT_DEPTH(i) slot_depths[i]
#define SLOT_LIGHT(i) slot_lights[i]
#include "k_buffer.glsl"

Composed replayed() {
  uint first = 0u;  // the list turned round
  uint count = 0u;
  for (uint rest = heads[pixel_of_part()]; rest != 0u; ++count) {
    uint moved = rest;
    rest = nodes[moved - 1u].x;
    nodes[moved - 1u].x = first;
    first = moved;
  }
  atomicMax(repair.longest, count);
  Composed composed = Composed(vec4(0.0), 0.0, 0u, 0u, false);
  while (first != 0u) {
    uvec4 node = nodes[first - 1u];
    k_buffer_add(composed, uintBitsToFloat(node.y), node.zw);
    first = node.x;
  }
  composed.wrong = composed.wrong || first != 0u;  // a driver may end loops that are long
  return composed;
}
#else
Composed replayed() {
  return load_kept();
}
#endif

void main() {
  Composed composed = replayed();
  k_buffer_flush(composed);
  light = composed.light;
  if (composed.wrong) atomicAdd(repair.wrong_pixels, 1u);
}

#endif
