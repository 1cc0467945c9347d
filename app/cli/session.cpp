#include "app/cli/session.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>

#include "app/cli/output_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

std::atomic<Progress*> cancelled_by_signal{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free, "the signal handler may only use lock-free atomics");

void request_cancel(int) {
  if (Progress* progress = cancelled_by_signal.load()) progress->request_cancel();
}

}  // namespace

Session::Session() : progress_([this](std::string_view stage, double fraction) { bar_.show(stage, fraction); }) {}

void Session::add_options(CLI::App& app) {
  app.add_option("--threads", threads_, "Threads to use; 0: all the machine offers. Never changes the result")
      ->type_name("N")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str()
      ->group("General");
  app.add_option("--json", json_path_, "Write what happened as JSON to FILE, or to standard output for -")
      ->type_name("FILE|-")
      ->group("General");
}

void Session::begin() {
  if (json_wanted() && !json_on_standard_output()) check_output_folder(json_path_);
  set_threads(threads_);
  cancelled_by_signal.store(&progress_);
  // The first signal asks the work to stop and clean up; the second has its usual effect.
  struct sigaction action {};
  action.sa_handler = request_cancel;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
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
