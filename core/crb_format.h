// The .crb file, version 3. Everything is little-endian; offsets count bytes from the file's start.
//
//   header   32 bytes   magic "ATOMESH\0", u32 version, u32 sections, u64 file size,
//                       u64 XXH3-64 of the header's first 24 bytes and the whole table
//   table    56 bytes a section, CrbEntry
//   data     the sections' stored bytes in the table's order, without gaps, to the end of the file
//
// So every bit of the file is under a checksum: the header and the table under the header's, a section's stored bytes
// under its entry's. A section is stored raw, or as zstd frames of `crb_block` uncompressed bytes each (the last one
// shorter), whose bytes were first regrouped where that packs better: first bytes of all elements, then the second
// bytes, and so on. A reader takes the sections it needs and touches no page of the others.
//
// All sections together may not unpack to more than 1024 times the file's size and a MiB: a file of a few bytes cannot
// ask for all of a machine's memory. A writer that would break the rule stores its sections raw.
//
//   section         content (n atoms, v vertices, t tetrahedra, s surface triangles)                present
//   counts          CrbCounts                                                                       always
//   species         for each: string name, f64 radius                                               always
//   box             f64 origin[3], f64 vectors[3][3], u8 periodic[3]                                always
//   unit cell       f64 primitive[3][3], u32 basis, for each: string species, f64 position[3]       flag
//   positions       f64[n][3], Å                                                                    n > 0
//   atom species    u16[n], index into species                                                      n > 0
//   ids             i64[n]                                                                          flag
//   scalar names    string for each column                                                          columns > 0
//   scalars         f64[columns][n]                                                                 columns > 0
//   vertices        f64[v][3], Å                                          v > 0 and not equal to the positions
//   vertex atoms    u32[v], index into positions or 0xFFFFFFFF            v > 0 and not 0, 1, 2, …, v-1
//   tetrahedra      u32[t][4], index into vertices                                                  t > 0
//   surface         u32[s][3], index into vertices                                                  s > 0
//   surface cells   u32[s], index into tetrahedra                                                   flag
//   surface faces   u8[s], 0 to 3: which face of that tetrahedron                                   flag
//   defects         f32[3][n]: positional, vacancy, extra                                           flag
//   vacancies       for each: f64 position[3], u32 species, u32 votes                               vacancies > 0
//   extras          for each: u32 atom, u32 votes                                                   extras > 0
//   substitutions   for each: u32 atom, u32 expected species, u32 index into the vacancies          substitutions > 0
//   field names     string for each                                                                 fields > 0
//   fields          f32[fields][v]                                                                  fields > 0, v > 0
//   provenance      string program, string input, u32 and pairs of strings (options), u32 and string with u64
//                   (counts), u32 and string with f64 ms (stages)                                   always
//
// A string is u32 length and that many bytes of UTF-8.
//
// Version 2 had no fields, and version 1 no substitutions either: neither the sections nor their numbers, which stand
// last in the counts. Both are still read.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

namespace atomesh {

static_assert(std::endian::native == std::endian::little, ".crb is read and written without swapping bytes");

inline constexpr std::string_view crb_magic{"ATOMESH\0", 8};
inline constexpr std::uint32_t crb_version = 3;
inline constexpr std::uint32_t crb_oldest_version = 1;
inline constexpr std::size_t crb_block = std::size_t{1} << 20U;
inline constexpr std::uint64_t crb_largest_ratio = 1024;
inline constexpr std::uint64_t crb_ratio_allowance = std::uint64_t{1} << 20U;

struct CrbHeader {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t sections;
  std::uint64_t file_size;
  std::uint64_t checksum;
};
static_assert(sizeof(CrbHeader) == 32);

enum class CrbEncoding : std::uint32_t { raw = 0, zstd = 1 };

struct CrbEntry {
  std::array<char, 16> name;  // padded with zeros
  CrbEncoding encoding;
  std::uint32_t element;  // bytes of the elements that were regrouped; 1 where they were not
  std::uint64_t offset;
  std::uint64_t stored;    // bytes in the file
  std::uint64_t raw;       // bytes unpacked
  std::uint64_t checksum;  // XXH3-64 of the stored bytes
};
static_assert(sizeof(CrbEntry) == 56);

struct CrbCounts {
  std::uint64_t atoms;
  std::uint64_t species;
  std::uint64_t columns;
  std::uint64_t vertices;
  std::uint64_t tetrahedra;
  std::uint64_t triangles;
  std::uint64_t vacancies;
  std::uint64_t extras;
  std::uint64_t flags;
  std::uint64_t substitutions;
  std::uint64_t fields;
};
static_assert(sizeof(CrbCounts) == 88);
// What versions 1 and 2 have of them.
inline constexpr std::size_t crb_counts_size_1 = 72;
inline constexpr std::size_t crb_counts_size_2 = 80;

// Bits of CrbCounts::flags.
inline constexpr std::uint64_t crb_has_unit_cell = 1;
inline constexpr std::uint64_t crb_has_ids = 2;
inline constexpr std::uint64_t crb_vertices_are_positions = 4;
inline constexpr std::uint64_t crb_vertex_atoms_are_identity = 8;
inline constexpr std::uint64_t crb_has_surface_cells = 16;
inline constexpr std::uint64_t crb_has_defects = 32;
inline constexpr std::uint64_t crb_delaunay = 64;
inline constexpr std::uint64_t crb_all_flags = 127;

}  // namespace atomesh
