// How soon the window's thread answers: another thread posts an event every few milliseconds.
#pragma once

#include <QMetaObject>
#include <QObject>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace atomesh::test {

class Heartbeat {
 public:
  Heartbeat() : thread_([this] { run(); }) {}
  ~Heartbeat() { stop(); }

  void stop() {
    quit_ = true;
    if (thread_.joinable()) thread_.join();
  }
  // Of every event answered so far, ms from when it was posted.
  const std::vector<double>& answers() const { return answers_; }
  double slowest() const { return answers_.empty() ? 0.0 : *std::max_element(answers_.begin(), answers_.end()); }
  // That so large a part of them was at most.
  double quantile(double part) const {
    if (answers_.empty()) return 0.0;
    std::vector<double> sorted = answers_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }

 private:
  using Clock = std::chrono::steady_clock;

  void run() {
    auto next = Clock::now();
    while (!quit_) {
      const auto posted = Clock::now();
      QMetaObject::invokeMethod(
          &target_,
          [this, posted] {
            answers_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - posted).count());
          },
          Qt::QueuedConnection);
      next += std::chrono::milliseconds(4);
      std::this_thread::sleep_until(next);
    }
  }

  QObject target_;
  std::vector<double> answers_;  // of the window's thread alone
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace atomesh::test
