// Volumes on OpenGL beside the CPU renderer and VTK's projected tetrahedra: frames a second, what they are made of,
// errors, and how many pixels a k-buffer gets wrong.
#pragma once

#include <string>
#include <vector>

#include "app/cli/bench_render.h"

namespace atomesh::cli {

std::vector<std::string> havs_bench_parts();

// Adds each part's tables and rows, and the table of requirements as the first; prints each table when it is there.
// Throws UsageError for an unknown part or case, UnavailableError where there is no OpenGL 4.3.
void bench_havs(const RenderBenchOptions& options, Session& session, BenchResult& result);

// Frames of a turning and of a resting view, what they are made of, and errors, beside the peers.
void bench_havs_frames(RenderBench& bench);
// Pixels that k-buffers and lists cannot restore, where cells are ordered by their keys alone.
void bench_havs_order(RenderBench& bench);

}  // namespace atomesh::cli
