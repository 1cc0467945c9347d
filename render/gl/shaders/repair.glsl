// What the passes of render/gl/order_repair.h share: the part of the window that is repaired, and light in 8 bytes.
layout(std430, binding = 7) buffer Repair {
  uint fragments;     // that came to the lists, those that found no place too
  uint wrong_pixels;  // composed in an order that is not right
  uint longest;       // list, in fragments
  uint capacity;      // of the lists, in fragments
  uint unsorted;      // pixels that sort_lists.glsl needs another draw for
  uint reserved_1, reserved_2, reserved_3;
  ivec4 part;         // left, bottom, width, height
} repair;

uint pixel_of_part() {
  ivec2 place = ivec2(gl_FragCoord.xy) - repair.part.xy;
  return uint(place.y * repair.part.z + place.x);
}

// Half floats have 11 bits down to 6e-5; scaled, down to 2e-9, which a thousand thin segments need.
const float light_scale = 32768.0;

uvec2 packed_light(vec4 light) {
  return uvec2(packHalf2x16(light_scale * light.rg), packHalf2x16(light_scale * light.ba));
}

vec4 unpacked_light(uvec2 light) {
  return vec4(unpackHalf2x16(light.x), unpackHalf2x16(light.y)) / light_scale;
}
