// A bench's outcome as one HTML file that needs no other: tables, plots, captions.
#pragma once

#include <span>
#include <string>

#include "app/cli/bench_tools.h"

namespace atomesh::cli {

struct ReportOrigin {
  std::string machine;
  std::string commit;
  std::string date;
};
// This process, now (UTC): "2026-11-23 10:15 UTC".
ReportOrigin report_origin();

// One section for each of `sections`, in order: heading, plots with their captions, table, caption. In a column headed
// "met" cells that begin with "yes" and "NO" are marked. Everything is escaped. `origin` is in the page's head.
std::string report_html(const std::string& title, std::span<const BenchTable> sections, const ReportOrigin& origin);

}  // namespace atomesh::cli
