// The segment of a ray in a cell, of a fragment of cells.vert.
#include "segment.glsl"

noperspective in vec4 entry_at;
noperspective in float w_at;
flat in vec3 along;
flat in vec4 direction_at;

#ifdef RAY_ENDS
layout(binding = 9) uniform sampler2D ray_ends;  // w where something opaque ends each pixel's ray
#endif

vec4 cell_light() {
  float w = w_at;
  // Never farther than the farthest vertex: far outside of thin triangles rounding makes anything.
  float way = clamp(min(min(entry_at.y, entry_at.z), entry_at.w), 0.0, along.z - w);
#ifdef RAY_ENDS
  way = clamp(texelFetch(ray_ends, ivec2(gl_FragCoord.xy), 0).x - w, 0.0, way);
#endif
  float u = entry_at.x;
  float far_u = u + along.x * way;
#ifdef PERSPECTIVE
  float far_w = w + way;
  float per_product = 1.0 / (w * far_w);
  float near_scalar = -u * far_w * per_product;
  float far_scalar = -far_u * w * per_product;
  vec2 slope = direction_at.xy + direction_at.zw * gl_FragCoord.xy;
  float segment = along.y * way * per_product * sqrt(1.0 + dot(slope, slope));
#else
  float near_scalar = u;
  float far_scalar = far_u;
  float segment = way;
#endif
  return segment_light(clamp(near_scalar, 0.0, 1.0), clamp(far_scalar, 0.0, 1.0), segment);
}
