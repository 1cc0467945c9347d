// Materials and views for the tests of render/: small, chosen by property, made without any preprocessing.
#pragma once

#include <functional>
#include <string>

#include "core/camera.h"
#include "core/material.h"
#include "core/parameters.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::test {

// A box of nx × ny × nz cubes of side `step` Å from the origin, each split into six tetrahedra along its diagonal
// (1,1,1) (Kuhn), so that faces match. `move` may shift the points, as long as no tetrahedron turns over.
Material box_material(int nx, int ny, int nz, double step, const std::function<Vec3(const Vec3&)>& move = nullptr);
// One tetrahedron with legs of 1 Å along the axes.
Material one_tetrahedron();
// Three bars of one tetrahedron each (vertices 4k to 4k+3) that from the front stand before one another in a circle.
Material ring_of_bars();
// Atoms only, of the species named, no mesh.
Material atoms_material(const std::vector<std::pair<std::string, Vec3>>& atoms);

// Random defect values in [0,1) at every atom (about a third of them zero).
void add_defects(Material& material, std::uint64_t seed);

// For box_material: shifts every point by up to `amplitude` along each axis.
std::function<Vec3(const Vec3&)> shaking(double amplitude, std::uint64_t seed);

// Parameters of a mode and view with the sample's centre in the middle of the picture.
Parameters looking(Mode mode, std::string_view view, Projection projection = Projection::parallel);

inline constexpr Mode all_modes[] = {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};

// A shaken box with defects, seen aslant, ready to be drawn in a mode; layers and balls half transparent.
struct Subject {
  Material material;
  Parameters parameters;
  Scene scene;
  Camera camera;
};
Subject shaken_box(Mode mode, Projection projection, int width, int height);

struct Drawn {
  Image image;  // premultiplied, without background
  RenderStats stats;
  std::vector<float> thickness;
  std::vector<float> depth;
  std::vector<Index> id;
};
Drawn draw(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters);

}  // namespace atomesh::test
