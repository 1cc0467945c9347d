#include "render/scene.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

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

void add_surface(Scene& scene, const Material& material, const Parameters& parameters, const Surface& surface) {
  scene.surface = surface.triangles;
  if (scene.mode == Mode::volume_surface) {
    scene.surface_tetrahedron = surface.tetrahedron;
    scene.surface_face = surface.face;
  }
  if (scene.mode == Mode::xray) return;
  scene.face_normals = face_normals(surface, material.mesh.vertices);
  if (parameters.shading == Shading::smooth) {
    scene.vertex_normals = vertex_normals(surface, material.mesh.vertices);
  }
}

void add_mesh(Scene& scene, const Material& material, const Parameters& parameters, Progress& progress) {
  const TetMesh& mesh = material.mesh;
  scene.delaunay = mesh.delaunay;
  scene.vertices.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) scene.vertices.emplace_back(p - scene.center);
  progress.update(0.2);

  const bool cut = any_cut(parameters);
  if (cut) {
    TetMesh left;
    left.delaunay = mesh.delaunay;
    left.tetrahedra = cut_tetrahedra(mesh, parameters);
    if (uses_surface(scene.mode)) {
      left.vertices = mesh.vertices;
      add_surface(scene, material, parameters, extract_surface(left));
    }
    if (uses_tetrahedra(scene.mode)) scene.tetrahedra = std::move(left.tetrahedra);
  } else {
    if (uses_surface(scene.mode)) {
      const bool missing = material.surface.triangles.empty() && !mesh.tetrahedra.empty();
      add_surface(scene, material, parameters, missing ? extract_surface(mesh) : material.surface);
    }
    if (uses_tetrahedra(scene.mode)) scene.tetrahedra = mesh.tetrahedra;
  }
  progress.update(0.6);

  if (scene.mode == Mode::volume_surface) scene.colors = vertex_colors(material, parameters.volume_surface);
  if (scene.mode == Mode::volume) scene.scalars = vertex_scalars(material, parameters.volume);
}

}  // namespace

MaterialParts parts_needed(const Parameters& parameters) {
  const bool cut = any_cut(parameters);
  const Mode mode = parameters.mode;
  MaterialParts parts;
  parts.atoms = true;  // the vertices of the mesh are atoms
  parts.tetrahedra = uses_tetrahedra(mode) || (uses_surface(mode) && cut);
  parts.surface = uses_surface(mode) && !cut;
  parts.defects = uses_tetrahedra(mode) || (mode == Mode::atoms && parameters.atoms.regular_opacity < 1.0);
  return parts;
}

Scene make_scene(const Material& material, const Parameters& parameters, Progress& progress) {
  progress.stage("scene");
  check_parts(material, parameters.mode, any_cut(parameters));
  Scene scene;
  scene.mode = parameters.mode;
  scene.bounds = bounds_of(material.atoms.size() != 0 ? material.atoms.positions : material.mesh.vertices);
  scene.center = scene.bounds.center();
  if (scene.mode == Mode::atoms) {
    const Vec3 margin(largest_radius(material.atoms, parameters.atoms));
    scene.bounds.min -= margin;
    scene.bounds.max += margin;
    scene.balls = make_balls(material, parameters, scene.center);
  } else {
    add_mesh(scene, material, parameters, progress);
  }
  progress.update(1.0);
  return scene;
}

}  // namespace atomesh
