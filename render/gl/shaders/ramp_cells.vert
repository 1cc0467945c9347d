// cells.vert for cells whose light is a sum of ramps (render/gl/map_ramps.h). Faces may be those of the mirrored cell
// (fewest_faces()).
layout(location = 0) in vec4 entry;   // column, row, w and u where the ray enters
layout(location = 1) in vec4 behind;  // ways to the planes behind; slope of u
layout(location = 2) in vec2 ramp;    // row of ramp_rows, 8 texels each; the longest way to the planes behind

layout(binding = 7) uniform samplerBuffer ramp_rows;
uniform float pixel_scale;
uniform vec2 depth_scale;
uniform float reference;
uniform vec4 direction;  // as cells.vert has it
uniform vec2 middle;     // gl_FragCoord where column and row are 0

noperspective out vec4 entry_at;
noperspective out vec2 way_at;  // w; Å for each unit of way / (w · far w), or of way
// The row: RGB and extinction of the first piece; by which they go up from there; with the scalar's square, and the
// lowest scalar; what the first knot adds; with the square, and the highest scalar; the second knot; and where it is.
flat out vec4 piece, piece_slope, piece_square;
// Slope of u; scalar from which the row's are counted; longest way; of cells of one piece the highest scalar.
#ifdef ONE_PIECE
flat out vec4 along;
#else
flat out vec3 along;
flat out vec4 knot, knot_square, next_knot, next_knot_square;
#endif

void main() {
  gl_Position = vec4(entry.xy * pixel_scale, entry.z * depth_scale.x + depth_scale.y, 1.0);
  entry_at = vec4(entry.w, behind.xyz);
#ifdef PERSPECTIVE
  // Linear on the screen so nearly that it may be interpolated: these triangles are small.
  vec2 slope = direction.xy + direction.zw * (entry.xy + middle);
  way_at = vec2(entry.z, reference * sqrt(1.0 + dot(slope, slope)));
#else
  way_at = vec2(entry.z, 1.0);
#endif
  int texel = 8 * int(ramp.x);
  piece = texelFetch(ramp_rows, texel);
  piece_slope = texelFetch(ramp_rows, texel + 1);
  piece_square = texelFetch(ramp_rows, texel + 2);
#ifdef ONE_PIECE
  along.w = texelFetch(ramp_rows, texel + 4).a;
#else
  knot = texelFetch(ramp_rows, texel + 3);
  knot_square = texelFetch(ramp_rows, texel + 4);
  next_knot = texelFetch(ramp_rows, texel + 5);
  next_knot_square = texelFetch(ramp_rows, texel + 6);
#endif
  along.xyz = vec3(behind.w, texelFetch(ramp_rows, texel + 7).x, ramp.y);
}
