#include "render/cpu/surface_shader.h"

#include <algorithm>

#include "render/shared/lights.h"
#include "render/shared/materials.h"

namespace atomesh {

namespace {

// Barycentric weights of a point on a triangle, kept inside against rounding.
Vec3 weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::cross(b - a, c - a);
  const double square = glm::dot(normal, normal);
  if (!(square > 0.0)) return Vec3(1.0 / 3.0);
  Vec3 w(glm::dot(glm::cross(c - b, p - b), normal), glm::dot(glm::cross(a - c, p - c), normal),
         glm::dot(glm::cross(b - a, p - a), normal));
  w = glm::max(w, Vec3(0.0));
  const double sum = w.x + w.y + w.z;
  return sum > 0.0 ? w / sum : Vec3(1.0 / 3.0);
}

}  // namespace

SurfaceShader::SurfaceShader(const Scene& scene, const Camera& camera, const Parameters& parameters)
    : scene_(scene),
      camera_(camera),
      parameters_(parameters),
      lights_(optics::scene_lights(parameters, scene, camera)) {}

Vec3f SurfaceShader::shade(Index triangle, double x, double y, double depth, bool from_behind) const {
  const Ray sight = ray(camera_, x, y);
  const Vec3 point = sight.origin - scene_.center + depth * sight.direction;
  const Triangle& corners = scene_.surface[triangle];
  const Vec3 w = weights(point, Vec3(scene_.vertices[corners[0]]), Vec3(scene_.vertices[corners[1]]),
                         Vec3(scene_.vertices[corners[2]]));
  const auto interpolated = [&](auto&& attribute) {
    return static_cast<float>(w.x) * attribute(corners[0]) + static_cast<float>(w.y) * attribute(corners[1]) +
           static_cast<float>(w.z) * attribute(corners[2]);
  };
  Vec3f normal = scene_.face_normals[triangle];
  if (!scene_.vertex_normals.empty()) {
    const Vec3f smooth = interpolated([&](Index v) { return scene_.vertex_normals[v]; });
    const float length = glm::length(smooth);
    if (length > 0.0F) normal = smooth / length;
  }
  if (from_behind) normal = -normal;
  const optics::PhongCoefficients material =
      scene_.mode == Mode::surface
          ? optics::surface_material(parameters_.surface)
          : optics::layer_material(parameters_.volume_surface,
                                   interpolated([&](Index v) { return Vec3f(scene_.colors[v]); }));
  return optics::phong(material, Vec3f(point), normal, Vec3f(-glm::normalize(sight.direction)), lights_.data(),
                       static_cast<int>(lights_.size()));
}

}  // namespace atomesh
