// Material + Parameters → exactly what one mode needs to be drawn, in float about the scene's centre.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/material.h"
#include "core/material_file.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/borrowable.h"

namespace atomesh {

// A sphere to draw. Opacity 1 for atoms with a defect, AtomsParameters::regular_opacity for the others (for all of them
// where the material has no defect values). Hidden species, radius zero and opacity zero make no ball.
struct Ball {
  Vec3f center;  // about Scene::center
  float radius;  // Å
  Vec4f color;   // RGB and opacity
  Index atom;    // index into Material::atoms
};

// What is empty is not needed by the mode. Bytes beyond the material's; where nothing is cut, the tetrahedra and the
// surface are the material's own. (A Delaunay mesh has some 6 tetrahedra a vertex: at most 7 bytes a tetrahedron.)
//   volume_surface: vertices, colors, vertex_normals 12 + 16 + 12 a vertex, face_normals 12 a triangle; tetrahedra,
//                   surface
//   volume:         vertices, scalars 12 + 4 a vertex; tetrahedra
//   surface:        vertices, vertex_normals 12 + 12 a vertex, face_normals 12 a triangle; surface
//   xray:           vertices 12 a vertex; surface
//   atoms:          balls 36 each
// Solids in the volume are those of modes atoms or surface.
// Cut planes add 16 a tetrahedron that is left (volume modes) and 12 a triangle. Atoms that fail a cut plane are gone,
// with every tetrahedron that has one as a vertex; the surface is that of what is left.
struct Scene {
  Mode mode = Mode::volume_surface;
  Vec3 center{0.0};  // Å, in the file's coordinates; subtract before converting to float
  // sample_bounds(): of the whole uncut sample, so that cutting does not move the camera.
  Bounds bounds;
  std::vector<Vec3f> vertices;         // about center
  Borrowable<Tetrahedron> tetrahedra;  // positively oriented
  // RGBA of each vertex (VolumeSurfaceParameters), in [0,1]. Atoms that share one vertex colour it with the largest of
  // each of their defect values. A vertex that is no atom, and every vertex of a material without defects, has the base
  // colour. Where a field is shown (VolumeParameters::field), the colour map's colour of its scalar.
  std::vector<Vec4f> colors;
  // Of each vertex: the weighted sum of its defect values divided by the largest in the uncut sample; 0 without
  // defects. Or the field's value, from its range to [0,1].
  std::vector<float> scalars;
  Borrowable<Triangle> surface;       // outward
  std::vector<Vec3f> face_normals;    // of each triangle
  std::vector<Vec3f> vertex_normals;  // of each vertex, zero inside; empty with flat shading
  bool delaunay = false;              // see TetMesh::delaunay
  std::vector<Ball> balls;
  // Mode surface: what is seen is not the nearest triangle but the farthest of those that are seen from inside.
  bool far_walls = false;
  // What stands in the volume of mode volume (VolumeParameters::solid): a scene of mode atoms or surface about the same
  // center, all of it opaque; null where nothing does.
  std::shared_ptr<const Scene> solids;
};

// What the camera goes by, in the file's coordinates and the same in every mode, so that changing the mode does not
// move it: the atoms' bounds, grown by the largest radius of a ball (hidden or not) so that none sticks out of the
// picture; of a mesh without atoms, its vertices'.
Bounds sample_bounds(const Material& material, const Parameters& parameters);

// Which parts of a .crb the mode (with these cut planes) needs, for read_material().
MaterialParts parts_needed(const Parameters& parameters);

// The scene may borrow the material's tetrahedra and surface: they must outlive it and stay as they are. Throws Error
// when the mode needs something the material does not have (naming it). A mesh without tetrahedra (fewer than four
// atoms, all in a plane) is fine and gives an empty picture.
Scene make_scene(const Material& material, const Parameters& parameters, Progress& progress = no_progress());
// The same for a material that is given away: the scene keeps what it would borrow.
Scene make_scene(Material&& material, const Parameters& parameters, Progress& progress = no_progress());

}  // namespace atomesh
