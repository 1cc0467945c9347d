// The light of a ray's segment along which the scalar goes linearly, seen through the colour map at every point
// (render/shared/optics.h). To be included by shaders that are run after PreintegrationTable::bind().
//
//   vec4 segment_light(float scalar_near, float scalar_far, float length)
//
// scalar in [0,1] where the ray enters and where it leaves, length in Å: premultiplied RGB and opacity. Any finite
// values are fine; of equal scalars and length 0 too.
//
// Defines: TABLE looks it up in the pre-integration table; without, or with EXACT, it is integrated exactly.
// Reads texture unit 8 (the table; without TABLE the map in pieces, segment_map.glsl) and, with TABLE, uniform block 8.

#ifdef TABLE

layout(binding = 8) uniform sampler3D segment_table;  // E and κ of render/gl/preintegration_map.h
layout(std140, binding = 8) uniform SegmentTable {
  vec2 segment_scalars;  // from a scalar to the texture's coordinate: factor, and what is added
  vec2 segment_layers;   // from length / (length + bend) to the texture's coordinate
  float segment_bend;    // Å
};

vec4 segment_light(float scalar_near, float scalar_far, float length) {
  vec2 scalars = vec2(scalar_near, scalar_far) * segment_scalars.x + segment_scalars.y;
  float layer = length / (length + segment_bend) * segment_layers.x + segment_layers.y;
  vec4 entry = textureLod(segment_table, vec3(scalars, layer), 0.0);
  float depth = entry.a * length;
  // 1 - e^-depth and the same divided by the extinction; where thin by their series, to float's last places.
  float series = 1.0 - depth * (1.0 / 2.0) * (1.0 - depth * (1.0 / 3.0) * (1.0 - depth * (1.0 / 4.0)));
  bool thin = depth < 0.0625;
  float opacity = thin ? depth * series : 1.0 - exp(-depth);
  float way = thin ? length * series : opacity / entry.a;
  return vec4(entry.rgb * way, opacity);
}

#else

#include "segment_map.glsl"

// Weights of the piece's first colour and of what colours change by: integrate_piece() of render/shared/segment.h.
vec2 segment_piece(float mean, float half_difference) {
  float half_mean = 0.5 * mean;
  float x = half_mean * half_mean;
  float y = 0.25 * half_difference;
  float s = fma(y, 3.07840308e-3, fma(x, 7.69600770e-4, 1.69312169e-2));
  s = fma(y, s, fma(x, 4.23280423e-3, 7.61904762e-2));
  s = fma(y, s, fma(x, fma(x, 5.29100529e-4, 1.90476190e-2), 2.66666667e-1));
  s = fma(y, s, fma(x, fma(x, 2.38095238e-3, 6.66666667e-2), 6.66666667e-1));
  float even = fma(x, fma(x, 1.98412698e-4, 8.33333333e-3), 1.66666667e-1);
  s = fma(y, s, fma(x, even, 1.0));
  float root = fma(half_mean, -1.0 / 5040.0, 1.0 / 720.0);
  root = fma(half_mean, root, -1.0 / 120.0);
  root = fma(half_mean, root, 1.0 / 24.0);
  root = fma(half_mean, root, -1.0 / 6.0);
  root = fma(half_mean, root, 0.5);
  root = fma(half_mean, root, -1.0);
  root = fma(half_mean, root, 1.0);
  float through = root * root;
  return vec2(1.0 - through, fma(root, s, -through));
}

// The segment is cut at the map's knots, and within pieces of the map where it is deeper than 1; each part by the
// closed form. Some drivers run both sides of every branch, and a loop's body once at least: hence one body that does
// all, its first pass the last one of most segments.
vec4 segment_light(float scalar_near, float scalar_far, float length) {
  float change = scalar_far - scalar_near;
  bool up = change >= 0.0;
  int place = segment_first_piece(scalar_near, up);
  float u = 0.0;
  float through = 1.0;
  vec3 color = vec3(0.0);
  // 33 pieces of the map at most, and 17 of optical depth 1 until nothing is left.
  for (int n = 0; n < 64; ++n) {
    vec4 first = texelFetch(segment_pieces, place);
    vec4 slope = texelFetch(segment_pieces, place + 1);
    vec4 range = texelFetch(segment_pieces, place + 2);
    float u_knot = segment_knot(range.xy, scalar_near, scalar_far, u);
    float rest = u_knot - u;
    float beyond = fma(u, change, scalar_near) - range.x;
    // Bounded, so that its square is a float, too.
    float density = clamp(fma(slope.a, beyond, first.a) * length, 0.0, 1e15);
    float half_difference = 0.5 * slope.a * change * length;
    float reach = 2.0 / (density + sqrt(max(fma(density, density, 4.0 * half_difference), 0.0)));
    bool whole = rest * fma(half_difference, rest, density) <= 1.0 || reach >= rest;
    float h = whole ? rest : reach;
    float bend = half_difference * h * h;
    float mean = clamp(fma(density, h, bend), 0.0, 1.0);
    vec2 piece = segment_piece(mean, clamp(bend, -mean, mean));
    vec3 piece_color = fma(slope.rgb, vec3(beyond), first.rgb) * piece.x + slope.rgb * (change * h * piece.y);
    color = fma(vec3(through), piece_color, color);
    through = fma(-through, piece.x, through);
    u = whole ? u_knot : u + h;
    if (u >= 1.0 || through < 1e-7) break;
    if (whole) place = int(range.z) + (up ? 3 : -3);
  }
  return vec4(color, 1.0 - through);
}

#endif
