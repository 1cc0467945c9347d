#include "app/gui/picture_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/material_file.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

namespace fs = std::filesystem;

using Match = PictureData::Match;

// The value of a line "KEY=VALUE".
std::string line_value(std::string_view text, std::string_view key) {
  LineReader lines(text);
  for (std::string_view line; lines.next(line);) {
    if (line.starts_with(key) && line.substr(key.size()).starts_with('=')) {
      return std::string(line.substr(key.size() + 1));
    }
  }
  return "";
}

// Without the one that says how the file was written.
std::string what_was_made(std::string_view provenance) {
  std::string lines;
  LineReader reader(provenance);
  for (std::string_view line; reader.next(line);) {
    if (!line.starts_with("compress=")) lines.append(line).append("\n");
  }
  return lines;
}

// Without the input's hash two files of one name could be anything.
bool same_origin(const std::string& a, const std::string& b) {
  return !line_value(a, "input_hash").empty() && what_was_made(a) == what_was_made(b);
}

std::vector<std::string> candidates(const cli::PictureOrigin& origin, const std::string& png) {
  const fs::path beside = fs::absolute(png).lexically_normal().parent_path();
  const fs::path said = (beside / origin.data).lexically_normal();  // an absolute path stays itself
  const std::string input = line_value(origin.provenance, "input");
  std::vector<fs::path> paths;
  if (!origin.data.empty()) paths = {said, beside / said.filename()};
  for (const fs::path& folder : {said.parent_path(), beside}) {
    if (input.empty()) break;
    const fs::path atoms = folder / input;
    // What preprocessing made of the atoms, where the picture is of these themselves.
    for (const char* made : {".crb", ".crt"}) paths.push_back(fs::path(atoms).replace_extension(made));
    paths.push_back(atoms);
  }
  std::vector<std::string> unique;
  for (const fs::path& path : paths) {
    if (std::find(unique.begin(), unique.end(), path.string()) == unique.end()) unique.push_back(path.string());
  }
  return unique;
}

// What the file at `path` is to the picture; Match::other for whatever cannot be read.
Match match(const cli::PictureOrigin& origin, const std::string& path, Progress& progress) {
  try {
    const auto same_file = [&] {
      return !origin.data_hash.empty() && cli::hash_of_data(path, progress) == origin.data_hash;
    };
    if (is_material_file(path)) {
      if (same_file()) return Match::same;
      const Material head = read_material(
          path, {.atoms = false, .tetrahedra = false, .surface = false, .defects = false, .fields = false}, progress);
      return same_origin(cli::provenance_lines(head.provenance), origin.provenance) ? Match::remade : Match::other;
    }
    const std::string input_hash = line_value(origin.provenance, "input_hash");
    if (input_hash.empty()) return same_file() ? Match::same : Match::other;  // a mesh
    return cli::hash_of_data(path, progress) == input_hash ? Match::atoms : Match::other;
  } catch (const InputError&) {
    return Match::other;
  }
}

}  // namespace

PictureState read_picture_state(const std::string& png, Progress& progress) {
  progress.stage("find_data");
  PictureState state{.origin = cli::read_picture_origin(png), .data = {}, .searched = {}};
  for (const std::string& path : candidates(state.origin, png)) {
    state.searched.push_back(path);
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) continue;
    const PictureData found{.path = path, .match = match(state.origin, path, progress)};
    if (!state.data || found.match < state.data->match) state.data = found;
    if (found.match == Match::same) break;
  }
  return state;
}

std::string missing_data_text(const PictureState& state, const std::string& png) {
  const std::string name = fs::path(state.origin.data).filename().string();
  const std::string picture = fs::path(png).filename().string();
  if (state.origin.data.empty()) {
    return fmt::format("{} does not say which data it shows; open the data first, then the picture", picture);
  }
  if (state.data) {
    return fmt::format("{} shows {}, but the file at {} has another content: it was changed or replaced since", picture,
                       name, state.data->path);
  }
  return fmt::format("{} shows {}, which was not found; looked for {}. Put it beside the picture, or open it first",
                     picture, name, fmt::join(state.searched, ", "));
}

bool shows(const PictureState& state, const Document& document, Progress& progress) {
  if (same_origin(cli::provenance_lines(document.material->provenance), state.origin.provenance)) return true;
  try {
    return !state.origin.data_hash.empty() && cli::hash_of_data(document.path, progress) == state.origin.data_hash;
  } catch (const InputError&) {
    return false;  // gone since it was opened
  }
}

std::vector<std::pair<std::string, std::string>> picture_options(const PictureState& state) {
  std::vector<std::pair<std::string, std::string>> options;
  if (line_value(state.origin.provenance, "input_hash").empty()) return options;
  LineReader lines(state.origin.provenance);
  for (std::string_view line; lines.next(line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string key(line.substr(0, equals));
    if (key != "input" && key != "input_hash") options.emplace_back(key, line.substr(equals + 1));
  }
  return options;
}

}  // namespace atomesh::gui
