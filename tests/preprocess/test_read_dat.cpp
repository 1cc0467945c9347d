// The .dat grammar, what it refuses, and what every format shares: duplicates, formats told by content, bad files.
#include <cmath>

#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

constexpr const char* salt =
    "# rock salt, cut\n"
    "Na 0 0 0\n"
    "Cl 2.82 0 0 # beside it\n"
    "\n"
    "  primitive   # fcc\n"
    "0 2.82 2.82\n"
    "2.82 0 2.82# no blank before the comment\n"
    "# between the lines of a block\n"
    "2.82 2.82 0\n"
    "basis 2\n"
    "Na 0 0 0\n"
    "Cl 2.82 0 0\n"
    "radius Na 0.9\n"
    "box\n"
    "5.64 0 0 periodic\n"
    "0 5.64 0 open\n"
    "0 0 5.64 periodic\n"
    "origin -1 -2 -3\n"
    "Na 0 2.82 2.82#glued\n"
    "\t Xx1 +1e0\t.5 -0 \n";

TEST(ReadDat, EveryLineOfTheGrammar) {
  const ReadResult read = read_text("a.dat", salt);
  EXPECT_EQ(read.report.format, "dat");
  EXPECT_EQ(read.report.atoms, 4u);
  EXPECT_EQ(read.report.duplicates, 0u);
  EXPECT_EQ(read.report.skipped, 0u);
  EXPECT_EQ(read.report.bytes, std::string_view(salt).size());
  const Atoms& atoms = read.atoms;
  EXPECT_EQ(atoms.positions, (std::vector<Vec3>{{0, 0, 0}, {2.82, 0, 0}, {0, 2.82, 2.82}, {1, 0.5, 0}}));
  EXPECT_EQ(atoms.species, (std::vector<std::uint16_t>{0, 1, 0, 2}));
  EXPECT_EQ(atoms.species_name(3), "Xx1");
  EXPECT_EQ(atoms.species_table[0].radius, 0.9);
  EXPECT_EQ(atoms.species_table[1].radius, 1.02);
  EXPECT_EQ(atoms.species_table[2].radius, 1.0);
  EXPECT_EQ(atoms.box.origin, Vec3(-1, -2, -3));
  EXPECT_EQ(atoms.box.vectors[2], Vec3(0, 0, 5.64));
  EXPECT_EQ(atoms.box.periodic, (std::array{true, false, true}));
  ASSERT_TRUE(read.unit_cell.has_value());
  EXPECT_EQ(read.unit_cell->primitive[1], Vec3(2.82, 0, 2.82));
  ASSERT_EQ(read.unit_cell->basis.size(), 2u);
  EXPECT_EQ(read.unit_cell->basis[1].species, "Cl");
}

TEST(ReadDat, LineEndingsDoNotMatter) {
  std::string windows;
  for (const char c : std::string(salt)) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_same_atoms(read_text("a.dat", salt).atoms, read_text("a.dat", windows).atoms);
  std::string cut = salt;
  cut.pop_back();
  expect_same_atoms(read_text("a.dat", salt).atoms, read_text("a.dat", cut).atoms);
  EXPECT_EQ(read_text("a.dat", "C 1 2 3").atoms.size(), 1u);
}

