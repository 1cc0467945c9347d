// Pixels whose cells were composed in a wrong order are composed once more, in the right one.
//
// The first pass marks them in the stencil buffer (a fragment nearer than the last one of its pixel). Here they alone
// are drawn again, without depth test, into a list a pixel or a k-buffer a pixel, and what comes of it replaces their
// colour. Light is kept in half floats (relative error 2^-12 a fragment), depths as the depth buffer has them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/marked_tiles.h"
#include "render/gl/objects.h"

namespace atomesh::gl {

enum class RepairMethod {
  sort,    // lists, each sorted whole: no pixel stays wrong (but with more than 12,000 fragments)
  replay,  // lists, each sent through a k-buffer in the order in which it came: what `keep` would do
  keep,  // fragments straight into k-buffers; wants drivers with interlock, or that draw each pixel in order (llvmpipe)
};

struct RepairSettings {
  RepairMethod method = RepairMethod::sort;
  int k = 16;                                   // fragments a k-buffer keeps, 1 to 64
  std::size_t memory = std::size_t{256} << 20;  // bytes, for the lists or k-buffers; at least 64 kB
  GLuint stencil_bits = 0xFF;                   // a pixel with any of them set is repaired
  bool operator==(const RepairSettings&) const = default;
};

struct RepairStats {
  std::uint64_t pixels = 0;        // repaired
  std::uint64_t wrong_pixels = 0;  // whose order could not be restored: k too small
  std::uint64_t fragments = 0;     // in lists
  std::uint64_t longest = 0;       // list
  int draws = 0;                   // how often the cells were drawn; more than once where memory is short
  double ms = 0.0;
};

class OrderRepair {
 public:
  // Throws UnavailableError when the driver does not take a shader.
  explicit OrderRepair(const RepairSettings& settings);

  const RepairSettings& settings() const { return settings_; }
  // What the cells have to be drawn with: a fragment shader (list.frag, keep.frag) for the same vertex shader as in the
  // first pass, and defines beside those of that pass. Storage buffers 4 to 7 are taken.
  std::string_view fragment_shader() const;
  std::vector<std::string> defines() const;

  // `framebuffer`: the first pass's, width × height, a float colour buffer first, and stencil; the viewport stays as it
  // is, and covers it. `draw` uses the program and draws the cells in the same order, at least those that meet tiles();
  // it is not called where no pixel is marked, and once for each part of the window where lists need more memory than
  // they may have. A pixel whose list alone needs more stays without its last fragments, and counts as wrong.
  // Afterwards no depth, stencil or scissor test is on, nothing blends, and all is written. Adds to `stats`. Throws
  // UnavailableError when there is not the memory.
  void repair(GLuint framebuffer, int width, int height, const std::function<void()>& draw, RepairStats& stats);
  // While `draw` runs: what it has to draw.
  const MarkedTiles& tiles() const { return *tiles_; }

 private:
  struct Part {
    GLint left, bottom, width, height;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  };
  // struct Repair of repair.glsl
  struct Gathered {
    GLuint fragments = 0;
    GLuint wrong_pixels = 0;
    GLuint longest = 0;
    GLuint capacity = 0;
    GLuint unsorted = 0;
    GLuint reserved[3] = {};
    Part part{};
  };

  std::uint64_t marked_pixels();
  void reserve(std::size_t pixels, std::size_t nodes);
  MarkedTiles marked_tiles(const Part& window) const;
  Gathered gather(const Part& part, const std::function<void()>& draw);
  Gathered resolve();
  // Into that many parts, or as many as it has rows; a single row into parts of it.
  static std::vector<Part> split(const Part& part, std::size_t count);

  RepairSettings settings_;
  std::size_t largest_storage_ = 0;  // bytes that a storage buffer may have
  Program resolve_;
  std::optional<MarkedTiles> tiles_;
  VertexArray whole_window_;  // no attributes
  Program count_;
  Query marked_;
  Buffer repair_;  // struct Repair of repair.glsl
  Buffer pixels_;  // heads of lists, or KeptPixels
  Buffer depths_;  // KeptDepths
  Buffer nodes_;   // Nodes, or KeptLights
};

}  // namespace atomesh::gl
