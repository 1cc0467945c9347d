#include "app/cli/read_mesh.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>

#include "app/cli/mesh_cells.h"
#include "app/cli/plot3d_layout.h"
#include "core/error.h"
#include "core/file_extension.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

// "" for a file that is no mesh.
std::string format_of(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".vtu") return "vtu";
  if (extension == ".vtk") return "vtk";
  if (extension == ".node" || extension == ".ele") return "tetgen";
  static constexpr std::array<std::string_view, 4> plot3d{".x", ".g", ".bin", ".p3d"};
  const bool named_plot3d = std::find(plot3d.begin(), plot3d.end(), extension) != plot3d.end();
  // Whether it is there, and no folder, is for the readers to say.
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return named_plot3d ? "plot3d" : "";
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  if (bytes.starts_with("# vtk DataFile")) return "vtk";
  const std::string_view head = bytes.substr(0, 1024);
  if (head.find("<VTKFile") != std::string_view::npos) return "vtu";
  if (extension == ".xyz" && find_plot3d_layout(bytes)) return "plot3d";
  // Text with letters belongs to others.
  const bool letters = head.find('\0') == std::string_view::npos &&
                       head.find_first_of("ABCFGHIJKLMNOPQRSTUVWXYZabcfghijklmnopqrstuvwxyz") != std::string_view::npos;
  return named_plot3d && !(letters && !find_plot3d_layout(bytes)) ? "plot3d" : "";
}

// The solution that is named like the grid: xyz for q in its name, or .q for its extension; "" when there is none.
std::string solution_beside(const std::string& path) {
  const std::filesystem::path grid(path);
  std::vector<std::filesystem::path> candidates;
  const std::string stem = grid.stem().string();
  for (const auto& [xyz, q] : {std::pair("xyz", "q"), std::pair("XYZ", "Q"), std::pair("grid", "q")}) {
    const std::size_t at = stem.rfind(xyz);
    if (at == std::string::npos) continue;
    std::string name = stem;
    name.replace(at, std::string_view(xyz).size(), q);
    candidates.push_back(std::filesystem::path(grid).replace_filename(name + grid.extension().string()));
  }
  candidates.push_back(std::filesystem::path(grid).replace_extension(".q"));
  candidates.push_back(std::filesystem::path(grid).replace_extension(".Q"));
  for (const auto& candidate : candidates) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(candidate, ignored) && !std::filesystem::equivalent(candidate, grid, ignored))
      return candidate.string();
  }
  return "";
}

}  // namespace

void add_block(MeshCells& cells, const std::array<std::uint64_t, 3>& points) {
  StructuredBlock block{points};
  if (!cells.blocks.empty()) {
    const StructuredBlock& before = cells.blocks.back();
    const auto& [i, j, k] = before.points;
    block.first_point = before.first_point + i * j * k;
    block.first_cell = before.first_cell + (i - 1) * (j - 1) * (k - 1);
  }
  cells.blocks.push_back(block);
}

bool is_mesh_file(const std::string& path) {
  return !format_of(path).empty();
}

Material read_mesh_file(const std::string& path, const MeshFileOptions& options, MeshFileReport& report,
                        Progress& progress) {
  using clock = std::chrono::steady_clock;
  const auto elapsed_since = [](clock::time_point since) {
    return std::chrono::duration<double, std::milli>(clock::now() - since).count();
  };
  const auto start = clock::now();
  progress.stage("read_mesh");
  report.format = format_of(path);
  const auto file_name = [](const std::string& of) { return std::filesystem::path(of).filename().string(); };
  std::string solution = options.solution;
  MeshCells cells;
  if (report.format == "vtu" || report.format == "vtk") {
    cells = read_vtk_cells(path, report.format, progress);
  } else if (report.format == "tetgen") {
    cells = read_tetgen_cells(path, progress);
  } else if (report.format == "plot3d") {
    if (solution.empty()) solution = solution_beside(path);
    cells = read_plot3d_cells(path, solution, progress);
  } else {
    throw InputError(path, 0, "is no mesh file that can be read: .vtu, .vtk, PLOT3D, or TetGen's .node and .ele");
  }
  if (!options.solution.empty() && report.format != "plot3d") {
    throw UsageError(options.solution + ": only PLOT3D grids have a solution in a file of its own");
  }
  const double read_ms = elapsed_since(start);

  const auto split_start = clock::now();
  progress.stage("split_cells");
  Material material = build_mesh(cells, path, report, progress);
  Provenance& provenance = material.provenance;
  provenance.input = file_name(path);
  provenance.options.emplace_back("format", report.format);
  if (report.format == "plot3d") {
    provenance.options.emplace_back("solution", file_name(solution));
    report.notes.push_back(solution.empty() ? "no solution was found beside the grid; --solution names one"
                                            : "solution " + file_name(solution));
  }
  provenance.counts = {{"points", report.points},   {"cells", report.cells}, {"tetrahedra", report.tetrahedra},
                       {"blanked", report.blanked}, {"flat", report.flat},   {"turned", report.turned},
                       {"skipped", report.skipped}};
  provenance.stages = {{"read_mesh", read_ms}, {"split_cells", elapsed_since(split_start)}};
  return material;
}

}  // namespace atomesh::cli
