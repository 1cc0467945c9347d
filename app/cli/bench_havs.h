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

}  // namespace atomesh::cli
