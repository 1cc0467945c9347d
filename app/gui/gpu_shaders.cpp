#include "app/gui/gpu_shaders.h"

namespace atomesh::gui {

namespace {

constexpr const char* version = "#version 150\n";
constexpr const char* later_version = "#version 450\n";  // for lists

// GpuView.
constexpr const char* view_declarations = R"(
uniform vec2 picture;
uniform bool perspective;
uniform float pixel;
uniform float reach;
)";

// A point of the scene in the eye's space.
constexpr const char* to_eye_space = R"(
uniform vec3 anchor;
uniform vec3 anchor_rest;
uniform float anchor_depth;
uniform mat3 axes;
vec3 in_eye_space(vec3 point) { return axes * ((point - anchor) - anchor_rest) + vec3(0.0, 0.0, anchor_depth); }
)";

// The ray through the fragment's centre.
constexpr const char* sight = R"(
void look(out vec3 origin, out vec3 direction) {
  vec2 at = (gl_FragCoord.xy - 0.5 * picture) * pixel;
  origin = perspective ? vec3(0.0) : vec3(at, 0.0);
  direction = perspective ? normalize(vec3(at, 1.0)) : vec3(0.0, 0.0, 1.0);
}
)";

constexpr const char* phong = R"(
uniform int light_count;
uniform vec3 light_positions[8];
uniform vec3 light_colors[8];
vec3 phong(vec3 ambient, vec3 diffuse, vec3 specular, vec3 emission, float shininess, vec3 point, vec3 normal,
           vec3 to_viewer) {
  vec3 color = emission + ambient;
  for (int i = 0; i < light_count; ++i) {
    vec3 to_light = normalize(light_positions[i] - point);
    float cosine = dot(normal, to_light);
    if (cosine <= 0.0) continue;
    color += diffuse * light_colors[i] * cosine;
    float along = dot(2.0 * cosine * normal - to_light, to_viewer);
    if (along > 0.0) color += specular * light_colors[i] * pow(along, shininess);
  }
  return clamp(color, 0.0, 1.0);
}
)";

// A number of a ball, as struct Ball has them.
constexpr const char* ball_parts = R"(
uniform samplerBuffer balls;
float part(int ball, int k) { return texelFetch(balls, 9 * ball + k).x; }
)";

// The front hit of a ball in the eye's space; negative where there is none. The normal comes without the difference of
// two large numbers.
constexpr const char* ball_hit = R"(
float length_to_ball(vec3 center, float radius, vec3 origin, vec3 direction, out vec3 normal) {
  vec3 to_center = center - origin;
  float middle = dot(to_center, direction);
  vec3 across = to_center - middle * direction;
  float left = radius * radius - dot(across, across);
  if (left < 0.0) return -1.0;
  float half_chord = sqrt(left);
  normal = -(across + half_chord * direction) / radius;
  return middle - half_chord;
}
)";

std::string in_later_version(std::string shader) {
  return shader.replace(0, std::string(version).size(), later_version);
}

// What a ball shows to the fragment's ray, and its opacity.
constexpr const char* shaded_ball = R"(
uniform float ambient_share;
uniform float diffuse_share;
vec4 shaded(int ball) {
  vec3 center = in_eye_space(vec3(part(ball, 0), part(ball, 1), part(ball, 2)));
  vec4 own = vec4(part(ball, 4), part(ball, 5), part(ball, 6), part(ball, 7));
  vec3 origin;
  vec3 direction;
  vec3 normal;
  look(origin, direction);
  float at = length_to_ball(center, part(ball, 3), origin, direction, normal);
  return vec4(phong(ambient_share * own.rgb, diffuse_share * own.rgb, vec3(0.2), vec3(0.0), 30.0,
                    origin + at * direction, normalize(normal), -direction), own.a);
}
)";

// Each pixel's hits as a list: three numbers each, the next one's place, the ball, and the length to it.
constexpr const char* lists = R"(
layout(binding = 0, r32ui) coherent uniform uimage2D heads;
layout(std430, binding = 0) coherent buffer Hits { uint hits[]; };
const uint none = 0xFFFFFFFFu;
)";

}  // namespace

std::string whole_picture_vertex_shader() {
  return std::string(version) + R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
}

