// The segment of a ray in a cell, of a fragment of ramp_cells.vert: no loop, no texture, no uniform.

noperspective in vec4 entry_at;
noperspective in vec2 way_at;
flat in vec4 piece, piece_slope, piece_square;
#ifdef ONE_PIECE
flat in vec4 along;
#define highest along.w
#else
flat in vec3 along;
flat in vec4 knot, knot_square, next_knot, next_knot_square;
#endif

#ifdef RAY_ENDS
layout(binding = 9) uniform sampler2D ray_ends;  // w where something opaque ends each pixel's ray
#endif

#include "ramps.glsl"

vec4 cell_light() {
  float w = way_at.x;
  // Never longer than the cell allows: far outside of thin triangles rounding makes anything.
  float way = most(least(least(least(entry_at.y, entry_at.z), entry_at.w), along.z), 0.0);
#ifdef RAY_ENDS
  way = least(most(texelFetch(ray_ends, ivec2(gl_FragCoord.xy), 0).x - w, 0.0), way);
#endif
  float u = entry_at.x;
  float far_u = u + along.x * way;
#ifdef PERSPECTIVE
  float far_w = w + way;
  float per_product = 1.0 / (w * far_w);
  float near_scalar = -per_product * (u * far_w);
  float far_scalar = -per_product * (far_u * w);
  float segment = way_at.y * (way * per_product);
#else
  float near_scalar = u;
  float far_scalar = far_u;
  float segment = way;
#endif
  return ramps_light(near_scalar, far_scalar, along.y, segment);
}
