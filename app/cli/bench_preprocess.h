// What preprocessing costs and whether it is right, part by part, with peers in the same run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/cli/bench_tools.h"

namespace atomesh::cli {

struct PreprocessBenchOptions {
  std::vector<std::string> parts;  // empty: all of preprocess_bench_parts()
  std::size_t atoms = 0;           // of every crystal; 0: each part's own
  int repeats = 1;                 // measured runs of what is ours; slow peers run once
  bool full = false;               // every case, and the large ones: half an hour
};

std::vector<std::string> preprocess_bench_parts();

// Adds each part's tables and rows, and at last the table of requirements; prints each table when it is there. Throws
// UsageError for an unknown part.
void bench_preprocess(const PreprocessBenchOptions& options, Session& session, BenchResult& result);

// One part's work.
struct PreprocessBench {
  const PreprocessBenchOptions& options;
  Session& session;
  BenchResult& result;

  std::size_t atoms(std::size_t usual) const { return options.atoms > 0 ? options.atoms : usual; }
};

// Every mesher on crystals that are hard for it, beside CGAL as everybody calls it: times, memory, validity.
void bench_tetrahedralize(const PreprocessBench& bench);
// Crystal-defect values: atoms a second and core, beside LAMMPS.
void bench_quantify_defects(const PreprocessBench& bench);
// Fewer tetrahedra without loss, beside VTK's decimation, which loses; how fast, how near the bound, and what pictures
// say.
void bench_simplify(const PreprocessBench& bench);
// A million atoms from .dat to .crb, stage by stage, and each row of the seed's table.
void bench_pipeline(const PreprocessBench& bench);
// Planted defects found, and what was found without being planted.
void bench_truth(const PreprocessBench& bench);
// Unit cells of common structures and of the ten samples, found from the atoms alone.
void bench_find_unit_cell(const PreprocessBench& bench);

}  // namespace atomesh::cli
