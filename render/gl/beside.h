// Work that a thread of its own does, while its owner waits for the end a little at a time.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "core/progress.h"

namespace atomesh::gl {

// One piece of work at a time; used by one thread. What the work touches nobody else may until it is over.
class Beside {
 public:
  Beside() = default;
  ~Beside() { give_up(); }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  // Gives up what goes on before.
  void start(std::function<void(Progress&)> work) {
    give_up();
    progress_ = std::make_unique<Progress>();
    over_ = std::async(std::launch::async, [work = std::move(work), progress = progress_.get()] { work(*progress); });
  }
  // Something was started that was neither taken nor given up.
  bool started() const { return over_.valid(); }
  // Whether nothing goes on any more, within so many milliseconds.
  bool over(double milliseconds) const {
    const std::chrono::duration<double, std::milli> patience(std::clamp(milliseconds, 0.0, 1e6));
    return !started() || over_.wait_for(patience) == std::future_status::ready;
  }
  // Waits for the end; throws what the work threw.
  void take() {
    if (started()) std::exchange(over_, {}).get();
  }
  // Asks it to end, without waiting; it is still to be taken or given up.
  void cancel() {
    if (started()) progress_->request_cancel();
  }
  bool cancelled() const { return started() && progress_->cancelled(); }
  // Cancels it and waits for the end.
  void give_up() {
    cancel();
    if (started()) std::exchange(over_, {}).wait();
  }

 private:
  std::unique_ptr<Progress> progress_;
  std::future<void> over_;
};

}  // namespace atomesh::gl
