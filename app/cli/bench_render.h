// What pictures cost and how right they are, part by part: every mode and integrator, threads, memory, first pictures,
// VTK's mappers in the same run, and the seed's figures.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/bench_judge.h"
#include "app/cli/bench_scenes.h"
#include "app/cli/bench_tools.h"

namespace atomesh::cli {

struct RenderBenchOptions {
  std::vector<std::string> parts;  // empty: all of render_bench_parts()
  std::vector<std::string> cases;  // data sets of bench_scenes.h; empty: each part's own
  std::string data;                // folder of the public data sets; "": where they are looked for
  int width = 0;                   // pixels; 0: each part's own
  int height = 0;
  int repeats = 3;      // measured runs of what is ours; slow peers run once
  bool peers = true;    // VTK's mappers
  bool z_sweep = true;  // the slowest of them, half a minute a picture
  bool full = false;    // more data sets, every view
  bool quick = false;   // tiny data sets and pictures, to see that it works; nothing is required of them
};

std::vector<std::string> render_bench_parts();

// Adds each part's tables and rows, and the table of requirements as the first; prints each table when it is there.
// Throws UsageError for an unknown part or case.
void bench_render(const RenderBenchOptions& options, Session& session, BenchResult& result);

// One part's work.
class RenderBench {
 public:
  RenderBench(const RenderBenchOptions& o, Session& s, BenchResult& r) : options(o), session(s), result(r) {}

  const RenderBenchOptions& options;
  Session& session;
  BenchResult& result;
  BenchJudge judge;

  int width(int usual) const { return options.width > 0 ? options.width : options.quick ? 96 : usual; }
  int height(int usual) const { return options.height > 0 ? options.height : options.quick ? 64 : usual; }
  // Whether pictures are as large as requirements ask for.
  bool usual_size() const { return options.width == 0 && !options.quick; }
  // The cases asked for, else `usual`, with --full also `more`, with --quick a tiny one.
  std::vector<std::string> cases(std::vector<std::string> usual, const std::vector<std::string>& more = {}) const;
  // The data set by name; nothing, and a note, where it cannot be had. Small ones are kept for the parts that follow.
  std::shared_ptr<const BenchScene> scene(const std::string& name);
  // The first of the data set's views, with --full all of them.
  std::vector<BenchView> views(const BenchScene& scene) const;

 private:
  std::map<std::string, std::shared_ptr<const BenchScene>> kept_;
};

// Ours beside VTK's mappers: times and errors on the same cells, camera and colour map.
void bench_render_peers(RenderBench& bench);
// Every mode, and in the volume modes every integrator: times, steps, errors.
void bench_render_modes(RenderBench& bench);
// Ray–tetrahedron steps a second and core on meshes of 0.3, 1.4 and 7 million cells.
void bench_render_rates(RenderBench& bench);
// One thread and all of them.
void bench_render_threads(RenderBench& bench);
// What a picture takes beside the mesh.
void bench_render_memory(RenderBench& bench);
// The first picture of a progressive drawing, and frames a second.
void bench_render_frames(RenderBench& bench);
// The modes of the seed's table 5.1 that pictures are required to be faster in.
void bench_render_seed(RenderBench& bench);

}  // namespace atomesh::cli
