// Many atoms files, one after the other.
#pragma once

#include <vector>

#include "app/cli/batch_plan.h"
#include "app/cli/session.h"

namespace atomesh::cli {

// Makes what is not up to date (everything with `force`), making missing folders on the way, and goes on past a file
// that fails. Prints a line for each file and a table at the end; the JSON is {files: [what one file says, status:
// "done" | "skipped" | "failed" | "cancelled", error], done, skipped, failed, cancelled}. Returns the largest exit code
// of those that failed; after Ctrl-C, which stops at the present file, that of a cancel.
//
// Up to date is an output that this version of the program wrote, from a file of the same name and content, with the
// same options; it says so itself, dates do not count.
int run_batch(const std::vector<PreprocessJob>& jobs, const PreprocessSettings& settings, bool force, Session& session);

}  // namespace atomesh::cli
