#include "render/gl/draw_ahead.h"

#include <chrono>
#include <thread>

namespace atomesh::gl {

namespace {

// Who only yields comes back no sooner than those that draw have to wait for one another, which may be too late.
constexpr std::chrono::microseconds moment{20};

}  // namespace

void DrawAhead::go_on(std::size_t cells) {
  give_way();
  cells_ += cells;
  if (cells_ < cells_at_once) return;
  cells_ = 0;
  under_way_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  glFlush();
  if (under_way_.size() < most) return;
  constexpr GLuint64 a_second = 1'000'000'000;
  // However it ends: nothing but speed depends on it.
  glClientWaitSync(under_way_[under_way_.size() - least - 1], 0, a_second);
  leave(least);
}

void DrawAhead::give_way() {
  while (!under_way_.empty() && glClientWaitSync(under_way_.front(), 0, 0) != GL_TIMEOUT_EXPIRED) {
    leave(under_way_.size() - 1);
  }
  if (under_way_.size() >= least) std::this_thread::sleep_for(moment);
}

void DrawAhead::leave(std::size_t count) {
  while (under_way_.size() > count) {
    glDeleteSync(under_way_.front());
    under_way_.pop_front();
  }
}

}  // namespace atomesh::gl
