#include "render/gl/draw_ahead.h"

namespace atomesh::gl {

void DrawAhead::go_on() {
  under_way_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  glFlush();
  if (under_way_.size() < most) return;
  constexpr GLuint64 a_second = 1'000'000'000;
  // However it ends: nothing but speed depends on it.
  glClientWaitSync(under_way_[under_way_.size() - least - 1], 0, a_second);
  leave(least);
}

void DrawAhead::leave(std::size_t count) {
  while (under_way_.size() > count) {
    glDeleteSync(under_way_.front());
    under_way_.pop_front();
  }
}

}  // namespace atomesh::gl
