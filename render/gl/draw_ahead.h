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

  // What was asked for since the last call is drawn from now on. Where much of what was so before is not finished,
  // waits until little of it is: then several follow one another, for whoever asks keeps a core from drawing.
  void go_on();

 private:
  static constexpr std::size_t most = 6;
  static constexpr std::size_t least = 2;

  void leave(std::size_t count);

  std::deque<GLsync> under_way_;
};

}  // namespace atomesh::gl
