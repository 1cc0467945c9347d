#include "core/progress.h"

#include "core/error.h"

namespace atomesh {

void Progress::stage(std::string_view name) {
  check();
  stage_ = name;
  reported_ = 0.0;
  if (listener_) listener_(stage_, 0.0);
}

void Progress::update(double fraction) {
  check();
  // A listener may draw: call it only when there is something new to draw.
  if (!listener_ || (fraction < reported_ + 0.005 && fraction < 1.0)) return;
  reported_ = fraction;
  listener_(stage_, fraction);
}

void Progress::check() const {
  if (cancelled()) throw CancelledError();
}

Progress& no_progress() {
  // Per thread, so that two tasks that nobody follows never share state.
  thread_local Progress progress;
  return progress;
}

}  // namespace atomesh
