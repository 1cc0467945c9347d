#include "app/gui/gpu_shaders.h"

namespace atomesh::gui {

namespace {

constexpr const char* version = "#version 150\n";

// GpuView.
constexpr const char* view_declarations = R"(
uniform vec2 picture;
uniform bool perspective;
uniform float pixel;
uniform float reach;
)";

// A point of the scene in the eye's space.
constexpr const char* to_eye_space = R"(
uniform vec3 eye;
uniform vec3 eye_rest;
uniform mat3 axes;
vec3 in_eye_space(vec3 point) { return axes * ((point - eye) - eye_rest); }
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

}  // namespace

std::string whole_picture_vertex_shader() {
  return std::string(version) + R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
}

std::string ball_vertex_shader() {
  return std::string(version) + view_declarations + to_eye_space + R"(
in vec3 center;
in float radius;
uniform int first;
flat out vec4 ball;
flat out uint index;

// Slopes between which lines through the eye meet the circle of radius r about (x, z), z > r.
vec2 tangent_slopes(float x, float z, float r) {
  float square = (z - r) * (z + r);
  float root = r * sqrt(max(0.0, x * x + square));
  return vec2(x * z - root, x * z + root) / square;
}

void main() {
  vec3 c = in_eye_space(center);
  float r = radius * 1.00001;
  ball = vec4(c, radius);
  index = uint(first + gl_InstanceID);
  bvec2 far_corner = bvec2((gl_VertexID & 1) != 0, (gl_VertexID & 2) != 0);
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
  gl_Position = c.z + r <= 0.0 ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(corner / all, 2.0 * depth - 1.0, 1.0);
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
  return std::string(version) + view_declarations + to_eye_space + sight + phong + ball_hit + R"(
uniform usampler2D hits;
uniform samplerBuffer balls;
uniform int first;
uniform int count;
uniform float ambient_share;
uniform float diffuse_share;
out vec4 color;

float part(int ball, int k) { return texelFetch(balls, 9 * ball + k).x; }

void main() {
  uint hit = texelFetch(hits, ivec2(gl_FragCoord.xy), 0).x;
  int ball = int(hit) - first;
  if (hit == 0xFFFFFFFFu || ball < 0 || ball >= count) discard;
  vec3 center = in_eye_space(vec3(part(ball, 0), part(ball, 1), part(ball, 2)));
  vec4 own = vec4(part(ball, 4), part(ball, 5), part(ball, 6), part(ball, 7));
  vec3 origin;
  vec3 direction;
  vec3 normal;
  look(origin, direction);
  float at = length_to_ball(center, part(ball, 3), origin, direction, normal);
  vec3 lit = phong(ambient_share * own.rgb, diffuse_share * own.rgb, vec3(0.2), vec3(0.0), 30.0,
                   origin + at * direction, normalize(normal), -direction);
  color = vec4(own.a * lit, own.a);
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
