// The judge's five modes, each as the colour of one ray.
#pragma once

#include <limits>
#include <vector>

#include "render/cpu/reference_bins.h"
#include "render/cpu/reference_optics.h"
#include "render/cpu/reference_sight.h"
#include "render/renderer.h"
#include "render/shared/ball_ray.h"

namespace atomesh::reference {

// What a ray sees. Fields a mode does not have keep their values.
struct Seen {
  Contribution light;
  double thickness = 0.0;                                  // Å inside the sample
  double depth = std::numeric_limits<double>::infinity();  // of the nearest hit
  Index id = no_index;                                     // of the nearest hit
  std::size_t steps = 0;
};

// Everything that is the same for all rays of a picture.
struct View {
  const Scene& scene;
  const Parameters& parameters;
  Sight sight;
  std::vector<optics::LightRay> lights;

  View(const Scene& s, const Camera& camera, const Parameters& p);
};

// The stretches of the ray inside cells in front of the eye, by depth.
struct CellOnRay {
  Index cell;
  CellSegment segment;  // clipped to depths ≥ 0
};
std::vector<CellOnRay> cells_on_ray(const View& view, const PixelRay& ray, std::span<const Index> candidates);

// The crossings of surface triangles in front of the eye, by depth.
struct TriangleOnRay {
  Index triangle;
  Crossing crossing;
};
std::vector<TriangleOnRay> triangles_on_ray(const View& view, const PixelRay& ray, std::span<const Index> candidates);

// The ray ends at depth `ray_end`.
Seen see_volume(const View& view, const PixelRay& ray, std::span<const Index> cells, std::span<const Index> triangles,
                double ray_end = std::numeric_limits<double>::infinity());
Seen see_surface(const View& view, const PixelRay& ray, std::span<const Index> triangles);
Seen see_xray(const View& view, const PixelRay& ray, std::span<const Index> triangles);
Seen see_balls(const View& view, const optics::BallRay& ray, std::span<const Index> balls);

}  // namespace atomesh::reference
