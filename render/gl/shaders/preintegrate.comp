// Fills the pre-integration table (render/gl/preintegration_map.h): one entry an invocation, as table_entry() there.

#include "segment_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform restrict writeonly image3D table;
layout(location = 0) uniform float longest;  // Å
layout(location = 1) uniform float bend;     // Å

const float deepest = 20.0;
const float piece_depth = 0.25;

void main() {
  ivec3 size = imageSize(table);
  ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, size))) return;
  float scalar_near = float(place.x) / float(size.x - 1);
  float scalar_far = float(place.y) / float(size.y - 1);
  float gamma = float(place.z) / float(size.z - 1);
  float length = gamma * longest * bend / (longest * (1.0 - gamma) + bend);

  const float nodes[4] = float[4](0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558);
  const float weights[4] = float[4](0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226);
  float change = scalar_far - scalar_near;
  bool up = change >= 0.0;
  int first_texel = segment_first_piece(scalar_near, up);
  vec3 emission = vec3(0.0);
  float extinction = 0.0;
  float u = 0.0;
  // 33 pieces of the map, and those of optical depth piece_depth until `deepest`: never more passes.
  float knot = 0.0;
  float before = 0.0;
  for (int n = 0; n < 33 + 4 * 20 + 33; ++n) {
    vec4 first = texelFetch(segment_pieces, first_texel);
    vec4 slope = texelFetch(segment_pieces, first_texel + 1);
    vec4 range = texelFetch(segment_pieces, first_texel + 2);
    knot = segment_knot(range.xy, scalar_near, scalar_far, u);
    float beyond = fma(u, change, scalar_near) - range.x;
    vec4 color = fma(slope, vec4(beyond), first);
    color.a = max(color.a, 0.0);
    float density = color.a * length;
    float rise = slope.a * change * length;
    float rest = knot - u;
    float step = rest;
    bool deep = before >= deepest;
    if (!deep && rest * fma(0.5 * rise, rest, density) > piece_depth) {
      float root = sqrt(max(fma(density, density, 2.0 * piece_depth * rise), 0.0));
      step = min(rest, 2.0 * piece_depth / (density + root));
    }
    if (!deep) {
      for (int k = 0; k < 4; ++k) {
        float way = step * nodes[k];
        vec4 here = fma(slope, vec4(change * way), color);
        float depth = before + way * fma(0.5 * rise, way, density);
        emission += weights[k] * step * max(here.a, 0.0) * exp(-depth) * here.rgb;
      }
    }
    extinction += step * max(fma(0.5 * slope.a * change, step, color.a), 0.0);
    before += step * max(fma(0.5 * rise, step, density), 0.0);
    bool whole = step >= rest;
    u = whole ? knot : u + step;
    if (u >= 1.0) break;
    if (whole) first_texel = int(range.z) + (up ? 3 : -3);
  }
  float y = extinction * length;
  float series = 1.0 - y * (1.0 / 2.0) * (1.0 - y * (1.0 / 3.0) * (1.0 - y * (1.0 / 4.0)));
  emission /= y < 0.0625 ? series : (1.0 - exp(-y)) / y;
  imageStore(table, place, vec4(emission, extinction));
}
