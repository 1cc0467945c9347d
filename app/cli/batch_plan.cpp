#include "app/cli/batch_plan.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "app/cli/output_file.h"
#include "core/error.h"
#include "preprocess/read_atoms.h"

namespace atomesh::cli {

namespace {

namespace fs = std::filesystem;

bool is_pattern(const std::string& word) {
  std::error_code ignored;
  return word.find_first_of("*?[{") != std::string::npos && !fs::exists(word, ignored);
}

bool is_folder(const std::string& word) {
  std::error_code ignored;
  return fs::is_directory(word, ignored);
}

bool names_folder(const std::string& output) {
  return output.ends_with('/') || is_folder(output);
}

bool is_template(const std::string& output) {
  return output.find('{') != std::string::npos;
}

std::vector<std::string> files_of_folder(const std::string& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && has_atoms_extension(entry.path().string())) files.push_back(entry.path().string());
  }
  if (files.empty()) throw InputError(folder, 0, "holds no file with the ending of an atoms file");
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> files_of_pattern(const std::string& pattern) {
  ::glob_t found{};
  std::vector<std::string> files;
  if (::glob(pattern.c_str(), GLOB_BRACE, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      if (!is_folder(found.gl_pathv[i])) files.emplace_back(found.gl_pathv[i]);
    }
  }
  ::globfree(&found);
  if (files.empty()) throw InputError(pattern, 0, "no file has a name like this pattern");
  return files;
}

std::string output_for(const std::string& input, const std::string& pattern) {
  const fs::path path(input);
  const std::map<std::string, std::string> values{
      {"name", path.stem().string()},
      {"file", path.filename().string()},
      {"folder", fs::absolute(path).lexically_normal().parent_path().filename().string()}};
  std::string output;
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', at), pattern.size());
    output += pattern.substr(at, open - at);
    if (open == pattern.size()) break;
    const std::size_t close = pattern.find('}', open);
    const std::string key = pattern.substr(open + 1, close == std::string::npos ? close : close - open - 1);
    const auto value = values.find(key);
    if (close == std::string::npos || value == values.end()) {
      throw UsageError(fmt::format(
          "-o \"{}\": there is no placeholder {{{}}}; there are {{name}}, {{file}} and {{folder}}", pattern, key));
    }
    output += value->second;
    at = close + 1;
  }
  return output;
}

}  // namespace

bool is_batch(const std::vector<std::string>& inputs, const std::string& output) {
  return inputs.size() > 1 || names_folder(output) || is_template(output) || is_pattern(inputs.front()) ||
         is_folder(inputs.front());
}

std::vector<PreprocessJob> plan_batch(const std::vector<std::string>& inputs, const std::string& output) {
  if (!names_folder(output) && !is_template(output)) {
    throw UsageError(fmt::format(
        "-o \"{}\": several files cannot become one; name a folder (-o \"{}/\") or a template (-o \"{{name}}.crb\")",
        output, fs::path(output).stem().string()));
  }
  const std::string pattern = names_folder(output) ? (fs::path(output) / "{name}.crb").string() : output;
  const std::string ending = fs::path(pattern).extension().string();
  if (ending != ".crb" && ending != ".crt") {
    throw UsageError(fmt::format("-o \"{}\": cannot write this kind of file; the name must end in .crb, .crt", output));
  }

  std::vector<std::string> files;
  for (const std::string& word : inputs) {
    std::vector<std::string> more{word};
    if (is_folder(word)) more = files_of_folder(word);
    if (is_pattern(word)) more = files_of_pattern(word);
    files.insert(files.end(), more.begin(), more.end());
  }

  std::vector<PreprocessJob> jobs;
  std::set<fs::path> seen;
  std::map<fs::path, std::string> taken;
  for (const std::string& file : files) {
    if (!seen.insert(fs::weakly_canonical(file)).second) continue;
    const std::string target = output_for(file, pattern);
    const auto [place, free] = taken.try_emplace(fs::weakly_canonical(target), file);
    if (!free) {
      throw UsageError(fmt::format(
          "{} and {} would both become {}; tell them apart with a template, such as -o \"{}\"", place->second, file,
          target,
          fs::path(place->second).filename() == fs::path(file).filename() ? "{folder}-{name}.crb" : "{file}.crb"));
    }
    jobs.push_back({file, target});
  }
  return jobs;
}

}  // namespace atomesh::cli
