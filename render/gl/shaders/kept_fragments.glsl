// A k-buffer for each pixel of the part, in memory (coherent: the next fragment of the pixel may run anywhere).
#include "repair.glsl"

struct Kept {
  vec4 light;
  float last;
  uint first;
  uint count;
  uint wrong;
};
layout(std430, binding = 4) coherent buffer KeptPixels { Kept kept[]; };
layout(std430, binding = 5) coherent buffer KeptDepths { float kept_depths[]; };
layout(std430, binding = 6) coherent buffer KeptLights { uvec2 kept_lights[]; };

#define SLOT_DEPTH(i) kept_depths[pixel_of_part() * uint(K) + (i)]
#define SLOT_LIGHT(i) kept_lights[pixel_of_part() * uint(K) + (i)]
#include "k_buffer.glsl"

Composed load_kept() {
  Kept k = kept[pixel_of_part()];
  return Composed(k.light, k.last, k.first, k.count, k.wrong != 0u);
}

void store_kept(Composed c) {
  kept[pixel_of_part()] = Kept(c.light, c.last, c.first, c.count, c.wrong ? 1u : 0u);
}

void keep(float depth, vec4 light) {
  if (light == vec4(0.0)) return;
  Composed composed = load_kept();
  k_buffer_add(composed, max(depth, 0.0), packed_light(light));  // as list.glsl
  store_kept(composed);
}

// Fragments of one pixel one after another, in the order in which they were drawn; allowed in main() alone. Without
// INTERLOCK for drivers that do so by themselves (llvmpipe).
#ifdef INTERLOCK
layout(pixel_interlock_ordered) in;
#define BEGIN_IN_ORDER beginInvocationInterlockARB()
#define END_IN_ORDER endInvocationInterlockARB()
#else
#define BEGIN_IN_ORDER
#define END_IN_ORDER
#endif
