#include "render/cpu/reference_modes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "render/shared/lights.h"
#include "render/shared/materials.h"

namespace atomesh::reference {

namespace {

std::array<double, 4> weights_at(const CellSegment& segment, double depth) {
  const double u = (depth - segment.near_depth) / (segment.far_depth - segment.near_depth);
  std::array<double, 4> weights = segment.near_weights;
  for (std::size_t i = 0; i < 4; ++i) weights[i] += u * (segment.far_weights[i] - segment.near_weights[i]);
  return weights;
}

// The segment from depth 0 on, for cells the eye is in.
void clip_to_front(CellSegment& segment) {
  if (segment.near_depth >= 0.0) return;
  segment.near_weights = weights_at(segment, 0.0);
  segment.near_depth = 0.0;
}

// The segment up to that depth, which lies in it.
void end_at(CellSegment& segment, double depth) {
  segment.far_weights = weights_at(segment, depth);
  segment.far_depth = depth;
}

Vec4 color_at(const Scene& scene, const Tetrahedron& cell, const std::array<double, 4>& weights) {
  Vec4 color(0.0);
  for (std::size_t i = 0; i < 4; ++i) color += weights[i] * Vec4(scene.colors[cell[i]]);
  return color;
}

double scalar_at(const Scene& scene, const Tetrahedron& cell, const std::array<double, 4>& weights) {
  double scalar = 0.0;
  for (std::size_t i = 0; i < 4; ++i) scalar += weights[i] * static_cast<double>(scene.scalars[cell[i]]);
  return scalar;
}

Contribution cross_cell_light(const View& view, const CellOnRay& on_ray, double stretch) {
  const Tetrahedron& cell = view.scene.tetrahedra[on_ray.cell];
  const CellSegment& segment = on_ray.segment;
  const double length = (segment.far_depth - segment.near_depth) * stretch;
  if (view.scene.mode == Mode::volume) {
    return integrate_mapped(view.parameters.volume.color_map, scalar_at(view.scene, cell, segment.near_weights),
                            scalar_at(view.scene, cell, segment.far_weights), view.parameters.volume.alpha_length,
                            length);
  }
  return integrate_linear(color_at(view.scene, cell, segment.near_weights),
                          color_at(view.scene, cell, segment.far_weights), view.parameters.volume_surface.alpha_length,
                          length);
}

// Unit normal at a crossing: the vertices' interpolated (smooth), else the triangle's.
Vec3 normal_at(const View& view, const TriangleOnRay& hit) {
  const Scene& scene = view.scene;
  const Triangle& corners = scene.surface[hit.triangle];
  if (view.parameters.shading == Shading::smooth) {
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < 3; ++i) sum += hit.crossing.weights[i] * Vec3(scene.vertex_normals[corners[i]]);
    if (glm::length(sum) > 0.0) return glm::normalize(sum);
  }
  return Vec3(scene.face_normals[hit.triangle]);
}

Contribution layer_light(const View& view, const PixelRay& ray, const TriangleOnRay& hit) {
  const VolumeSurfaceParameters& p = view.parameters.volume_surface;
  const Triangle& corners = view.scene.surface[hit.triangle];
  Vec3 color(0.0);
  for (std::size_t i = 0; i < 3; ++i) color += hit.crossing.weights[i] * Vec3(view.scene.colors[corners[i]]);
  const Vec3 lit = phong(optics::layer_material(p, Vec3f(color)), view.sight.point(ray, hit.crossing.depth),
                         normal_at(view, hit), view.sight.to_viewer(ray), view.lights);
  return {p.face_alpha * lit, 1.0 - p.face_alpha};
}

}  // namespace

View::View(const Scene& s, const Camera& camera, const Parameters& p)
    : scene(s), parameters(p), sight(s, camera), lights(optics::scene_lights(p, s, camera)) {}

std::vector<CellOnRay> cells_on_ray(const View& view, const PixelRay& ray, std::span<const Index> candidates) {
  std::vector<CellOnRay> met;
  for (const Index cell : candidates) {
    auto segment = view.sight.cross_cell(ray, view.scene.tetrahedra[cell]);
    if (!segment || segment->far_depth <= 0.0) continue;
    clip_to_front(*segment);
    met.push_back({cell, *segment});
  }
  std::sort(met.begin(), met.end(), [](const CellOnRay& a, const CellOnRay& b) {
    return std::tie(a.segment.near_depth, a.segment.far_depth, a.cell) <
           std::tie(b.segment.near_depth, b.segment.far_depth, b.cell);
  });
  return met;
}

