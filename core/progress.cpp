#include "core/progress.h"

#include "core/error.h"

namespace atomesh {

Progress::Progress(Progress& whole, double begin, double end, Clock::time_point deadline)
    : listener_(
          [&whole, begin, end](std::string_view, double fraction) { whole.update(begin + fraction * (end - begin)); }),
      whole_(&whole),
      deadline_(deadline) {}

bool Progress::cancelled() const noexcept {
  if (cancel_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->cancelled())) return true;
  return deadline_ != Clock::time_point::max() && Clock::now() >= deadline_;
}

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
