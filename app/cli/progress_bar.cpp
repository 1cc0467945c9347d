#include "app/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace atomesh::cli {

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) == 1), next_(std::chrono::steady_clock::now()) {}

void ProgressBar::show(std::string_view stage, double fraction) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(50);
  constexpr int cells = 40;
  const int full = static_cast<int>(cells * std::clamp(fraction, 0.0, 1.0));
  char bar[cells + 1] = {};
  std::fill_n(bar, cells, ' ');
  std::fill_n(bar, full, '=');
  std::fprintf(stderr, "\r%-18.*s [%s] %3d %%\x1b[K", static_cast<int>(stage.size()), stage.data(), bar,
               static_cast<int>(100.0 * fraction));
  std::fflush(stderr);
  shown_ = true;
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace atomesh::cli
