#include "render/scene.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

constexpr std::size_t vertices_per_range = 1 << 14;

bool uses_tetrahedra(Mode mode) {
  return mode == Mode::volume_surface || mode == Mode::volume;
}
bool uses_surface(Mode mode) {
  return mode == Mode::volume_surface || mode == Mode::surface || mode == Mode::xray;
}

void check_parts(const Material& material, Mode mode, bool cut) {
  const std::string wanted = "mode " + std::string(mode_name(mode)) + (cut ? " with cut planes" : "") + " needs the ";
  if (material.atoms.size() == 0 && material.mesh.vertices.empty())
    throw Error(wanted + "atoms; the material has none");
  if (mode == Mode::atoms) {
    if (material.atoms.size() == 0) throw Error(wanted + "atoms; the material has none");
    return;
  }
  // A surface with nothing behind it: the tetrahedra were left out of the file, or out of what was read of it.
  if ((uses_tetrahedra(mode) || cut) && material.mesh.tetrahedra.empty() && !material.surface.triangles.empty()) {
    throw Error(wanted + "tetrahedra; the material has only their surface");
  }
  const std::size_t atoms = material.atoms.size();
  if (uses_tetrahedra(mode) && material.defects.present() && atoms != 0 &&
      material.defects.positional.size() != atoms) {
    throw Error(wanted + "defects of all " + std::to_string(atoms) + " atoms; the material has those of " +
                std::to_string(material.defects.positional.size()));
  }
}

// Balls of VolumeParameters::solid, all of them opaque.
Parameters ball_parameters(const Parameters& parameters) {
  Parameters balls = parameters;
  balls.atoms.regular_opacity = parameters.volume.solid == VolumeSolid::atoms ? 1.0 : 0.0;
  return balls;
}

void add_surface(Scene& scene, const Material& material, const Parameters& parameters, Borrowable<Triangle> surface) {
  scene.surface = std::move(surface);
  if (scene.mode == Mode::xray) return;
  scene.face_normals = face_normals(scene.surface, material.mesh.vertices);
  if (parameters.shading == Shading::smooth) {
    scene.vertex_normals = vertex_normals(scene.surface, material.mesh.vertices);
  }
}

void add_mesh(Scene& scene, const Material& material, const Parameters& parameters, Progress& progress) {
  const TetMesh& mesh = material.mesh;
  scene.delaunay = mesh.delaunay;
  scene.vertices.resize(mesh.vertices.size());
  parallel_for(scene.vertices.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) scene.vertices[v] = Vec3f(mesh.vertices[v] - scene.center);
  });
  progress.update(0.2);

  if (any_cut(parameters)) {
    TetMesh left;
    left.delaunay = mesh.delaunay;
    left.tetrahedra = cut_tetrahedra(mesh, parameters);
    if (uses_surface(scene.mode)) {
      left.vertices = mesh.vertices;
      add_surface(scene, material, parameters, extract_surface(left).triangles);
    }
    if (uses_tetrahedra(scene.mode)) scene.tetrahedra = std::move(left.tetrahedra);
  } else {
    if (uses_surface(scene.mode)) {
      const bool missing = material.surface.triangles.empty() && !mesh.tetrahedra.empty();
      add_surface(scene, material, parameters,
                  missing ? Borrowable(extract_surface(mesh).triangles)
                          : Borrowable<Triangle>::borrow(material.surface.triangles));
    }
    if (uses_tetrahedra(scene.mode)) scene.tetrahedra = Borrowable<Tetrahedron>::borrow(mesh.tetrahedra);
  }
  progress.update(0.6);

  if (scene.mode == Mode::volume_surface) scene.colors = vertex_colors(material, parameters);
  if (scene.mode == Mode::volume) scene.scalars = vertex_scalars(material, parameters.volume);
}

std::shared_ptr<const Scene> make_solids(const Material& material, const Parameters& parameters, const Scene& whole,
                                         Progress& progress) {
  if (whole.mode != Mode::volume || parameters.volume.solid == VolumeSolid::none) return nullptr;
  auto solids = std::make_shared<Scene>();
  solids->bounds = whole.bounds;
  solids->center = whole.center;
  if (parameters.volume.solid == VolumeSolid::walls) {
    solids->mode = Mode::surface;
    solids->far_walls = true;
    add_mesh(*solids, material, parameters, progress);
  } else {
    solids->mode = Mode::atoms;
    solids->balls = make_balls(material, ball_parameters(parameters), whole.center);
  }
  return solids;
}

}  // namespace

MaterialParts parts_needed(const Parameters& parameters) {
  const bool cut = any_cut(parameters);
  const Mode mode = parameters.mode;
  MaterialParts parts;
  parts.atoms = true;  // the vertices of the mesh are atoms
  parts.tetrahedra = uses_tetrahedra(mode) || (uses_surface(mode) && cut);
  const bool walls = mode == Mode::volume && parameters.volume.solid == VolumeSolid::walls;
  parts.surface = (uses_surface(mode) || walls) && !cut;
  parts.fields = uses_tetrahedra(mode);
  parts.defects = uses_tetrahedra(mode) || (mode == Mode::atoms && parameters.atoms.regular_opacity < 1.0);
  return parts;
}

Bounds sample_bounds(const Material& material, const Parameters& parameters) {
  if (material.atoms.size() == 0) return bounds_of(material.mesh.vertices);
  Bounds bounds = bounds_of(material.atoms.positions);
  const Vec3 margin(largest_radius(material.atoms, parameters.atoms));
  bounds.min -= margin;
  bounds.max += margin;
  return bounds;
}

Scene make_scene(const Material& material, const Parameters& parameters, Progress& progress) {
  progress.stage("scene");
  check_parts(material, parameters.mode, any_cut(parameters));
  Scene scene;
  scene.mode = parameters.mode;
  scene.bounds = sample_bounds(material, parameters);
  scene.center = scene.bounds.center();
  if (scene.mode == Mode::atoms) {
    scene.balls = make_balls(material, parameters, scene.center);
  } else {
    add_mesh(scene, material, parameters, progress);
    scene.solids = make_solids(material, parameters, scene, progress);
  }
  progress.update(1.0);
  return scene;
}

Scene make_scene(Material&& material, const Parameters& parameters, Progress& progress) {
  const Material& given = material;
  Scene scene = make_scene(given, parameters, progress);
  if (scene.tetrahedra.borrows()) scene.tetrahedra = std::move(material.mesh.tetrahedra);
  if (scene.surface.borrows()) scene.surface = std::move(material.surface.triangles);
  if (scene.solids != nullptr && scene.solids->surface.borrows()) {
    auto solids = std::make_shared<Scene>(*scene.solids);
    solids->surface = std::move(material.surface.triangles);
    scene.solids = std::move(solids);
  }
  return scene;
}

}  // namespace atomesh
