// A Material as .crt: the content of a .crb as text for people and other tools. Use core/material_file.h, which knows
// both formats.
//
// Lines that are empty or start with # are skipped; fields are separated by blanks. Numbers are the shortest decimals
// that read back to the same bits. Sections stand in this order, and those marked with ? are left out when empty:
//
//   atomesh-crt 3
//   program "…", input "…", option "name" "value", count "name" N, stage "name" MS      (one a line, the last three any
//                                                                                      number of times)
//   species N               N lines: "name" radius
//   box                     origin x y z, then three lines: vector x y z periodic|open
//   unit_cell N         ?   three lines: primitive x y z, then N lines: basis species x y z
//   columns N           ?   N lines: "name"
//   atoms N [ids]           N lines: x y z species [id] [one value for each column]
//   vertices N own|atoms [atoms]
//                           own: N lines x y z; atoms: the atoms' positions, no lines. A second `atoms` says that
//                           vertex i is atom i; without it each line ends with the atom's index or -
//   tetrahedra N [delaunay] N lines: a b c d
//   surface N [cells]       N lines: a b c [tetrahedron face]
//   defects N           ?   N lines: positional vacancy extra
//   vacancies N         ?   N lines: x y z species votes
//   extras N            ?   N lines: atom votes
//   substitutions N     ?   N lines: atom, the species expected in its place, index of the vacancy it fills
//   fields N            ?   N lines: "name"; then a line for each vertex: one value for each field
//   end
//
// Indices count from 0. Strings in quotes know \" \\ \n \t and \xHH. Versions 1 and 2 are still read: 2 has no fields,
// 1 no substitutions either.
#pragma once

#include "core/material_file.h"

namespace atomesh {

inline constexpr std::string_view crt_magic{"atomesh-crt"};
inline constexpr int crt_version = 3;
inline constexpr int crt_oldest_version = 1;

// `bytes` is the whole file, `path` its name in messages.
Material read_crt(std::string_view bytes, const std::string& path, const MaterialParts& parts, Progress& progress);
// The material must have no problem (find_problem).
void write_crt(const std::string& path, const Material& material, Progress& progress);

}  // namespace atomesh
