// The seed's table 5.1 measured again: preprocessing and five modes on ten samples.
#pragma once

#include <string>
#include <vector>

#include "app/cli/json.h"
#include "app/cli/session.h"
#include "app/cli/text_table.h"

namespace atomesh::cli {

struct SeedTableOptions {
  std::vector<std::string> samples;  // names; empty: all ten
  std::size_t atoms = 0;             // of each; 0: the seed's count
  int width = 512;                   // pixels
  int height = 512;
  int repeats = 3;  // measured runs, after one warm-up
};

struct BenchResult {
  TextTable table;
  std::string caption;  // machine, commit, repeats, what the figures mean
  Json json;            // {machine, commit, rows}, see design.md
};

// Preprocessing is timed from the .dat on disk to the .crb on disk; a picture from the material in memory to the pixels
// (scene, setup and rendering). Samples and files live in a temporary folder that is removed. Throws UsageError for an
// unknown sample.
BenchResult bench_seed_table(const SeedTableOptions& options, Session& session);

}  // namespace atomesh::cli
