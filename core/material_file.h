// .crb and .crt: a Material on disk. Layout in crb_format.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/material.h"
#include "core/progress.h"

namespace atomesh {

// Which parts of a file to read; what is not read stays empty. The list of species, the unit cell, TetMesh::delaunay
// and the provenance are small and always read.
struct MaterialParts {
  bool atoms = true;       // positions, species, ids, columns, box
  bool tetrahedra = true;  // with the vertices
  bool surface = true;     // with the vertices; Surface::tetrahedron and face only beside the tetrahedra
  bool defects = true;
  bool fields = true;  // of the vertices; only beside them
};

// Reads .crb or .crt, told apart by content. Every section read is checked (length, checksum, indices in range) before
// use. Throws InputError "FILE: section NAME: …" (.crb) or "FILE:LINE: …" (.crt) for anything truncated, damaged, of
// another version or inconsistent.
Material read_material(const std::string& path, const MaterialParts& parts = {}, Progress& progress = no_progress());

// The same from bytes in memory; `name` stands for the file in messages.
Material parse_material(std::string_view bytes, const std::string& name, const MaterialParts& parts = {},
                        Progress& progress = no_progress());

struct WriteOptions {
  bool compress = true;  // zstd in .crb
};
// Format by extension, .crb or .crt; throws UsageError for another. Throws Error for a material that could not be read
// back (find_problem in check_material.h). Written beside and renamed. The same material always gives the same bytes.
void write_material(const std::string& path, const Material& material, const WriteOptions& options = {},
                    Progress& progress = no_progress());

// True when the file's first bytes are those of a .crb or .crt. Throws InputError when it cannot be read.
bool is_material_file(const std::string& path);

struct SectionInfo {
  std::string name;
  std::uint64_t bytes = 0;         // uncompressed
  std::uint64_t stored_bytes = 0;  // in the file
};
// The sections of a .crb, in file order (for `info`). Throws InputError for any other file.
std::vector<SectionInfo> list_sections(const std::string& path);

}  // namespace atomesh
