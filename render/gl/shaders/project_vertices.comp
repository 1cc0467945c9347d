// Vertices on the rasterizer's grid: ScreenMesh::on_screen() of render/gl/screen_mesh.cpp, in the same steps, for views
// in which nothing has to be clipped.
layout(local_size_x = 256) in;

#include "screen_vertex.glsl"

uniform uint count;
// ScreenView
uniform bool perspective;
uniform double reference;
uniform dvec4 grid;   // x, y, dx, dy
uniform ivec2 middle; // columns / 2, rows / 2
uniform int guard;    // subpixels
// Scene::center from the eye, and the camera's axes
uniform dvec3 offset;
uniform dvec3 right;
uniform dvec3 up;
uniform dvec3 forward;

layout(std430, binding = 0) readonly buffer Vertices { vec4 vertices[]; };  // about Scene::center, and the scalar
layout(std430, binding = 1) writeonly buffer Projected { ScreenVertex projected[]; };

double along(dvec3 axis, dvec3 p) {
  precise double sum = axis.x * p.x + axis.y * p.y + axis.z * p.z;
  return sum;
}

// To the nearest, from the middle away from 0, as lround().
int rounded(double x) {
  double whole = floor(abs(x) + 0.5lf);
  return clamp(int(x < 0.0lf ? -whole : whole), -guard, guard);
}

void main() {
  // more than the groups of one dimension may be
  uint place = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + gl_LocalInvocationIndex;
  if (place >= count) return;
  vec4 vertex = vertices[place];
  precise dvec3 p = dvec3(vertex.xyz) + offset;
  precise double x = along(right, p);
  precise double y = along(up, p);
  precise double z = along(forward, p);
  precise double scale = perspective ? 1.0lf / z : 1.0lf;
  precise double column = ((x * scale - grid.x) / grid.z + 0.5lf - double(middle.x)) * 256.0lf;
  precise double row = ((grid.y - y * scale) / grid.w + 0.5lf - double(middle.y)) * 256.0lf;
  precise float w = float(perspective ? -reference * scale : z - reference);
  precise float u = perspective ? -vertex.w * w : vertex.w;
  projected[place] = ScreenVertex(ivec2(rounded(column), rounded(row)), w, u);
}
