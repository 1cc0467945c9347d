// What the driver of cell projection and its kernels hand each other: plain structs, no classes. A kernel is one source
// (cell_projection_blocks.inl, _setup.inl, _values.inl, _light.inl, _segment.inl, _table.inl, _colors.inl, _mapped.inl,
// _integrate.inl, _layers.inl, _block.inl) compiled once per instruction set.
//
// Depth along a ray is carried as u, affine in the pixel for every plane and growing with depth z:
//   perspective u = 1 - z_ref / z  (planes project so that 1/z is affine),   parallel u = z - z_ref,
// z_ref the depth of the sample's centre, so that floats resolve what matters. A face's three coefficients come from
// its corners in ascending order of vertex index, so both cells at a face compute bit-identical depths of it: where one
// cell ends the next begins, no ray misses or doubles a cell, and lengths along a ray telescope.
//
// The coefficients are floats about the tile's middle. Of a face seen so nearly edge-on that their rounding would
// move it noticeably, they are split in two floats, the first parts so short that they add up without rounding: such a
// face's place in the picture is right to 2^-36 of a pixel or so.
//
// What a pixel gets depends on the pixel alone, not on the others of its block: a cell meets the rays within its box
// where its faces say so, a ray's cells are ordered by where they begin and, of those that begin at the same depth, by
// their number, and every lane computes what it would compute alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/geometry.h"
#include "core/parameters.h"
#include "render/cpu/projected_vertex.h"
#include "render/pixel_lattice.h"

