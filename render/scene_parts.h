// The parts make_scene() puts together, each a function from the material to one array of the Scene.
#pragma once

#include <vector>

#include "core/material.h"
#include "core/parameters.h"
#include "core/vertex_defects.h"
#include "render/scene.h"

namespace atomesh {

// scene_cuts.cpp
bool any_cut(const Parameters& parameters);
// True where every enabled cut plane keeps the point (Å, coordinates of the file).
bool survives_cuts(const Parameters& parameters, const Vec3& point);
// The tetrahedra all of whose vertices survive, in the mesh's order.
std::vector<Tetrahedron> cut_tetrahedra(const TetMesh& mesh, const Parameters& parameters);

// scene_fields.cpp
// The field that is shown; nullptr for the defects. Throws UsageError naming the nearest for a name that is none.
const VertexField* shown_field(const Material& material, const VolumeParameters& parameters);
// What the colour map's 0 and 1 stand for: the field's range, or the one that is set, and whether the field has values
// below and above it. Throws UsageError for a range that is set and empty.
struct FieldRange {
  double low = 0.0;
  double high = 0.0;
  bool below = false;
  bool above = false;
};
FieldRange field_range(const VertexField& field, const VolumeParameters& parameters);
// From that range to [0,1]; what lies outside takes the nearer end, and a field of one value the middle.
std::vector<float> field_scalars(const VertexField& field, const VolumeParameters& parameters);
std::vector<Vec4f> field_colors(const VertexField& field, const VolumeParameters& parameters);

// scene_colors.cpp: one value per mesh vertex.
std::vector<Vec4f> vertex_colors(const Material& material, const Parameters& parameters);
std::vector<float> vertex_scalars(const Material& material, const VolumeParameters& parameters);
// The scalar of an atom before it is normalised: the weighted sum of its defect values (the seed's B.6.3.3).
double weighted_defects(const DefectValues& values, const VolumeParameters& parameters);
// The largest among the mesh's vertices, which is what vertex_scalars() divides by; 0 without defects.
double largest_weighted_defects(const Material& material, const VolumeParameters& parameters);

// scene_balls.cpp
std::vector<Ball> make_balls(const Material& material, const Parameters& parameters, const Vec3& center);
// Å, over the species of the table that are used, whether shown or not; 0 without atoms.
double largest_radius(const Atoms& atoms, const AtomsParameters& parameters);

}  // namespace atomesh
