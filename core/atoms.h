// Atoms as they were read: positions, species, the box they live in and whatever columns the file had.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

// The region that holds the atoms: origin + a·vectors[0] + b·vectors[1] + c·vectors[2] with a, b, c in [0,1).
// A file without a box has vectors of zero and no periodic axis (Box::present() is false).
struct Box {
  Vec3 origin{0.0};
  std::array<Vec3, 3> vectors{Vec3(0.0), Vec3(0.0), Vec3(0.0)};
  std::array<bool, 3> periodic{false, false, false};

  bool present() const { return vectors[0] != Vec3(0.0) || vectors[1] != Vec3(0.0) || vectors[2] != Vec3(0.0); }
  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  // Columns are the three vectors.
  Mat3 matrix() const { return Mat3(vectors[0], vectors[1], vectors[2]); }
  double volume() const { return glm::determinant(matrix()); }
};

struct Species {
  std::string name;     // element symbol, or any name without blanks ("1", "Ow")
  double radius = 0.0;  // Å, of the atom ball; from the file, else default_species_radius(name)
};

// A named per-atom number from the file (an XYZ property, a dump column).
struct Column {
  std::string name;
  std::vector<double> values;  // one per atom
};

struct Atoms {
  std::vector<Vec3> positions;         // Å
  std::vector<std::uint16_t> species;  // index into species_table, one per atom
  std::vector<std::int64_t> ids;       // the file's own ids, one per atom; empty when it has none
  std::vector<Species> species_table;  // no two of the same name
  std::vector<Column> columns;
  Box box;

  std::size_t size() const { return positions.size(); }
  const std::string& species_name(std::size_t atom) const { return species_table[species[atom]].name; }
  // Index of the species with this name, added with the default radius when it is new. Throws Error past 65,535
  // species.
  std::uint16_t add_species(std::string_view name);
  // nullptr when there is no such column.
  const Column* find_column(std::string_view name) const;
  // The atoms kept[0], kept[1], … in that order, with their columns and ids; table and box unchanged.
  Atoms subset(const std::vector<Index>& kept) const;
};

// What a reader did with its file; nothing is dropped silently.
struct ReadReport {
  std::string format;          // "dat", "xyz", "extxyz", "lammps-data", "lammps-dump"
  std::size_t atoms = 0;       // kept
  std::size_t skipped = 0;     // lines (atoms) of the file that were not used, each explained by a note
  std::size_t duplicates = 0;  // atoms dropped because species and position equal an earlier atom's exactly
  std::size_t frames = 1;      // frames in the file
  std::size_t frame = 0;       // the one read, from 0
  std::uint64_t bytes = 0;
  std::string hash;                // of the file's content, see content_hash.h
  std::vector<std::string> notes;  // one sentence each, for a person
};

}  // namespace atomesh
