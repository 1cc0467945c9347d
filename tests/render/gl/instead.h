// Failures of OpenGL for tests: a function that does something else for a while.
#pragma once

namespace atomesh {

// OpenGL's functions are found by libepoxy, which keeps their addresses where they can be changed.
template <class Function>
class Instead {
 public:
  Instead(Function& function, Function other) : function_(function), real_(function) { function = other; }
  ~Instead() { function_ = real_; }
  Instead(const Instead&) = delete;
  Instead& operator=(const Instead&) = delete;

 private:
  Function& function_;
  Function real_;
};

}  // namespace atomesh
