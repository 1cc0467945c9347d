// How far a program runs ahead of software that draws on threads of its own.
//
// llvmpipe sorts triangles into tiles on the thread that asks for them, and fills the tiles on others, a scene at a
// time. Both at once keep all cores busy; but what waits to be filled is to be still in the caches, and once 64 scenes
// have waited at the same time llvmpipe never again takes one before the last is filled.
#pragma once

#include <epoxy/gl.h>

#include <deque>

namespace atomesh::gl {

// Of one context, which is current whenever anything of it is called, the destructor included.
class DrawAhead {
 public:
  DrawAhead() = default;
  ~DrawAhead() { leave(0); }
  DrawAhead(const DrawAhead&) = delete;
  DrawAhead& operator=(const DrawAhead&) = delete;

  // So many cells have been asked for. Every now and then they are drawn from now on; where much of what was so before
  // is not finished, waits until little of it is: then several follow one another, for whoever asks keeps a core from
  // drawing.
  void go_on(std::size_t cells);

 private:
  static constexpr std::size_t cells_at_once = 1024;  // still in the caches when they are filled
  static constexpr std::size_t most = 6;              // times so many
  static constexpr std::size_t least = 2;

  // To a thread that draws, unless they might run out of what to draw: the others wait at each scene's ends for one
  // that waits for this one's core, and systems leave it there even while another core idles.
  void give_way();
  void leave(std::size_t count);

  std::size_t cells_ = 0;         // not begun
  std::deque<GLsync> under_way_;  // of each so many cells
};

}  // namespace atomesh::gl
