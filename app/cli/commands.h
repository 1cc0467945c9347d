// The subcommands. Each adds its options to its CLI::App and returns what does the work once they are read.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace atomesh::cli {

class Session;

// Returns the program's exit code; errors are thrown.
using Command = std::function<int(Session&)>;

inline constexpr int exit_done = 0;
inline constexpr int exit_comparison_failed = 4;

Command add_sample(CLI::App& app);
Command add_preprocess(CLI::App& app);
Command add_render(CLI::App& app);
Command add_defects(CLI::App& app);
Command add_info(CLI::App& app);
Command add_convert(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_bench(CLI::App& app);

}  // namespace atomesh::cli
