// A front face of a cell (render/gl/front_faces.h). All vertices have the same w of clip space, so that everything is
// linear on the screen.
layout(location = 0) in vec4 entry;   // column, row, w and u where the ray enters
layout(location = 1) in vec4 behind;  // ways to the planes behind; slope of u

uniform float pixel_scale;  // 2 / the viewport's side
uniform vec2 depth_scale;   // depth in [-1,1] = w · x + y

noperspective out vec4 entry_at;  // u, ways to the planes behind
noperspective out vec2 way_at;    // w, slope of u

void main() {
  gl_Position = vec4(entry.xy * pixel_scale, entry.z * depth_scale.x + depth_scale.y, 1.0);
  entry_at = vec4(entry.w, behind.xyz);
  way_at = vec2(entry.z, behind.w);
}
