#include "app/cli/session.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>

#include "app/cli/output_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

std::atomic<Progress*> cancelled_by_signal{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free, "the signal handler may only use lock-free atomics");

void request_cancel(int) {
  if (Progress* progress = cancelled_by_signal.load()) progress->request_cancel();
}

// OpenMP ends the program when it cannot start a thread, for whose stack the system may lack the room.
void leave_room_for_threads() {
  constexpr std::uint64_t room_each = 32'000'000;
  const auto room = memory_room();
  if (!room) return;
  const auto most = static_cast<int>(std::min<std::uint64_t>(room->bytes / room_each, 4096));
  if (most < threads()) set_threads(std::max(most, 1));
}

}  // namespace

Session::Session() : progress_([this](std::string_view stage, double fraction) { bar_.show(stage, fraction); }) {
  cancelled_by_signal.store(&progress_);
  // The first signal asks the work to stop and clean up; the second has its usual effect.
  struct sigaction action {};
  action.sa_handler = request_cancel;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Session::~Session() {
  cancelled_by_signal.store(nullptr);
}

void Session::add_options(CLI::App& app) {
  app.add_option("--threads", threads_, "Threads to use; 0: all the machine offers. Never changes the result")
      ->type_name("N")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str()
      ->group("General");
  app.add_option("--memory-limit", memory_limit_mb_,
                 "Take at most this much memory, MB; 0: what the machine has. What would need more is not begun")
      ->type_name("MB")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40U))
      ->group("General");
  app.add_option("--json", json_path_, "Write what happened as JSON to FILE, or to standard output for -")
      ->type_name("FILE|-")
      ->group("General");
}

void Session::begin() {
  if (json_wanted() && !json_on_standard_output()) check_output_folder(json_path_);
  set_threads(threads_);
  if (memory_limit_mb_ > 0) limit_memory(memory_limit_mb_ * 1'000'000);
  leave_room_for_threads();
  progress_.check();
}

void Session::finish() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw Error("standard output: cannot be written: is the disk full?");
  }
}

void Session::print_text(std::string_view text) {
  if (json_on_standard_output()) return;
  bar_.clear();
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (text.empty() || text.back() != '\n') std::fputc('\n', stdout);
}

void Session::note(std::string_view text) {
  bar_.clear();
  std::fprintf(stderr, "note: %.*s\n", static_cast<int>(text.size()), text.data());
}

void Session::write_json(const Json& json) {
  if (json_path_.empty()) return;
  bar_.clear();
  const std::string text = json.text();
  if (json_on_standard_output()) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return;
  }
  AtomicFile file(json_path_);
  file.write(text);
  file.commit();
}

}  // namespace atomesh::cli