std::string ball_vertex_shader() {
  return std::string(version) + view_declarations + to_eye_space + ball_parts + R"(
uniform int first;
uniform int wanted;  // 0: all balls, 1: opaque ones, 2: the others
flat out vec4 ball;
flat out uint index;

// Slopes between which lines through the eye meet the circle of radius r about (x, z), z > r.
vec2 tangent_slopes(float x, float z, float r) {
  float square = (z - r) * (z + r);
  float root = r * sqrt(max(0.0, x * x + square));
  return vec2(x * z - root, x * z + root) / square;
}

void main() {
  int number = gl_VertexID / 6;
  int corner_number = gl_VertexID - 6 * number;
  float radius = part(number, 3);
  vec3 c = in_eye_space(vec3(part(number, 0), part(number, 1), part(number, 2)));
  float r = radius * 1.00001;
  ball = vec4(c, radius);
  index = uint(first + number);
  // Two triangles: corners 0, 1, 2 and 3, 2, 1 of 0 to 3.
  int of_four = corner_number < 3 ? corner_number : 6 - corner_number;
  bvec2 far_corner = bvec2((of_four & 1) != 0, (of_four & 2) != 0);
  vec2 all = 0.5 * picture * pixel;
  vec2 low = c.xy - r;
  vec2 high = c.xy + r;
  float nearest = c.z - r;
  if (perspective) {
    nearest = length(c) - r;
    if (c.z <= 1.0001 * r) {
      low = -all;
      high = all;
    } else {
      vec2 across = tangent_slopes(c.x, c.z, r);
      vec2 upward = tangent_slopes(c.y, c.z, r);
      low = vec2(across.x, upward.x);
      high = vec2(across.y, upward.y);
    }
  }
  // A little wider than the outline, a little nearer than the ball: the fragment decides.
  low = max(low - 0.05 * pixel, -1.1 * all);
  high = min(high + 0.05 * pixel, 1.1 * all);
  float depth = max(0.0, nearest * reach * 0.99999 - 1e-6);
  vec2 corner = vec2(far_corner.x ? high.x : low.x, far_corner.y ? high.y : low.y);
  bool drawn = c.z + r > 0.0 && (wanted == 0 || (part(number, 7) >= 1.0) == (wanted == 1));
  gl_Position = drawn ? vec4(corner / all, 2.0 * depth - 1.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
)";
}

std::string ball_layer_shader() {
  // Told that no fragment comes nearer than its rectangle, the card can leave out hidden ones unshaded.
  return std::string(version) + "#extension GL_ARB_conservative_depth : enable\n" + view_declarations + sight +
         ball_hit + R"(
#ifdef GL_ARB_conservative_depth
layout(depth_greater) out float gl_FragDepth;
#endif
flat in vec4 ball;
flat in uint index;
uniform int layer;
uniform float opaque;  // coverage behind which nothing is seen
uniform usampler2D layer_before;
uniform sampler2D depth_before;
uniform sampler2D light;
out uint hit;

void main() {
  vec3 origin;
  vec3 direction;
  vec3 normal;
  look(origin, direction);
  float depth = length_to_ball(ball.xyz, ball.w, origin, direction, normal) * reach;
  if (depth <= 0.0) discard;
  if (layer > 0) {
    ivec2 place = ivec2(gl_FragCoord.xy);
    uint nearer = texelFetch(layer_before, place, 0).x;
    float before = texelFetch(depth_before, place, 0).x;
    if (depth < before || (depth == before && index < nearer) || index == nearer || nearer == 0xFFFFFFFFu) discard;
    if (texelFetch(light, place, 0).a >= opaque) discard;
  }
  hit = index;
  gl_FragDepth = depth;
}
)";
}

std::string ball_shading_shader() {
  return std::string(version) + view_declarations + to_eye_space + sight + phong + ball_parts + ball_hit + shaded_ball +
         R"(
uniform usampler2D hits;
uniform int first;
uniform int count;
out vec4 color;

void main() {
  uint hit = texelFetch(hits, ivec2(gl_FragCoord.xy), 0).x;
  int ball = int(hit) - first;
  if (hit == 0xFFFFFFFFu || ball < 0 || ball >= count) discard;
  vec4 lit = shaded(ball);
  color = vec4(lit.a * lit.rgb, lit.a);
}
)";
}

std::string list_vertex_shader() {
  return in_later_version(ball_vertex_shader());
}

std::string list_shader() {
  return std::string(later_version) + view_declarations + sight + ball_hit + lists + R"(
layout(binding = 0) uniform atomic_uint used;
flat in vec4 ball;
flat in uint index;
uniform int room;  // for so many hits; those beyond are only counted
uniform usampler2D opaque_ball;
uniform sampler2D opaque_depth;

void main() {
  vec3 origin;
  vec3 direction;
  vec3 normal;
  look(origin, direction);
  float depth = length_to_ball(ball.xyz, ball.w, origin, direction, normal) * reach;
  ivec2 place = ivec2(gl_FragCoord.xy);
  float behind = texelFetch(opaque_depth, place, 0).x;
  if (depth <= 0.0 || depth > behind || (depth == behind && index > texelFetch(opaque_ball, place, 0).x)) discard;
  uint at = atomicCounterIncrement(used);
  if (at >= uint(room)) discard;
  hits[3u * at] = imageAtomicExchange(heads, place, at);
  hits[3u * at + 1u] = index;
  hits[3u * at + 2u] = floatBitsToUint(depth);
}
)";
}

