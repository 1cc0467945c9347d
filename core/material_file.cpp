#include "core/material_file.h"

#include <algorithm>

#include "core/check_material.h"
#include "core/crb_format.h"
#include "core/crb_material.h"
#include "core/crt_material.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

enum class Kind { crb, crt, other };

// By the first bytes; a file cut off within them still counts as what it began to be.
Kind kind_of(std::string_view bytes) {
  if (!bytes.empty() && bytes.starts_with(crb_magic.substr(0, bytes.size()))) return Kind::crb;
  std::string_view text = bytes.substr(0, 4096);
  LineReader lines(text);
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view field = next_field(line);
    if (field.empty() || field[0] == '#') continue;
    return field == crt_magic ? Kind::crt : Kind::other;
  }
  return Kind::other;
}

}  // namespace

Material read_material(const std::string& path, const MaterialParts& parts, Progress& progress) {
  const MappedFile file(path);
  return parse_material(file.bytes(), path, parts, progress);
}

Material parse_material(std::string_view bytes, const std::string& name, const MaterialParts& parts,
                        Progress& progress) {
  progress.stage("read");
  switch (kind_of(bytes)) {
    case Kind::crb:
      return read_crb(bytes, name, parts, progress);
    case Kind::crt:
      return read_crt(bytes, name, parts, progress);
    case Kind::other:
      break;
  }
  throw InputError(name, 0, "neither a .crb nor a .crt file (its first bytes say so)");
}

void write_material(const std::string& path, const Material& material, const WriteOptions& options,
                    Progress& progress) {
  const bool binary = path.ends_with(".crb");
  if (!binary && !path.ends_with(".crt")) {
    throw UsageError(path +
                     ": a material is written as .crb (binary) or .crt (text); give the file one of these endings");
  }
  if (const auto problem = find_problem(material, counts_of(material), progress)) {
    throw Error(path + ": this material cannot be written: " + problem->section + ": " + problem->what);
  }
  progress.stage("write");
  if (binary) {
    write_crb(path, material, options.compress, progress);
  } else {
    write_crt(path, material, progress);
  }
}

bool is_material_file(const std::string& path) {
  return kind_of(MappedFile(path).bytes()) != Kind::other;
}

std::vector<SectionInfo> list_sections(const std::string& path) {
  return list_crb_sections(MappedFile(path).bytes(), path);
}

}  // namespace atomesh