TEST(ReadDat, SaysWhatWasExpectedAndWhere) {
  const std::pair<const char*, const char*> cases[] = {
      {"Na 0 0 0\nNa 1 2\n", "a.dat:2: expected \"species x y z\", got 3 fields"},
      {"Na 0 0 0\nNa 1 2 3 4\n", "a.dat:2: expected \"species x y z\", got 5 fields"},
      {"Na 0 0 0\nNa 1 2 # 3\n", "a.dat:2: expected \"species x y z\", got 3 fields"},
      {"Na 0 0 0\nNa 1 nan 2\n", "a.dat:2: expected a finite number for y, got \"nan\""},
      {"Na 0 0 0\nNa 1 2 -inf\n", "a.dat:2: expected a finite number for z, got \"-inf\""},
      {"Na 0 0 0\nNa 1e999 2 3\n", "a.dat:2: expected a finite number for x, got \"1e999\""},
      {"Na 0 0 0\nNa 1.0x 2 3\n", "a.dat:2: expected a finite number for x, got \"1.0x\""},
      {"primitive\n1 0 0\n0 1 0\n", "a.dat:3: expected a primitive vector \"x y z\", got the end of the file"},
      {"primitive\n1 0 0\n0 1 0\n0 0\n", "a.dat:4: expected a primitive vector \"x y z\", got 2 fields"},
      {"primitive 1 0 0\n", "a.dat:1: expected \"primitive\" alone on its line, got 4 fields"},
      {"Na 0 0 0\nbasis x\n", "a.dat:2: expected a whole number for N of \"basis N\", got \"x\""},
      {"Na 0 0 0\nbasis 0\n", "a.dat:2: expected at least 1 basis atom, got 0"},
      {"Na 0 0 0\nbasis 99999999999\nNa 0 0 0\n",
       "a.dat:2: 99999999999 basis atoms are announced; expected as many lines, but only 9 bytes follow"},
      {"basis 2\nNa 0 0 0\nbox\n\n", "a.dat:3: expected basis atom 2 of 2, \"species x y z\", got 1 field"},
      {"basis 1\nNa 0 0 0\n", "a.dat:1: expected a primitive block beside the basis block, got none"},
      {"primitive\n1 0 0\n0 1 0\n0 0 1\nNa 0 0 0\n",
       "a.dat:1: expected a basis block beside the primitive block, got none"},
      {"Na 0 0 0\nprimitive\n1 0 0\n0 1 0\n1 1 0\nbasis 1\nNa 0 0 0\n",
       "a.dat:2: unit cell: the three primitive vectors lie in one plane"},
      {"primitive\n1 0 0\n0 1 0\n0 0 1\nprimitive\n",
       "a.dat:5: expected one primitive block, got a second one (the first is on line 1)"},
      {"radius Na 0\nNa 0 0 0\n", "a.dat:1: expected a radius above 0, got 0"},
      {"radius Na\nNa 0 0 0\n", "a.dat:1: expected \"radius species r\", got 2 fields"},
      {"radius Na 1\nNa 0 0 0\nradius Na 1\n",
       "a.dat:3: expected one radius of Na, got a second one (the first is on line 1)"},
      {"box\n1 0 0 periodic\n0 1 0 maybe\n",
       "a.dat:3: expected a box vector \"x y z periodic\" or \"x y z open\", got \"maybe\""},
      {"box\n1 0 0 periodic\n0 1 0 open\n1 1 0 open\nNa 0 0 0\n",
       "a.dat:1: the box has no volume; expected three independent vectors"},
      {"Na 0 0 0\norigin 1 2 3\n", "a.dat:2: expected \"origin\" only right after the three vectors of a box block"},
      {"# nothing\n\n", "a.dat: holds no atoms; expected at least one"},
      {"primitive\n1 0 0\n0 1 0\n0 0 1\nbasis 1\nNa 0 0 0\n", "a.dat: holds no atoms; expected at least one"},
  };
  for (const auto& [content, message] : cases) {
    const std::string error = input_error("a.dat", content);
    EXPECT_TRUE(error.starts_with(message)) << "for\n" << content << "got: " << error;
  }
}

TEST(ReadDat, UnitCellAlone) {
  const TemporaryFolder folder;
  const std::string cell = "primitive\n1 0 0\n0 1 0\n0 0 1\nbasis 1\nNa 0 0 0\n";
  EXPECT_EQ(read_unit_cell(folder.file("cell.dat", cell)).basis.size(), 1u);
  EXPECT_EQ(read_unit_cell(folder.file("salt.dat", salt)).basis.size(), 2u);
  EXPECT_THROW(read_unit_cell(folder.file("none.dat", "Na 0 0 0\n")), InputError);
  EXPECT_THROW(read_unit_cell(folder.file("missing.dat")), InputError);
}

TEST(ReadAtoms, ExactDuplicatesAreDroppedAndCounted) {
  // The same place with another species, or a place one bit away, is another atom; -0 is 0.
  const double next = std::nextafter(1.0, 2.0);
  char line[64];
  std::snprintf(line, sizeof line, "Na %.17g 0 0\n", next);
  const ReadResult read =
      read_text("a.dat", "Na 1 0 0\nCl 1 0 0\nNa 1 -0 0\nNa 1.0 0 0e5\n" + std::string(line) + "Cl 1 0 0\n");
  EXPECT_EQ(read.report.duplicates, 3u);
  EXPECT_EQ(read.report.atoms, 3u);
  EXPECT_EQ(read.atoms.positions, (std::vector<Vec3>{{1, 0, 0}, {1, 0, 0}, {next, 0, 0}}));
  EXPECT_EQ(read.atoms.species, (std::vector<std::uint16_t>{0, 1, 0}));
  EXPECT_EQ(read.report.notes.size(), 1u);
  // Ids and columns go with their atoms.
  const Atoms xyz = read_text("a.xyz",
                              "3\nProperties=species:S:1:pos:R:3:id:I:1:e:R:1\n"
                              "C 0 0 0 7 0.5\nC 0 0 0 8 0.6\nC 0 0 1 9 0.7\n")
                        .atoms;
  EXPECT_EQ(xyz.ids, (std::vector<std::int64_t>{7, 9}));
  EXPECT_EQ(xyz.columns[0].values, (std::vector<double>{0.5, 0.7}));
}