std::string list_picture_vertex_shader() {
  return in_later_version(whole_picture_vertex_shader());
}

std::string list_shading_shader() {
  return std::string(later_version) + view_declarations + to_eye_space + sight + phong + ball_parts + ball_hit +
         shaded_ball + lists + R"(
uniform float opaque;
out vec4 color;

// The order of render/cpu/ball_hits.h.
bool is_before(float depth, uint ball, float other_depth, uint other_ball) {
  return depth < other_depth || (depth == other_depth && ball < other_ball);
}

void main() {
  // Those beside the picture would walk through lists that are none.
  if (gl_HelperInvocation) return;
  uint head = imageLoad(heads, ivec2(gl_FragCoord.xy)).x;
  if (head == none) discard;
  // In each sweep over the list the nearest so many that are behind those of the sweeps before.
  const int most = 24;
  float depths[most];
  uint balls_met[most];
  float last_depth = -1.0;
  uint last_ball = 0u;
  vec3 sum = vec3(0.0);
  float left = 1.0;
  int count = most;
  while (count == most && left > 1.0 - opaque) {
    count = 0;
    for (uint at = head; at != none; at = hits[3u * at]) {
      uint ball = hits[3u * at + 1u];
      float depth = uintBitsToFloat(hits[3u * at + 2u]);
      if (!is_before(last_depth, last_ball, depth, ball)) continue;
      if (count == most && !is_before(depth, ball, depths[most - 1], balls_met[most - 1])) continue;
      int i = count < most ? count++ : most - 1;
      for (; i > 0 && is_before(depth, ball, depths[i - 1], balls_met[i - 1]); --i) {
        depths[i] = depths[i - 1];
        balls_met[i] = balls_met[i - 1];
      }
      depths[i] = depth;
      balls_met[i] = ball;
    }
    for (int i = 0; i < count && left > 1.0 - opaque; ++i) {
      vec4 lit = shaded(int(balls_met[i]));
      sum += left * lit.a * lit.rgb;
      left *= 1.0 - lit.a;
    }
    if (count > 0) {
      last_depth = depths[count - 1];
      last_ball = balls_met[count - 1];
    }
  }
  color = vec4(sum, 1.0 - left);
}
)";
}

std::string surface_vertex_shader() {
  return std::string(version) + view_declarations + to_eye_space + R"(
in vec3 position;
in vec3 normal;
uniform bool is_smooth;
out vec3 point;
out vec3 vertex_normal;

void main() {
  point = in_eye_space(position);
  vertex_normal = is_smooth ? axes * normal : vec3(0.0);
  // The depth is the fragment's own: no near plane takes anything away in front of the eye.
  gl_Position = vec4(point.xy / (0.5 * picture * pixel), 0.0, perspective ? point.z : 1.0);
}
)";
}

std::string surface_fragment_shader() {
  return std::string(version) + view_declarations + sight + phong + R"(
in vec3 point;
in vec3 vertex_normal;
uniform mat3 axes;
uniform samplerBuffer face_normals;
uniform vec3 ambient;
uniform vec3 diffuse;
uniform vec3 specular;
uniform vec3 emission;
uniform float shininess;
out vec4 color;

void main() {
  if (point.z <= 0.0) discard;
  vec3 origin;
  vec3 direction;
  look(origin, direction);
  vec3 normal = vertex_normal;
  if (dot(normal, normal) > 0.0) {
    normal = normalize(normal);
  } else {
    int at = 3 * gl_PrimitiveID;
    normal = axes * vec3(texelFetch(face_normals, at).x, texelFetch(face_normals, at + 1).x,
                         texelFetch(face_normals, at + 2).x);
  }
  if (!gl_FrontFacing) normal = -normal;
  vec3 hit = origin + (point.z / direction.z) * direction;
  color = vec4(phong(ambient, diffuse, specular, emission, shininess, hit, normal, -direction), 1.0);
  gl_FragDepth = point.z * reach;
}
)";
}

std::string copy_shader() {
  return std::string(version) + R"(
uniform sampler2D light;
out vec4 color;
void main() { color = texelFetch(light, ivec2(gl_FragCoord.xy), 0); }
)";
}

std::string mean_shader() {
  return std::string(version) + R"(
uniform sampler2D rays;
uniform int n;
out vec4 color;
void main() {
  ivec2 corner = n * ivec2(gl_FragCoord.xy);
  vec4 sum = vec4(0.0);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) sum += texelFetch(rays, corner + ivec2(i, j), 0);
  }
  color = sum / float(n * n);
}
)";
}

}  // namespace atomesh::gui
