// GLSL 1.50 (OpenGL 3.2, where nothing else is said) of GpuScene. It follows render/shared (optics.h, ball_ray.h,
// materials.h) line by line; a test compares the pictures.
#pragma once

#include <string>

namespace atomesh::gui {

// A triangle that covers the picture, made of no vertices but their numbers.
std::string whole_picture_vertex_shader();

// Atom balls: two triangles, of no vertices but their numbers, around each ball's outline.
std::string ball_vertex_shader();
// Which ball is nearest: its index to a GL_R32UI target, its length along the ray to the depths. With `layer` above 0
// only what lies behind the layer before, in the order of render/cpu/ball_hits.h.
std::string ball_layer_shader();
// The layer's colour, premultiplied, for the balls `first` to `first + count`.
std::string ball_shading_shader();

// The same for balls that are not opaque, by OpenGL 4.5 (GLSL 4.50): all of a pixel's hits in a list, unsorted; and its
// colour, sorted and composed.
std::string list_vertex_shader();
std::string list_shader();
std::string list_picture_vertex_shader();
std::string list_shading_shader();

// Surface. Attributes: position, normal (only with smooth).
std::string surface_vertex_shader();
std::string surface_fragment_shader();

// A texture as it is.
std::string copy_shader();
// The mean of n × n pixels of a texture for each of the target's.
std::string mean_shader();

}  // namespace atomesh::gui
