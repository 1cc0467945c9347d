// OpenGL contexts that are lost, for tests: GLX says so to whoever asks (Qt does whenever it makes one current), or
// does not make them current any more. Contexts of EGL are not.
#pragma once

#include <cstddef>
#include <functional>

namespace atomesh::test {

enum class Loss {
  reset,    // it is made current, and tells that the card was reset
  refused,  // it is not made current
  all       // nor is any that nobody has used before: there is no OpenGL any more
};

// As long as it lives, the context that is current when it begins is lost.
class LostContext {
 public:
  explicit LostContext(Loss loss);
  ~LostContext();
  LostContext(const LostContext&) = delete;
  LostContext& operator=(const LostContext&) = delete;

  // How often somebody was told.
  static std::size_t noticed();
};

// Whether contexts can be lost here.
bool contexts_can_be_lost();

// As long as it lives, it counts the objects that are deleted with no context current, or with one that was there
// before and is not the one that was current when it began.
class StrayDeletions {
 public:
  StrayDeletions();
  ~StrayDeletions();
  StrayDeletions(const StrayDeletions&) = delete;
  StrayDeletions& operator=(const StrayDeletions&) = delete;

  static std::size_t all();  // deletions
  static std::size_t stray();
};

}  // namespace atomesh::test
