#include "app/cli/picture_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "app/cli/parameter_text.h"
#include "core/content_hash.h"
#include "core/crb_format.h"
#include "core/error.h"
#include "core/parameter_file.h"
#include "core/text_file.h"
#include "preprocess/pipeline.h"

namespace atomesh::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* software_key = "Software";
constexpr const char* source_key = "Source";
constexpr const char* renderer_key = "atomesh renderer";
constexpr const char* parameters_key = "atomesh parameters";
constexpr const char* parts_key = "atomesh parts";
constexpr const char* data_key = "atomesh data";
constexpr const char* hash_key = "atomesh data hash";
constexpr const char* provenance_key = "atomesh provenance";

// As seen from the picture's folder, so that both can be moved together and the PNG tells nothing of the machine; not
// through so many folders that it would be by chance.
std::string place_of(const std::string& data, const std::string& png) {
  const fs::path file = fs::absolute(data).lexically_normal();
  const fs::path from_picture = file.lexically_relative(fs::absolute(png).lexically_normal().parent_path());
  const auto up = std::count(from_picture.begin(), from_picture.end(), "..");
  return from_picture.empty() || up > 2 ? file.string() : from_picture.string();
}

std::string parts_text(const PictureParts& parts) {
  std::string text;
  const auto add = [&](bool there, const char* name) {
    if (there) text += text.empty() ? name : std::string(" ") + name;
  };
  add(parts.legend, "legend");
  add(parts.scale_bar, "scale_bar");
  add(parts.tripod, "tripod");
  return text;
}

// Keys of the table have no "=", but species may; colours, radii and visibilities have none.
std::size_t equals_of(std::string_view line) {
  return line.starts_with("atoms.") ? line.rfind('=') : line.find('=');
}

Parameters parse_lines(std::string_view text, const std::string& png, const std::string& program) {
  Parameters parameters;
  LineReader lines(text);
  for (std::string_view line; lines.next(line);) {
    if (line.empty()) continue;
    const std::size_t equals = equals_of(line);
    try {
      if (equals == std::string_view::npos) throw UsageError(fmt::format("\"{}\": expected key=value", line));
      set_parameter(parameters, line.substr(0, equals), line.substr(equals + 1));
    } catch (const UsageError& error) {
      throw InputError(
          png, 0,
          fmt::format("made by {}, its parameters are not those of {}: {}", program, program_version(), error.what()));
    }
  }
  return parameters;
}

}  // namespace

std::string hash_of_data(const std::string& path, Progress& progress) {
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  CrbHeader header{};
  if (!bytes.starts_with(crb_magic) || bytes.size() < sizeof header) return content_hash(bytes, progress);
  std::memcpy(&header, bytes.data(), sizeof header);
  return "crb-" + content_hash(bytes.substr(0, sizeof header + header.sections * sizeof(CrbEntry)), progress);
}

std::string provenance_lines(const Provenance& provenance) {
  std::string lines;
  if (!provenance.input.empty()) lines += "input=" + provenance.input + "\n";
  for (const auto& [key, value] : provenance.options) lines += key + "=" + value + "\n";
  return lines;
}

PngText picture_text(const std::string& png, const std::string& data, const std::string& data_hash,
                     const Material& material, const Parameters& parameters, std::string_view renderer,
                     const PictureParts& parts) {
  return {{software_key, program_version()},
          {source_key, fs::path(data).filename().string()},
          {renderer_key, std::string(renderer)},
          {parameters_key, parameter_lines(parameters)},
          {parts_key, parts_text(parts)},
          {data_key, place_of(data, png)},
          {hash_key, data_hash},
          {provenance_key, provenance_lines(material.provenance)}};
}

PictureOrigin read_picture_origin(const std::string& png) {
  const PngText text = read_png_text(png);
  const auto find = [&](const char* key) -> const std::string* {
    const auto found = std::find_if(text.begin(), text.end(), [&](const auto& entry) { return entry.first == key; });
    return found == text.end() ? nullptr : &found->second;
  };
  const auto value = [&](const char* key) {
    const std::string* found = find(key);
    return found == nullptr ? std::string() : *found;
  };
  const std::string* parameters = find(parameters_key);
  if (parameters == nullptr) {
    const std::string software = value(software_key);
    throw InputError(png, 0,
                     fmt::format("does not say how it was made: it is {}, and only those of atomesh carry their "
                                 "parameters (programs that edit or resize pictures may drop them)",
                                 software.empty() ? "a picture of another program" : "a picture of " + software));
  }
  PictureOrigin origin;
  origin.program = value(software_key);
  origin.renderer = value(renderer_key);
  origin.parameters = parse_lines(*parameters, png, origin.program.empty() ? "another version" : origin.program);
  const std::string parts = " " + value(parts_key) + " ";
  const auto shows = [&](const char* name) { return parts.find(std::string(" ") + name + " ") != std::string::npos; };
  origin.parts = {.legend = shows("legend"), .scale_bar = shows("scale_bar"), .tripod = shows("tripod")};
  const std::string* data = find(data_key);
  origin.data = data == nullptr ? value(source_key) : *data;  // older pictures only say the name
  origin.data_hash = value(hash_key);
  origin.provenance = value(provenance_key);
  return origin;
}

Parameters read_parameters(const std::string& path) {
  return is_png_file(path) ? read_picture_origin(path).parameters : read_crf(path);
}

}  // namespace atomesh::cli
