// Keys of the cells that are drawn: key_of() of render/gl/cell_order.h.
layout(local_size_x = 256) in;

uniform uint count;
uniform dvec3 direction;  // KeyScale
uniform double weight_factor;
uniform double low;
uniform double over_range;

layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };  // of each cell: p, weight
layout(std430, binding = 1) readonly buffer Cells { uint cells[]; };
layout(std430, binding = 2) writeonly buffer Keyed { uvec2 keyed[]; };  // key, cell

void main() {
  // more than the groups of one dimension may be
  uint place = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + gl_LocalInvocationIndex;
  if (place >= count) return;
  uint cell = cells[place];
  dvec4 point = dvec4(points[cell]);
  double value = weight_factor * point.w + dot(direction, point.xyz);
  double u = (value - low) * over_range;
  double v = u < 0.0lf ? 1.0lf / (1.0lf - u) : (u <= 1.0lf ? 1.0lf + u : 3.0lf - 1.0lf / u);
  keyed[place] = uvec2(uint(clamp(v * (4294967296.0lf / 3.0lf), 0.0lf, 4294967295.0lf)), cell);
}
