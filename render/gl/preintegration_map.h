// What a pre-integration table holds and how large it has to be; without OpenGL.
//
// A segment of length L along which the scalar goes linearly from s to t looks as if it had one colour and one
// extinction throughout. With κ = ∫ σ du its mean extinction, y = κ L its optical depth, T(u) = exp(-L ∫₀ᵘ σ), u from 0
// to 1, and
//   E = ∫ c σ T du · y / (1 - e^-y)
// it is  opacity = 1 - e^-y,  light = E / κ · opacity.  κ does not depend on L, and E only where the segment is not
// thin: a table of (E, κ) over (s, t, L) needs few layers of L and is right to a share of the light, however short a
// segment is. (A table of the light itself, as in Röttger, Kraus and Ertl 2000, "Hardware-accelerated volume and
// isosurface rendering based on cell-projection", is off by the same amount for every segment, and a ray meets
// hundreds.)
//
// Scalars' axes are uniform from 0 to 1. Layers of L lie where γ(L) = i / (layers - 1),
//   γ(L) = L (longest + bend) / (longest (L + bend)),
// 0 at L = 0 and 1 at the longest segment; bend is 12 mean free paths where the map is densest, by which the colour
// maps that there are need fewest layers.
#pragma once

#include <vector>

#include "core/color_map.h"
#include "core/geometry.h"

namespace atomesh::gl {

// A part of the map where it is linear.
struct MapPiece {
  glm::dvec4 first{0.0};  // RGB and extinction (1/Å) where it begins
  glm::dvec4 slope{0.0};  // for each unit of the scalar
  double begin = 0.0;     // as a float has it
  double end = 0.0;
};

// Ascending, side by side, from -1e30 to 1e30; a jump is where one ends at another colour than the next begins with.
// Extinction is alpha_length (1/Å) · opacity. At most 33.
std::vector<MapPiece> map_pieces(const ColorMap& map, double alpha_length);

struct TableEntry {
  Vec3 emission{0.0};       // E, 1/Å
  double extinction = 0.0;  // κ, 1/Å
};

// Of the segment from the scalar `near` to `far` (each from 0 to 1), `length` >= 0 in Å: κ exactly, E by quadrature
// (four Gauss–Legendre points on pieces of optical depth at most 1/4), to 1e-7 of the largest extinction.
TableEntry table_entry(const std::vector<MapPiece>& pieces, double near, double far, double length);

// What is seen of it: premultiplied RGB and opacity.
glm::dvec4 light_of(const TableEntry& entry, double length);

struct TableSize {
  int scalars = 0;         // entries along each scalar's axis; 0: no table is accurate enough
  int layers = 0;          // of lengths
  double longest = 1.0;    // Å
  double bend = 1.0;       // Å
  double estimated = 0.0;  // the largest error of a sample; where no table is accurate enough, the largest table's

  double length_of(double layer) const;  // Å; layer from 0 to layers - 1
  double layer_of(double length) const;
  bool operator==(const TableSize&) const = default;
};

inline constexpr int most_scalars = 1024;
inline constexpr int most_layers = 33;
inline constexpr int most_entries = 1 << 22;  // 64 MiB

// How wrong `light` (premultiplied RGB and opacity) is for a segment: the largest, over its four numbers, of
//   |difference| / (opacity + 1/256),  where a knot lies between the two scalars  |difference| / (opacity + 1/4).
// Along a ray through n segments of which m are met by a knot the picture is then off by no more than about
// error · (1 + n/256 + m/4), and mostly by far less; where the scalar hardly changes, n counts, and m does not.
double error_of_segment(const std::vector<MapPiece>& pieces, double near, double far, double length,
                        const glm::dvec4& light);

// The smallest table by which no sample is more than nearly `error` wrong; samples are several hundred segments at,
// about and between the knots, within the table's cells and layers. 1e-6 <= error.
TableSize choose_size(const std::vector<MapPiece>& pieces, double longest, double error);

}  // namespace atomesh::gl
