#include "app/cli/preprocess_batch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <optional>

#include "app/cli/load_material.h"
#include "app/cli/machine.h"
#include "app/cli/text_table.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/material_file.h"
#include "core/memory.h"
#include "preprocess/memory_needs.h"

namespace atomesh::cli {

namespace {

namespace fs = std::filesystem;

struct BatchRow {
  PreprocessJob job;
  std::string status;
  std::string error;  // of what failed
  int exit_code = 0;
  double ms = 0.0;
  // How many of what a person asks first; empty where nothing was made.
  std::optional<Provenance> provenance;
  Json json = Json::object();
};

std::uint64_t count_of(const Provenance& provenance, std::string_view name) {
  for (const auto& [key, value] : provenance.counts) {
    if (key == name) return value;
  }
  return 0;
}

// What the output says of itself, when it is up to date.
std::optional<Provenance> up_to_date(const PreprocessJob& job, const PreprocessSettings& settings, Session& session) {
  if (!fs::is_regular_file(job.output)) return std::nullopt;
  Provenance provenance;
  try {
    const MaterialParts provenance_only{.atoms = false, .tetrahedra = false, .surface = false, .defects = false};
    provenance = read_material(job.output, provenance_only, session.progress()).provenance;
  } catch (const InputError&) {
    return std::nullopt;  // damaged, of another version, or no material at all
  }
  if (provenance.program != program_version() || provenance.input != fs::path(job.input).filename().string()) {
    return std::nullopt;
  }
  // A format that was not asked for follows from the content.
  auto wanted = recorded_options(settings, settings.options.read.format);
  auto recorded = provenance.options;
  if (settings.options.read.format.empty()) {
    for (auto* list : {&wanted, &recorded}) std::erase_if(*list, [](const auto& o) { return o.first == "format"; });
  }
  if (recorded.empty() || recorded.back().first != "input_hash") return std::nullopt;
  const std::string hash = recorded.back().second;
  recorded.pop_back();
  if (recorded != wanted || content_hash_of_file(job.input, session.progress()) != hash) return std::nullopt;
  return provenance;
}

Json skipped_json(const BatchRow& row) {
  const Provenance& p = *row.provenance;
  return Json::object(
      {{"input", Json::object({{"file", row.job.input}, {"atoms", count_of(p, "atoms_read")}})},
       {"mesh", Json::object({{"vertices", count_of(p, "vertices")}, {"tetrahedra", count_of(p, "tetrahedra")}})},
       {"surface", Json::object({{"triangles", count_of(p, "triangles")}})},
       {"defects", Json::object({{"positional_atoms", count_of(p, "positional_atoms")},
                                 {"vacancy_atoms", count_of(p, "vacancy_atoms")},
                                 {"extra_atoms", count_of(p, "extra_atoms")},
                                 {"vacancies", count_of(p, "vacancies")},
                                 {"extras", count_of(p, "extras")},
                                 {"substitutions", count_of(p, "substitutions")}})},
       {"output", Json::object({{"file", row.job.output}, {"bytes", fs::file_size(row.job.output)}})}});
}

Json failed_json(const BatchRow& row) {
  return Json::object(
      {{"input", Json::object({{"file", row.job.input}})}, {"output", Json::object({{"file", row.job.output}})}});
}

void make(BatchRow& row, const PreprocessSettings& settings, bool force, Session& session) {
  if (!force) row.provenance = up_to_date(row.job, settings, session);
  if (row.provenance) {
    row.status = "skipped";
    row.json = skipped_json(row);
    return;
  }
  if (const fs::path folder = fs::path(row.job.output).parent_path(); !folder.empty()) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error(folder.string() + ": this folder cannot be made: " + error.message());
  }
  const PreprocessedFile file = preprocess_file(row.job, settings, session.progress());
  show_notes(file.report, session);
  row.status = "done";
  row.provenance = file.material.provenance;
  row.json = preprocess_json(file);
}

// Everything that can go wrong with one file, as a row; a cancel is the batch's.
void try_make(BatchRow& row, const PreprocessSettings& settings, bool force, Session& session) {
  const auto fail = [&row](const std::string& status, const std::string& error, int exit_code) {
    row.status = status;
    row.error = error;
    row.exit_code = exit_code;
    row.json = failed_json(row);
  };
  const auto start = std::chrono::steady_clock::now();
  try {
    make(row, settings, force, session);
  } catch (const CancelledError& error) {
    fail("cancelled", error.what(), error.exit_code());
  } catch (const Error& error) {
    fail("failed", error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    const UnavailableError error("the memory ran out; " + memory_advice());
    fail("failed", error.what(), error.exit_code());
  } catch (const std::exception& error) {
    // Of a file system or a library: one bad file, not the end of the batch.
    fail("failed", error.what(), Error("").exit_code());
  }
  row.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  release_free_memory();
}

// The first line of what went wrong, without the name of the file, which stands in the row already.
std::string short_error(const BatchRow& row) {
  std::string text = row.error.substr(0, row.error.find('\n'));
  if (text.starts_with(row.job.input + ": ")) text.erase(0, row.job.input.size() + 2);
  return text;
}

std::string table_of(const std::vector<BatchRow>& rows) {
  TextTable table({"file", "status", "atoms", "tetrahedra", "vacancies", "extra", "displaced", "ms", "result"});
  for (const BatchRow& row : rows) {
    const auto count = [&row](std::string_view name) {
      return row.provenance ? grouped(count_of(*row.provenance, name)) : "-";
    };
    table.row({row.job.input, row.status, count("atoms"), count("tetrahedra"), count("vacancies"), count("extras"),
               count("positional_atoms"), milliseconds(row.ms), row.error.empty() ? row.job.output : short_error(row)});
  }
  return table.text();
}

}  // namespace

int run_batch(const std::vector<PreprocessJob>& jobs, const PreprocessSettings& settings, bool force,
              Session& session) {
  std::vector<BatchRow> rows;
  bool cancelled = false;
  for (const PreprocessJob& job : jobs) {
    BatchRow& row = rows.emplace_back();
    row.job = job;
    if (cancelled) {
      row.status = "cancelled";
      row.error = "not begun";
      row.exit_code = CancelledError().exit_code();
      row.json = failed_json(row);
      continue;
    }
    try_make(row, settings, force, session);
    cancelled = row.status == "cancelled";
    session.print("[{}/{}] {}: {}{}", rows.size(), jobs.size(), job.input, row.status,
                  row.error.empty() ? "" : ": " + short_error(row));
  }

  const auto number_of = [&rows](std::string_view status) {
    return std::count_if(rows.begin(), rows.end(), [status](const BatchRow& row) { return row.status == status; });
  };
  session.print("");
  session.print_text(table_of(rows));
  session.print("{} done, {} skipped, {} failed{}; peak memory {:.0f} MB", number_of("done"), number_of("skipped"),
                number_of("failed"), cancelled ? fmt::format(", {} cancelled", number_of("cancelled")) : "",
                peak_memory_mb());
  int exit_code = 0;
  Json list = Json::array();
  for (BatchRow& row : rows) {
    exit_code = std::max(exit_code, row.exit_code);
    row.json.set("status", row.status);
    row.json.set("error", row.error.empty() ? Json() : Json(row.error));
    list.push(std::move(row.json));
  }
  session.write_json(Json::object({{"files", std::move(list)},
                                   {"done", number_of("done")},
                                   {"skipped", number_of("skipped")},
                                   {"failed", number_of("failed")},
                                   {"cancelled", number_of("cancelled")}}));
  return exit_code;
}

}  // namespace atomesh::cli
