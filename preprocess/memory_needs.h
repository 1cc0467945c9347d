// How much memory each stage is going to take, told from counts before it begins: what would not fit is refused
// instead of suffered.
//
// All figures are bytes at the stage's peak beyond what is held when it begins, its result included. The constants in
// memory_needs.cpp were measured (`atomesh preprocess` reports the peak of every stage) on rock salt and on strained
// copper of 200,000 and 1,000,000 atoms and rounded up; test_memory_needs.cpp holds them against what the stages take.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace atomesh {

// Atoms with `columns` numbers each beside position and species, the search for duplicates included. `sorted`: the
// reader puts them in another order (LAMMPS, by id).
std::uint64_t memory_to_read(std::uint64_t atoms, std::uint64_t columns, bool sorted);
// The Delaunay adapters, "delaunay" (CGAL) or "tetgen", with the passes over their tetrahedra that follow, about 6.8
// tetrahedra a point; or "pattern", labels and stamping, where little is left to CGAL.
std::uint64_t memory_to_mesh(std::string_view mesher, std::uint64_t points);
std::uint64_t memory_to_carve(std::uint64_t vertices, std::uint64_t tetrahedra);
std::uint64_t memory_to_extract_surface(std::uint64_t vertices, std::uint64_t tetrahedra);
// Of a mesh most of whose vertices may go.
std::uint64_t memory_to_simplify(std::uint64_t vertices, std::uint64_t tetrahedra);
// A neighbourhood as the default one, of a sample that mostly fits its cell.
std::uint64_t memory_to_quantify_defects(std::uint64_t atoms);

// Throws UnavailableError when `bytes` are more than can be had: "tetrahedralize of 10,000,000 atoms needs about …".
// What is below 64 MB is not asked for.
void require_memory_for(std::string_view stage, std::uint64_t count, std::string_view noun, std::uint64_t bytes);

// What a person can do about too little memory, as the end of a sentence.
std::string memory_advice();

}  // namespace atomesh
