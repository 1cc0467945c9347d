// How far pictures are off the judge's, and what it costs to be nearer: speed against error of every integrator beside
// VTK's mappers, the error of every data set and mode, and the hard cases.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/cli/bench_render.h"

namespace atomesh::cli {

std::vector<std::string> error_bench_parts();

// Adds each part's tables and rows, and the table of requirements as the first; prints each table when it is there.
// Throws UsageError for an unknown part or case.
void bench_error(const RenderBenchOptions& options, Session& session, BenchResult& result);

// Time and error of every integrator and number of samples, and of VTK's mappers: a table and a plot for each data set,
// view and mode; the order at which samples converge.
void bench_error_curves(RenderBench& bench);
// The default setting and the closed form on all data sets in all modes.
void bench_error_scenes(RenderBench& bench);
// The catalogue of hard cases: lengths that are known, and values that the judge knows.
void bench_error_hard_cases(RenderBench& bench);

// The largest error that the closed form, and that the default setting may make.
inline constexpr double closed_form_limit = 1e-5;
inline constexpr double default_limit = 1.0 / 512.0;

// p of error ≈ c · n⁻ᵖ through points (n, error), by least squares of the logarithms. Errors below `floor` are
// rounding and left out; NaN where fewer than two are left.
double convergence_order(const std::vector<std::pair<int, double>>& points, double floor);

}  // namespace atomesh::cli
