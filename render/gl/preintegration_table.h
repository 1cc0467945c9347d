// What segment.glsl (render/gl/shaders) reads to integrate a ray's segment: the colour map in linear pieces, and the
// pre-integration table made of them on the card.
#pragma once

#include <epoxy/gl.h>

#include "core/color_map.h"
#include "render/gl/objects.h"
#include "render/gl/preintegration_map.h"

namespace atomesh::gl {

class PreintegrationTable {
 public:
  // The map with extinction alpha_length (1/Å) · opacity: all that shaders without TABLE read. Does nothing where
  // neither has changed. UsageError for what check_color_map() does not take.
  void update(const ColorMap& color_map, double alpha_length);

  // Made anew by a compute shader where the map or what is asked for has changed; after update(). `longest` segment in
  // Å (longer ones are taken for that long as far as their colour goes), `error` of a segment as choose_size() has it.
  // False where no table is so accurate (a map with jumps, or with knots close together): then there is none, and
  // shaders without TABLE are to be used.
  bool make_table(double longest, double error);

  struct Stats {
    TableSize size;          // the last that make_table() chose
    double choose_ms = 0.0;  // finding the size
    double build_ms = 0.0;   // filling the table, until the card has done; 0 where there is none
    std::size_t bytes = 0;   // of the table
  };
  const Stats& stats() const { return stats_; }

  // For the draws that follow: texture unit 8 (as a buffer and as a 3D texture) and uniform block 8.
  void bind() const;

  // The table's entries (E, κ), the near scalar's place varying fastest, then the far one's, then the layer; waits for
  // the card. Empty where there is none.
  std::vector<Vec4f> read() const;

 private:
  void fill(const TableSize& size);

  ColorMap color_map_;
  double alpha_length_ = 0.0;
  std::vector<MapPiece> pieces_;
  BufferTexture pieces_texture_;

  double longest_ = -1.0;  // what the table was made for; negative: for nothing
  double error_ = 0.0;
  Program program_;
  Texture table_;
  Buffer scales_;
  Stats stats_;
};

}  // namespace atomesh::gl