TEST(ReadAtoms, ManyDuplicates) {
  std::string text;
  for (int i = 0; i < 30000; ++i) text += "C " + std::to_string(i * 7919 % 10007) + " 0 0\n";
  const ReadResult read = read_text("a.dat", text);
  EXPECT_EQ(read.report.atoms, 10007u);
  EXPECT_EQ(read.report.duplicates, 30000u - 10007u);
  for (std::size_t i = 0; i < read.atoms.size(); ++i) {
    ASSERT_EQ(read.atoms.positions[i].x, static_cast<double>(i * 7919 % 10007));
  }
}

TEST(ReadAtoms, TheFormatIsToldByContentThenByName) {
  const char* xyz = "1\n\nC 0 0 0\n";
  const char* dump =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS x y z\n0 0 "
      "0\n";
  const char* data = "title\n\n1 atoms\n1 atom types\n0 1 xlo xhi\n\nAtoms # atomic\n\n1 1 0 0 0\n";
  for (const char* name : {"a", "a.txt", "a.xyz", "a.dat", "a.DUMP", "a.lammps"}) {
    EXPECT_EQ(read_text(name, xyz).report.format, "xyz") << name;
    EXPECT_EQ(read_text(name, dump).report.format, "lammps-dump") << name;
    EXPECT_EQ(read_text(name, data).report.format, "lammps-data") << name;
    EXPECT_EQ(read_text(name, salt).report.format, "dat") << name;
  }
  ReadOptions options;
  options.format = "dat";
  EXPECT_NE(input_error("a.xyz", xyz, options), "");
  options.format = "dta";
  try {
    read_text("a.xyz", xyz, options);
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean dat?"), std::string::npos) << error.what();
  }
  // Numbers alone are atoms only where the name says so.
  EXPECT_EQ(read_text("a.dat", "1 0 0 0\n2 1 0 0\n").atoms.species_name(1), "2");
  EXPECT_NE(input_error("a.node", "1 0 0 0\n2 1 0 0\n"), "");
  // Nothing to tell it by: the name decides whose error is shown.
  EXPECT_EQ(input_error("a.xyz", "one\n"), "a.xyz:1: expected the number of atoms of a frame, got \"one\"");
  EXPECT_EQ(input_error("a.dat", "one\n"), "a.dat:1: expected \"species x y z\", got 1 field");
}

TEST(ReadAtoms, WhatIsNoFileOfAtoms) {
  EXPECT_EQ(input_error("a.dat", ""), "a.dat: is empty; expected atoms");
  EXPECT_EQ(input_error("a.dat", "\x1f\x8b\x08 etc"),
            "a.dat: is compressed (gzip); expected text: uncompress it first");
  EXPECT_TRUE(input_error("a.xyz", std::string_view("\x7f"
                                                    "ELF\0\0\0",
                                                    7))
                  .starts_with("a.xyz: is a binary file"));
  EXPECT_TRUE(input_error("a.cif", "data_NaCl\n").starts_with("a.cif: is in no format that is read"));
  const TemporaryFolder folder;
  EXPECT_THROW(read_atoms(folder.path().string()), InputError);
  EXPECT_THROW(read_atoms(folder.file("missing.dat")), InputError);
}

TEST(ReadAtoms, CanBeCancelled) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.dat", salt);
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(read_atoms(file, {}, progress), CancelledError);
}

TEST(ReadAtoms, AFrameThatIsNotThereIsWrongUse) {
  ReadOptions options;
  options.frame = 1;
  EXPECT_THROW(read_text("a.dat", salt, options), UsageError);
  EXPECT_THROW(read_text("a.xyz", "1\n\nC 0 0 0\n", options), UsageError);
  options.frame = -2;
  EXPECT_THROW(read_text("a.xyz", "1\n\nC 0 0 0\n", options), UsageError);
}

TEST(ReadAtoms, RefusesWhatLiesBeyondAnySample) {
  try {
    read_text("a.dat", "Na 0 0 0\nCl 0 -1e300 0\n");
    FAIL() << "was read";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("atom 2 has y -1e+300"), std::string::npos) << what;
  }
  EXPECT_EQ(read_text("a.dat", "Na 1e9 0 0\nCl 0 -1e9 0\n").atoms.size(), 2u);
}

}  // namespace
}  // namespace atomesh::test
