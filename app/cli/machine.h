// What this process and this machine are, for reports.
#pragma once

#include <string>

namespace atomesh::cli {

// The most memory this process has held so far, MB (10⁶ bytes).
double peak_memory_mb();

// Processor and number of threads used: "Intel(R) Xeon(R) …, 2 threads".
std::string machine_name();

// The commit this program was built from, "unknown" outside a git checkout; with "+" when files had changed.
std::string build_commit();

}  // namespace atomesh::cli
