// What every subcommand shares: --threads, --json, text for a person, progress on a terminal, Ctrl-C.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "app/cli/json.h"
#include "app/cli/progress_bar.h"
#include "core/progress.h"

namespace CLI {
class App;
}

namespace atomesh::cli {

class Session {
 public:
  // From here on SIGINT and SIGTERM cancel progress().
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Adds --threads, --memory-limit and --json to a subcommand.
  void add_options(CLI::App& app);
  // After the command line was read: applies --threads and --memory-limit. Throws UsageError when --json names a folder
  // that does not exist or the limit is below what the program itself takes, CancelledError after a signal.
  void begin();
  // After the work: throws Error when something printed did not arrive (a full disk behind standard output).
  void finish();

  Progress& progress() { return progress_; }

  // A line for a person on standard output; nothing when --json - has taken it.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    print_text(fmt::format(format, std::forward<Args>(args)...));
  }
  void print_text(std::string_view text);
  // "note: …" on standard error: what the user should know although the work goes on.
  void note(std::string_view text);
  // To where --json says; nothing without it. A file appears whole or not at all.
  void write_json(const Json& json);
  bool json_wanted() const { return !json_path_.empty(); }
  bool json_on_standard_output() const { return json_path_ == "-"; }
  // Takes the progress bar off the terminal.
  void clear_progress() { bar_.clear(); }

 private:
  int threads_ = 0;
  std::uint64_t memory_limit_mb_ = 0;
  std::string json_path_;
  ProgressBar bar_;
  Progress progress_;
};

}  // namespace atomesh::cli