std::vector<TriangleOnRay> triangles_on_ray(const View& view, const PixelRay& ray, std::span<const Index> candidates) {
  std::vector<TriangleOnRay> met;
  for (const Index triangle : candidates) {
    const auto crossing = view.sight.cross_triangle(ray, view.scene.surface[triangle]);
    if (crossing && crossing->depth > 0.0) met.push_back({triangle, *crossing});
  }
  std::sort(met.begin(), met.end(), [](const TriangleOnRay& a, const TriangleOnRay& b) {
    return std::tie(a.crossing.depth, a.triangle) < std::tie(b.crossing.depth, b.triangle);
  });
  return met;
}

Seen see_volume(const View& view, const PixelRay& ray, std::span<const Index> cells, std::span<const Index> triangles,
                double ray_end) {
  const double stretch = view.sight.stretch(ray);
  const std::vector<CellOnRay> met = cells_on_ray(view, ray, cells);
  const std::vector<TriangleOnRay> crossings = triangles_on_ray(view, ray, triangles);
  Seen seen;
  auto crossing = crossings.begin();
  // Layers in front of everything that begins at or behind their depth. The cell behind a triangle begins at exactly
  // the triangle's depth.
  const auto lay_up_to = [&](double depth) {
    for (; crossing != crossings.end() && crossing->crossing.depth <= depth; ++crossing) {
      if (crossing->crossing.entering) compose(seen.light, layer_light(view, ray, *crossing));
    }
  };
  for (CellOnRay on_ray : met) {
    if (on_ray.segment.near_depth >= ray_end) break;
    if (on_ray.segment.far_depth > ray_end) end_at(on_ray.segment, ray_end);
    lay_up_to(on_ray.segment.near_depth);
    compose(seen.light, cross_cell_light(view, on_ray, stretch));
  }
  lay_up_to(std::numeric_limits<double>::infinity());
  seen.steps = met.size();
  return seen;
}

Seen see_surface(const View& view, const PixelRay& ray, std::span<const Index> triangles) {
  std::vector<TriangleOnRay> met = triangles_on_ray(view, ray, triangles);
  if (view.scene.far_walls) {
    std::erase_if(met, [](const TriangleOnRay& hit) { return hit.crossing.entering; });
    std::reverse(met.begin(), met.end());
  }
  Seen seen;
  if (met.empty()) return seen;
  const TriangleOnRay& hit = met.front();
  // From inside the sample one sees the backs of triangles, lit as if they were fronts.
  const Vec3 normal = hit.crossing.entering ? normal_at(view, hit) : -normal_at(view, hit);
  seen.light.color = phong(optics::surface_material(view.parameters.surface), view.sight.point(ray, hit.crossing.depth),
                           normal, view.sight.to_viewer(ray), view.lights);
  seen.light.transmittance = 0.0;
  seen.depth = hit.crossing.depth;
  seen.id = hit.triangle;
  seen.steps = 1;
  return seen;
}

Seen see_xray(const View& view, const PixelRay& ray, std::span<const Index> triangles) {
  Seen seen;
  double inside = 0.0;
  for (const TriangleOnRay& hit : triangles_on_ray(view, ray, triangles)) {
    inside += hit.crossing.entering ? -hit.crossing.depth : hit.crossing.depth;
    ++seen.steps;
  }
  // Crossings of one depth can leave a rounding of it.
  seen.thickness = std::max(0.0, inside) * view.sight.stretch(ray);
  const double opacity = std::min(1.0, view.parameters.xray.alpha_length * seen.thickness);
  seen.light.color = opacity * Vec3(view.parameters.xray.color);
  seen.light.transmittance = 1.0 - opacity;
  return seen;
}

Seen see_balls(const View& view, const optics::BallRay& ray, std::span<const Index> balls) {
  struct Hit {
    double length;
    Index ball;
  };
  std::vector<Hit> hits;
  for (const Index ball : balls) {
    const double length = optics::length_to_ball(ray, view.scene.balls[ball]);
    if (std::isfinite(length)) hits.push_back({length, ball});
  }
  std::sort(hits.begin(), hits.end(),
            [](const Hit& a, const Hit& b) { return std::tie(a.length, a.ball) < std::tie(b.length, b.ball); });
  Seen seen;
  for (const Hit& hit : hits) {
    const Ball& ball = view.scene.balls[hit.ball];
    const Vec3 point = ray.origin + hit.length * ray.direction;
    const Vec3 lit = phong(optics::ball_material(Vec3f(ball.color)), point, glm::normalize(point - Vec3(ball.center)),
                           -ray.direction, view.lights);
    const double opacity = static_cast<double>(ball.color.a);
    compose(seen.light, {opacity * lit, 1.0 - opacity});
  }
  if (!hits.empty()) {
    seen.depth = hits.front().length * glm::dot(ray.direction, view.sight.camera().forward);
    seen.id = view.scene.balls[hits.front().ball].atom;
  }
  seen.steps = hits.size();
  return seen;
}

}  // namespace atomesh::reference
