// The seed's table 5.1 measured again: preprocessing and five modes on ten samples.
#pragma once

#include <string>
#include <vector>

#include "app/cli/bench_tools.h"
#include "core/parameters.h"
#include "samples/samples.h"

namespace atomesh::cli {

struct SeedTableOptions {
  std::vector<std::string> samples;  // names; empty: all ten
  std::size_t atoms = 0;             // of each; 0: the seed's count
  int width = 512;                   // pixels
  int height = 512;
  int repeats = 3;  // measured runs, after `warm_up` that are not counted
  int warm_up = 1;
  bool preprocessing = true;  // measured; else only done
  // Of the pictures that are measured.
  std::vector<Mode> modes{Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};
};

// Preprocessing is timed from the .dat on disk to the .crb on disk; a picture from the material in memory to the pixels
// (scene, setup and rendering). Samples and files live in a temporary folder that is removed. Throws UsageError for an
// unknown sample. Adds a table and its rows to `result`; at the seed's own sizes, preprocessing is required to be 30
// times faster than the seed's, volume-surface 10 and xray 20 times.
void bench_seed_table(const SeedTableOptions& options, Session& session, BenchResult& result);

// The names or all ten. Throws UsageError for an unknown one.
std::vector<SampleInfo> chosen_samples(const std::vector<std::string>& names);

}  // namespace atomesh::cli
