// Composes fragments that come nearly front to back: of K that are kept the nearest is composed when another comes
// (Callahan, Ikits, Comba, Silva 2005, "Hardware-assisted visibility sorting for unstructured volume rendering").
//
// Before it: repair.glsl, K, and SLOT_DEPTH(i), SLOT_LIGHT(i) for i < K, to be read and written: float and uvec2.

// The kept ones stand in the slots from `first` on, round the end, in order of depth: one that comes in order is put
// behind the last without looking at the others.
struct Composed {
  vec4 light;  // premultiplied
  float last;  // depth of the fragment composed last
  uint first;
  uint count;
  bool wrong;  // one was composed behind another that is further
};

uint slot(uint place) {
  return place < uint(K) ? place : place - uint(K);
}

void compose(inout Composed composed, float depth, uvec2 light) {
  composed.wrong = composed.wrong || depth < composed.last;
  composed.last = max(composed.last, depth);
  composed.light += (1.0 - composed.light.a) * unpacked_light(light);
}

void compose_nearest(inout Composed composed) {
  compose(composed, SLOT_DEPTH(composed.first), SLOT_LIGHT(composed.first));
  composed.first = slot(composed.first + 1u);
  --composed.count;
}

void k_buffer_add(inout Composed composed, float depth, uvec2 light) {
  if (composed.count == uint(K)) {
    if (depth < SLOT_DEPTH(composed.first)) {
      compose(composed, depth, light);
      return;
    }
    compose_nearest(composed);
  }
  uint free = slot(composed.first + composed.count);
  for (uint behind = composed.count; behind > 0u; --behind) {
    uint place = slot(composed.first + behind - 1u);
    if (SLOT_DEPTH(place) <= depth) break;
    SLOT_DEPTH(free) = SLOT_DEPTH(place);
    SLOT_LIGHT(free) = SLOT_LIGHT(place);
    free = place;
  }
  SLOT_DEPTH(free) = depth;
  SLOT_LIGHT(free) = light;
  ++composed.count;
}

void k_buffer_flush(inout Composed composed) {
  for (uint kept = composed.count; kept > 0u; --kept) compose_nearest(composed);
}
