// .crb and .crt: a Material on disk. Layout in crb_format.h.
#pragma once

#include <optional>
#include <string>

#include "core/material.h"
#include "core/progress.h"

namespace atomesh {

// Which parts of a file to read; what is not read stays empty.
struct MaterialParts {
  bool atoms = true;  // positions, species, ids, columns, box
  bool tetrahedra = true;
  bool surface = true;
  bool defects = true;
};

// Reads .crb or .crt, told apart by content. Every section read is checked (length, checksum, indices in range) before
// use. Throws InputError "FILE: section NAME: …" (.crb) or "FILE:LINE: …" (.crt) for anything truncated, damaged, of
// another version or inconsistent.
Material read_material(const std::string& path, const MaterialParts& parts = {}, Progress& progress = no_progress());

struct WriteOptions {
  bool compress = true;  // zstd in .crb
};
// Format by extension, .crb or .crt; throws UsageError for another. Written beside and renamed. The same material
// always gives the same bytes.
void write_material(const std::string& path, const Material& material, const WriteOptions& options = {},
                    Progress& progress = no_progress());

// True when the file's first bytes are those of a .crb or .crt. Throws InputError when it cannot be read.
bool is_material_file(const std::string& path);

struct SectionInfo {
  std::string name;
  std::uint64_t bytes = 0;         // uncompressed
  std::uint64_t stored_bytes = 0;  // in the file
};
// The sections of a .crb, in file order (for `info`).
std::vector<SectionInfo> list_sections(const std::string& path);

}  // namespace atomesh
