// A front face of a cell (render/gl/front_faces.h). All vertices have the same w of clip space, so that everything is
// linear on the screen.
//
// What all fragments of a view have in common goes along with the triangle, too: llvmpipe fetches a uniform for each
// fragment by itself.
layout(location = 0) in vec4 entry;   // column, row, w and u where the ray enters
layout(location = 1) in vec4 behind;  // ways to the planes behind; slope of u

uniform float pixel_scale;  // 2 / the viewport's side
uniform vec2 depth_scale;   // depth in [-1,1] = w · x + y
uniform float reference;    // ScreenView::reference
uniform float last_w;       // ScreenView::last_w
uniform vec4 direction;     // x and y of the image plane at a fragment = direction.xy + direction.zw · gl_FragCoord.xy

noperspective out vec4 entry_at;  // u, ways to the planes behind
noperspective out float w_at;
flat out vec3 along;  // slope of u; reference, last_w
flat out vec4 direction_at;

void main() {
  gl_Position = vec4(entry.xy * pixel_scale, entry.z * depth_scale.x + depth_scale.y, 1.0);
  entry_at = vec4(entry.w, behind.xyz);
  w_at = entry.z;
  along = vec3(behind.w, reference, last_w);
  direction_at = direction;
}