namespace atomesh::cell_projection {

inline constexpr int tile_side = 32;  // pixels
inline constexpr int tile_middle = tile_side / 2;
inline constexpr int block_side = 4;  // pixels; a block's 16 pixels are the lanes of a register
inline constexpr int blocks_per_side = tile_side / block_side;
inline constexpr int blocks_per_tile = blocks_per_side * blocks_per_side;  // bits of a BlockSet
inline constexpr int block_pixels = block_side * block_side;

// Rays pass this much of a pixel right of the pixel's centre, and ray_lift of that above it: then no ray of a picture
// aligned with a crystal runs in a lattice plane or along a row of edges, where rounding would decide cell by cell.
inline constexpr double ray_shift = 0x1p-22;
inline constexpr double ray_lift = 0x1p-5;

// A ray that lets no more light through than this is finished.
inline constexpr float opaque_enough = 0x1p-20F;

// MapIntervals::grid() has so many places for the scalars from 0 to 1.
inline constexpr int map_grid_size = 256;

// Constants of one picture.
struct View {
  bool perspective;
  double reference;    // z_ref, Å
  double pixel;        // Camera::pixel
  double left, top;    // image-plane coordinates of the (shifted) centre of pixel (0, 0)
  float nearest;       // u of the eye's plane, where a ray that starts inside begins
  float farthest;      // u no plane lies behind
  double order_blend;  // 0: cells in order of their circumsphere's power (Delaunay); 1: of their centroid
  double order_doubt;  // how little is made of where the circumspheres of flat cells have their centres
  float plain_reach;   // faces whose u(i, j) in a tile reach beyond this have their coefficients split
};

// The lattice's pixels of a tile are a grid of their own: its pixel (i, j) is the tile's (column_phase + i ·
// column_stride, row_phase + j · row_stride). Blocks are 4×4 of the grid's pixels; block b is in column b % 8, row b
// / 8.

// A cell's four faces as affine functions u(i, j) = a i + b j + c of the pixel, counted from the tile's pixel
// (tile_middle, tile_middle): first those the ray enters by, then those it leaves by. One cache line.
struct alignas(64) CellPlanes {
  float a[4], b[4], c[4];
  std::uint32_t columns;  // of the lattice's grid, that the cell's corners lie between; bit i is column i
  std::uint32_t rows;
  float depth;           // where CellColors are counted from: z - z_ref
  std::uint8_t entries;  // faces that the ray enters by, 1 to 3; 0 where the eye is inside
  bool refined;          // whether there is a CellRefinement; there is where `entries` is 0
  bool wild;             // whether there is a ColorRange
};

// What is seldom needed: second parts of the planes' coefficients.
struct alignas(64) CellRefinement {
  float a[4], b[4], c[4];
};

// Blocks of a tile: bit b is block b, rows first.
using BlockSet = std::uint64_t;

// RGBA of a cell at pixel (i, j), counted from the same, and depth z:
//   base + h (slope_a i + slope_b j) + (z - z_cell) slope_c,  h = z in perspective, 1 in parallel projection,
// clamped to the range of the cell's vertices where rounding may leave it by more than 2e-6. One cache line.
struct alignas(64) CellColors {
  float base[4], slope_a[4], slope_b[4], slope_c[4];
};
struct ColorRange {
  float low[4], high[4];
};

// One scalar: base(i, j) + (z - z_cell) · slope(i, j), both affine in the pixel, clamped to the range of the cell's
// vertices only where rounding may leave it by more than a few millionths of it (`wild`). `base` is counted from
// `reference`, and (i, j) from the pixel at `column` and `row`, where the centroid is seen.
struct alignas(64) CellScalar {
  float base_a, base_b, base_c;
  float slope_a, slope_b, slope_c;  // half the slope
  float column, row;
  float twice_depth;  // 2 (z_cell - z_ref)
  float low, high;
  float reference;  // the mean of the vertices'
  // Of the colour map: the intervals that the cell's scalars touch, where the second of them begins (or the one behind
  // them), counted from `reference`, and the least of their MapInterval::thin_length.
  std::uint16_t first_interval;
  std::uint16_t last_interval;
  float knot;
  float thin_length;
  std::uint32_t wild;
};

// A linear piece of the colour map: colour = first + (s - begin) · slope from begin up to the next one's. RGB, then
// opacity.
struct MapInterval {
  float begin;
  float begin_rest;  // what a float leaves of it
  float first[4];
  float slope[4];
  float thin_length;  // alpha_length times the way, of which no more than optics::thin_limit is absorbed at any scalar
};

// Where a ray enters the surface, or leaves it.
struct LayerHit {
  double depth;    // Å
  float u;         // its place among the cells: where the ray enters, never behind the cell it is the front of
  Index triangle;  // no_index where it leaves
};

// Colour of the layer that the ray of a pixel (of the picture) hits.
struct Shader {
  void (*shade)(const void* context, const LayerHit& hit, int column, int row, float* rgb);
  const void* context;
};

struct CellOptics {
  float alpha_length;  // 1/Å
  Integrator integrator;
  int samples;                    // per cell, of Integrator::sampled
  const float* psi;               // optics::psi_table(), of Integrator::preintegrated
  const MapInterval* map;         // MapIntervals::data() in mode volume; nullptr where vertices carry RGBA
  const std::uint16_t* map_grid;  // MapIntervals::grid()
  Shader layer;                   // mode volume_surface; shade is nullptr elsewhere
  float layer_alpha;
  // What the sample is filled with between the cells, wherever the surface says that a ray is inside. Then the layers'
  // hits are those where rays leave, too.
  bool has_medium;
  float medium[4];  // RGBA
};

struct SetupInput {
  const ProjectedVertex* vertices;
  const Index* corners;  // four per tetrahedron
  const float* values;   // per vertex, `value_count` of them
  int value_count;       // 4 or 1
  const Index* cells;    // of the tile
  std::size_t count;
  int column, row;  // the tile's first pixel
  PixelLattice lattice;
  BlockSet wanted;  // the blocks that cells are wanted for
};

struct SetupOutput {
  CellPlanes* planes;
  CellRefinement* refinements;  // where the planes say that there is one
  CellColors* colors;           // where values are RGBA
  ColorRange* ranges;           // of those that are wild
  CellScalar* scalars;          // this where they are scalars, all but what it has of the colour map
  double* keys;                 // ascending: front to back
  BlockSet* blocks;  // wanted ones that the cell may cover a pixel of; where there are none the others are not filled
  std::uint32_t* per_block;  // how many cells each of the tile's blocks has
};

// Lines of the lists that a block's cells pass through; sized by the driver for the longest list.
struct BlockScratch {
  float* u_in;           // 16 per cell, 0 on rays that do not meet it
  float* u_out;          // the same
  std::uint32_t* lanes;  // per cell: pixels that meet it; 16 bits higher those that it shares with no cell laid with it
  std::uint32_t* record;  // per cell: which of the block's cells it is
  std::uint32_t* order;   // per cell
  std::uint32_t* moved;   // per cell
  std::uint32_t* by_ray;  // 16 per cell, used where cells overlap in a cycle
};

struct BlockInput {
  const CellPlanes* planes;  // of the tile
  const CellRefinement* refinements;
  const CellColors* colors;
  const ColorRange* ranges;
  const CellScalar* scalars;
  const std::uint32_t* cells;  // of the block: indices into the tile's, roughly front to back
  std::size_t count;
  const LayerHit* layers;  // of the tile; those of the block's ray i: layer_begin[i] … layer_begin[i + 1] - 1,
  const std::uint32_t* layer_begin;  // nearest first. nullptr where no ray of the block has one
  const float* farthest;             // u where each of the 16 rays ends; nullptr: View::farthest
  int column, row;                   // the block's first pixel, within the lattice's grid
  int tile_column, tile_row;         // the tile's first pixel
  PixelLattice lattice;
};

struct Kernel {
  std::string_view name;
  // Fills the records of each of the tile's cells.
  void (*setup)(const View&, const SetupInput&, const SetupOutput&);
  // Premultiplied RGB and coverage of the block's 16 pixels, rows first. Returns the ray–cell steps composed.
  std::uint64_t (*draw_block)(const View&, const CellOptics&, const BlockInput&, const BlockScratch&, float* rgba);
};

// nullptr where this build or this processor lacks the instruction set.
const Kernel* avx512_kernel();
const Kernel* avx2_kernel();
const Kernel* baseline_kernel();

// The fastest this processor runs, or the one set_kernel() chose.
const Kernel& kernel();
// For tests and benches: draw with the named kernel ("avx512", "avx2", "baseline"; "" for the fastest) from now on.
// Throws UnavailableError when this processor cannot.
void set_kernel(std::string_view name);

}  // namespace atomesh::cell_projection
