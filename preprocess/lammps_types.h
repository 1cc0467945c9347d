// What LAMMPS data and dump files share: types that become species, and atoms in any order that have ids. Internal to
// the readers.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "preprocess/read_formats.h"

namespace atomesh::reading {

struct TypeNames {
  std::map<std::string, std::string> labels;  // type → name, where the file has one
  std::map<std::string, double> masses;       // type → u
};

// The atoms' species are LAMMPS types as the file writes them ("1", or a label); gives them their names: those of the
// options, else the file's, else the element of that mass (unless every mass is 1: reduced units), else the type
// itself. Types of the same name become one species, and a column "type" keeps them apart. Throws UsageError when the
// options name fewer types than there are.
void name_types(const Input& input, const TypeNames& names, Atoms& atoms, ReadReport& report);

// Puts the atoms into ascending order of their ids. Throws InputError for an id that occurs twice; line_of says on
// which line the i-th atom stands (called for the message only).
void sort_by_id(const Input& input, Atoms& atoms, const std::function<std::uint64_t(std::size_t)>& line_of);

// Box vectors of LAMMPS: lower and upper bounds and the tilt factors xy, xz, yz.
Box box_from_bounds(const Vec3& low, const Vec3& high, const Vec3& tilt);

}  // namespace atomesh::reading
