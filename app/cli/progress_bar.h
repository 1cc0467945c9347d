// One line on the terminal that says which stage runs and how far it is.
#pragma once

#include <chrono>
#include <string_view>

namespace atomesh::cli {

// Draws on standard error, and only when that is a terminal: pipes and logs stay quiet.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // At most twenty times a second; calls in between are dropped.
  void show(std::string_view stage, double fraction);
  void clear();

 private:
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace atomesh::cli
