// Progress and cancellation of long work. One Progress object follows one task; the task calls stage() and
// update(), anybody (another thread, a signal handler) may call request_cancel().
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace atomesh {

class Progress {
 public:
  // Called from the thread that does the work, at most a few hundred times a stage. `fraction` is in [0,1] and
  // belongs to the named stage.
  using Listener = std::function<void(std::string_view stage, double fraction)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(std::move(listener)) {}
  // Follows a part of what `whole` follows: fractions from 0 to 1 become `whole`'s from `begin` to `end`, and stages
  // are not named again. It is cancelled when `whole` is, when asked to itself, and once the clock reaches `deadline`.
  // `whole` must outlive it.
  using Clock = std::chrono::steady_clock;
  Progress(Progress& whole, double begin, double end, Clock::time_point deadline = Clock::time_point::max());

  // Starts a stage; throws CancelledError when a cancel was requested.
  void stage(std::string_view name);
  // Reports how far the stage is; throws CancelledError when a cancel was requested. Call it outside parallel
  // regions, or from inside a parallel_for body, which carries exceptions out.
  void update(double fraction);
  // Throws CancelledError when a cancel was requested. Cheap: may stand in inner loops of a few microseconds.
  void check() const;

  void request_cancel() noexcept { cancel_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept;
  const std::string& stage_name() const { return stage_; }

 private:
  Listener listener_;
  std::string stage_;
  double reported_ = -1.0;
  std::atomic<bool> cancel_{false};
  const Progress* whole_ = nullptr;
  Clock::time_point deadline_ = Clock::time_point::max();
};

// For callers that do not follow the work.
Progress& no_progress();

}  // namespace atomesh
