// What is written reads back to the same bits.
#include <cmath>
#include <limits>
#include <random>

#include "preprocess/write_atoms.h"
#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

// Numbers that rounding to a fixed count of digits would lose.
Atoms hard_atoms() {
  Atoms atoms;
  for (const char* name : {"Si", "1", "Ow", "a-very-long-species-name"}) atoms.add_species(name);
  atoms.species_table[0].radius = 0.1 + 0.2;
  atoms.species_table[3].radius = 7.5;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-40, 33);
  for (int i = 0; i < 2000; ++i) {
    const auto number = [&] { return std::ldexp(mantissa(random), exponent(random)); };
    atoms.positions.push_back({number(), number(), number()});
    atoms.species.push_back(static_cast<std::uint16_t>(i % 7 % 4));
    atoms.ids.push_back(std::int64_t{1} << (i % 63));
  }
  atoms.positions[0] = {-0.0, std::numeric_limits<double>::denorm_min(), std::nextafter(1e10, 0.0)};
  atoms.positions[1] = {1e6 + 1.0 / 3.0, -1e-300, std::numeric_limits<double>::min()};
  atoms.box = {
      {-0.1, 1.0 / 3.0, 1e-9}, {Vec3(10.1, 0, 0), Vec3(1.0 / 7.0, 9, 0), Vec3(-2, 3, 1e3)}, {true, false, true}};
  return atoms;
}

UnitCell hard_cell() {
  return {{Vec3(0, 2.7155, 2.7155), Vec3(2.7155, 0, 2.7155), Vec3(1.0 / 3.0, 2.7155, 0)},
          {{"Si", {0, -0.0, 0}}, {"Si", {0.1 + 0.2, 1.35775, 1.35775}}}};
}

TEST(WriteAtoms, DatReadsBackToTheSameBits) {
  const TemporaryFolder folder;
  const Atoms atoms = hard_atoms();
  const UnitCell cell = hard_cell();
  write_atoms(folder.file("a.dat"), atoms, cell);
  const ReadResult read = read_atoms(folder.file("a.dat"));
  EXPECT_EQ(read.report.format, "dat");
  expect_same_atoms(atoms, read.atoms);
  EXPECT_EQ(atoms.species, read.atoms.species);
  ASSERT_EQ(atoms.species_table.size(), read.atoms.species_table.size());
  for (std::size_t s = 0; s < atoms.species_table.size(); ++s) {
    EXPECT_EQ(atoms.species_table[s].name, read.atoms.species_table[s].name);
    EXPECT_TRUE(same_bits(atoms.species_table[s].radius, read.atoms.species_table[s].radius));
  }
  ASSERT_TRUE(read.unit_cell.has_value());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(cell.primitive[k], read.unit_cell->primitive[k]));
  ASSERT_EQ(cell.basis.size(), read.unit_cell->basis.size());
  for (std::size_t b = 0; b < cell.basis.size(); ++b) {
    EXPECT_EQ(cell.basis[b].species, read.unit_cell->basis[b].species);
    EXPECT_TRUE(same_bits(cell.basis[b].position, read.unit_cell->basis[b].position));
  }
}

TEST(WriteAtoms, XyzReadsBackToTheSameBits) {
  const TemporaryFolder folder;
  Atoms atoms = hard_atoms();
  for (const char* name : {"c_stress[1]", "velo_1", "energy"}) {
    Column column{name, {}};
    for (std::size_t i = 0; i < atoms.size(); ++i) column.values.push_back(atoms.positions[i].x / 3.0);
    atoms.columns.push_back(column);
  }
  write_atoms(folder.file("a.xyz"), atoms);
  const ReadResult read = read_atoms(folder.file("a.xyz"));
  EXPECT_EQ(read.report.format, "extxyz");
  expect_same_atoms(atoms, read.atoms);
  EXPECT_EQ(atoms.ids, read.atoms.ids);
  ASSERT_EQ(atoms.columns.size(), read.atoms.columns.size());
  for (std::size_t c = 0; c < atoms.columns.size(); ++c) {
    EXPECT_EQ(atoms.columns[c].name, read.atoms.columns[c].name);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      ASSERT_TRUE(same_bits(atoms.columns[c].values[i], read.atoms.columns[c].values[i]));
    }
  }
}

TEST(WriteAtoms, WithoutBoxCellAndColumns) {
  const TemporaryFolder folder;
  Atoms atoms = hard_atoms();
  atoms.box = Box{};
  atoms.ids.clear();
  for (const char* name : {"a.dat", "a.xyz"}) {
    write_atoms(folder.file(name), atoms);
    const ReadResult read = read_atoms(folder.file(name));
    expect_same_atoms(atoms, read.atoms);
    EXPECT_FALSE(read.atoms.box.present());
    EXPECT_FALSE(read.unit_cell.has_value());
    EXPECT_TRUE(read.atoms.ids.empty());
    EXPECT_TRUE(read.atoms.columns.empty());
  }
}

TEST(WriteAtoms, RefusesWhatCouldNotBeReadBackAndLeavesNoFile) {
  const TemporaryFolder folder;
  Atoms atoms = hard_atoms();
  EXPECT_THROW(write_atoms(folder.file("a.cif"), atoms), UsageError);
  EXPECT_THROW(write_atoms(folder.file("a.dat"), Atoms{}), Error);
  for (const char* name : {"box", "origin", "a b", "#1", ""}) {
    Atoms named = atoms;
    named.species_table[1].name = name;
    EXPECT_THROW(write_atoms(folder.file("a.dat"), named), Error) << name;
  }
  Atoms column = atoms;
  column.columns.push_back({"a:b", std::vector<double>(atoms.size(), 0.0)});
  EXPECT_THROW(write_atoms(folder.file("a.xyz"), column), Error);
  atoms.positions[5].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_atoms(folder.file("a.dat"), atoms), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteAtoms, CancellingKeepsTheOldFile) {
  const TemporaryFolder folder;
  folder.file("a.dat", "old");
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(write_atoms(folder.file("a.dat"), hard_atoms(), {}, progress), CancelledError);
  EXPECT_EQ(read_bytes(folder.file("a.dat")), "old");
}

}  // namespace
}  // namespace atomesh::test
