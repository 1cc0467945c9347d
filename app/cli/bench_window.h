// How soon the window shows its first picture, from the start of the program.
#pragma once

#include "app/cli/bench_tools.h"
#include "app/cli/session.h"

namespace atomesh::cli {

struct WindowBenchOptions {
  int repeats = 5;
  bool quick = false;  // tiny samples, to see that it works
};

// Starts this very program with --until-shown, on the user's display or a virtual one: nacl-cracked in its first mode,
// required within 1 s; a million atoms as balls, required within 3 s, of which nothing but atoms is read. Throws
// UnavailableError without a display.
void bench_window(const WindowBenchOptions& options, Session& session, BenchResult& result);

}  // namespace atomesh::cli
