#include "app/cli/bench_window.h"

#include <fmt/format.h>
#include <stdio.h>

#include <array>
#include <filesystem>

#include "app/cli/text_table.h"
#include "app/cli/virtual_display.h"
#include "core/error.h"
#include "core/material_file.h"
#include "core/parameter_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"

namespace atomesh::cli {

namespace {

struct Shown {
  double first = 0.0;     // ms
  double complete = 0.0;  // ms
};

Shown run_until_shown(const std::string& material, const std::string& parameters) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  // The paths are our own: no quotes in them.
  const std::string command = "'" + program + "' '" + material + "' --params '" + parameters + "' --until-shown";
  FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr) throw UnavailableError("bench window: the program cannot be started");
  std::string text;
  std::array<char, 256> part{};
  while (fgets(part.data(), part.size(), output) != nullptr) text += part.data();
  const int status = pclose(output);
  Shown shown;
  if (status != 0 ||
      sscanf(text.c_str(), "first picture after %lf ms, complete after %lf ms", &shown.first, &shown.complete) != 2) {
    throw UnavailableError("bench window: the window showed no picture");
  }
  return shown;
}

struct Case {
  const char* name;
  std::size_t atoms;  // 0: the sample's own
  Mode mode;
  double required;  // ms
};

}  // namespace

void bench_window(const WindowBenchOptions& options, Session& session, BenchResult& result) {
  const VirtualDisplay display;
  if (!display.available()) throw UnavailableError("bench window: " + display.why_not());
  TextTable table({"sample", "atoms", "mode", "first picture", "complete"});
  const std::array<Case, 2> cases{{{"nacl-cracked", options.quick ? 1800U : 0U, Mode::volume_surface, 1000.0},
                                   {"diamond-vacancy", options.quick ? 3000U : 1'000'000U, Mode::atoms, 3000.0}}};
  for (const Case& shown : cases) {
    session.progress().stage(fmt::format("{}: sample", shown.name));
    const TemporaryFolder folder;
    const Sample sample = make_sample(shown.name, {.atoms = shown.atoms}, session.progress());
    write_atoms(folder.file("sample.dat"), sample.atoms, sample.unit_cell, session.progress());
    PipelineReport report;
    write_material(folder.file("sample.crb"), preprocess(folder.file("sample.dat"), {}, report, session.progress()));
    Parameters parameters;
    parameters.mode = shown.mode;
    write_crf(folder.file("view.crf"), parameters);
    std::vector<Run> first;
    std::vector<Run> complete;
    for (int run = -1; run < options.repeats; ++run) {
      session.progress().stage(fmt::format("{}: window", shown.name));
      const Shown times = run_until_shown(folder.file("sample.crb"), folder.file("view.crf"));
      if (run < 0) continue;  // files and libraries into the system's memory
      first.push_back({times.first, 0.0});
      complete.push_back({times.complete, 0.0});
    }
    const Times first_times = times_of(first);
    const Times complete_times = times_of(complete);
    BenchRow row{"window",
                 shown.name,
                 fmt::format("first picture, {}", mode_name(shown.mode)),
                 Json::object(),
                 "",
                 first_times,
                 {},
                 {},
                 {}};
    row.more = {{"atoms", sample.atoms.size()}, {"complete_ms", complete_times.median}, {"display", display.name()}};
    if (!options.quick) {
      row.requirements = {
          {fmt::format("window: first picture of {}", shown.name), shown.required, false, first_times.median, " ms"}};
    }
    result.add(std::move(row));
    table.row({shown.name, grouped(sample.atoms.size()), std::string(mode_name(shown.mode)),
               milliseconds(first_times.median) + " ms", milliseconds(complete_times.median) + " ms"});
  }
  result.tables.push_back(
      {"The window", std::move(table),
       fmt::format("From the start of the program, its libraries included, to the first picture and "
                   "to the complete one, on {}.",
                   display.name())});
  session.print_text(result.text());
}

}  // namespace atomesh::cli
