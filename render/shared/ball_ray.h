// Whether and where a ray meets a ball. Every renderer decides it with these lines, in double: where a ray touches a
// ball, or two balls cut each other, the last bit decides what is seen, and it has to be the same bit.
#pragma once

#include <cmath>
#include <limits>

#include "core/camera.h"
#include "render/scene.h"

namespace atomesh::optics {

// A ray in scene coordinates; `direction` is a unit vector, lengths in Å.
struct BallRay {
  Vec3 origin;
  Vec3 direction;
};

// The ray through the centre of a pixel.
inline BallRay ball_ray(const Scene& scene, const Camera& camera, int column, int row) {
  const Ray r = ray(camera, camera.x_of(column), camera.y_of(row));
  return {r.origin - scene.center, glm::normalize(r.direction)};
}

// Length along the ray to the nearer intersection; infinity where the ray passes by, or where that intersection is not
// in front of the origin (an eye inside a ball does not see it).
inline double length_to_ball(const BallRay& ray, const Ball& ball) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  const Vec3 to_center = Vec3(ball.center) - ray.origin;
  const double middle = glm::dot(to_center, ray.direction);
  const Vec3 across = to_center - middle * ray.direction;
  const double left = static_cast<double>(ball.radius) * ball.radius - glm::dot(across, across);
  if (left < 0.0) return nowhere;
  const double length = middle - std::sqrt(left);
  return length > 0.0 ? length : nowhere;
}

}  // namespace atomesh::optics
