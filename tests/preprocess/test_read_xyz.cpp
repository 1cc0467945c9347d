// XYZ and extended XYZ.
#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

TEST(ReadXyz, PlainFileWithMoreFieldsThanAreNamed) {
  const ReadResult read = read_text("a.xyz", "2\njust prose: x = nothing\nNa 1 2 3 0.1 0.2\n  Cl 4 5 6\n\n");
  EXPECT_EQ(read.report.format, "xyz");
  EXPECT_EQ(read.atoms.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(read.atoms.species_name(1), "Cl");
  EXPECT_FALSE(read.atoms.box.present());
  ASSERT_EQ(read.report.notes.size(), 1u);
  EXPECT_NE(read.report.notes[0].find("left out"), std::string::npos);
}

TEST(ReadXyz, ExtendedComment) {
  for (const char* comment : {
           "Lattice=\"4 0 0 1 5 0 0 0 6\" Properties=pos:R:3:id:I:1:species:S:1:velo:R:2:fixed:L:1:n:I:1:tag:S:1 "
           "pbc=\"T F T\" Origin=\"-1 -2 -3\" energy=-1.5",
           "lattice = '4 0 0 1 5 0 0 0 6' flag PBC={True false 1} key=\"a \\\" b\" Origin=\"-1 -2 -3\" "
           "Properties=\"pos:R:3:id:I:1:species:S:1:velo:R:2:fixed:L:1:n:I:1:tag:S:1\"",
       }) {
    const ReadResult read =
        read_text("a.xyz", "2\n" + std::string(comment) + "\n1 2 3 9 Na 0.1 0.2 T 5 a\n4 5 6 8 Cl 0.3 0.4 F 6 b\n");
    EXPECT_EQ(read.report.format, "extxyz");
    const Atoms& atoms = read.atoms;
    EXPECT_EQ(atoms.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(atoms.species_name(0), "Na");
    EXPECT_EQ(atoms.ids, (std::vector<std::int64_t>{9, 8}));
    EXPECT_EQ(atoms.box.vectors[1], Vec3(1, 5, 0));
    EXPECT_EQ(atoms.box.origin, Vec3(-1, -2, -3));
    EXPECT_EQ(atoms.box.periodic, (std::array{true, false, true}));
    ASSERT_EQ(atoms.columns.size(), 4u);
    EXPECT_EQ(atoms.find_column("velo_2")->values, (std::vector<double>{0.2, 0.4}));
    EXPECT_EQ(atoms.find_column("fixed")->values, (std::vector<double>{1, 0}));
    EXPECT_EQ(atoms.find_column("n")->values, (std::vector<double>{5, 6}));
    EXPECT_EQ(read.report.notes, (std::vector<std::string>{"Property tag is text; it is left out."}));
  }
}

TEST(ReadXyz, LatticeWithoutPbcIsPeriodic) {
  const Atoms atoms = read_text("a.xyz", "1\nLattice=\"1 0 0 0 1 0 0 0 1\"\nC 0 0 0\n").atoms;
  EXPECT_EQ(atoms.box.periodic, (std::array{true, true, true}));
  // An open box without volume says nothing and is dropped, a periodic one is an error.
  const ReadResult flat = read_text("a.xyz", "1\nLattice=\"1 0 0 0 1 0 0 0 0\" pbc=\"F F F\"\nC 0 0 0\n");
  EXPECT_FALSE(flat.atoms.box.present());
  EXPECT_EQ(flat.report.notes.size(), 1u);
  EXPECT_EQ(input_error("a.xyz", "1\nLattice=\"1 0 0 0 1 0 1 1 0\"\nC 0 0 0\n"),
            "a.xyz:2: the box has no volume; expected three independent vectors of finite length");
}

TEST(ReadXyz, Frames) {
  const std::string text = "1\na\nC 0 0 0\n\n2\nb\nN 1 0 0\nN 2 0 0\n1\nc\nO 3 0 0";
  const auto frame = [&](long index) {
    ReadOptions options;
    options.frame = index;
    return read_text("a.xyz", text, options);
  };
  EXPECT_EQ(frame(0).atoms.species_name(0), "C");
  EXPECT_EQ(frame(1).atoms.size(), 2u);
  EXPECT_EQ(frame(2).atoms.species_name(0), "O");
  EXPECT_EQ(frame(-1).atoms.species_name(0), "O");
  EXPECT_EQ(frame(-1).report.frame, 2u);
  EXPECT_EQ(frame(0).report.frames, 3u);
}

TEST(ReadXyz, ADamagedEndSparesTheFramesBefore) {
  const std::string text = "1\na\nC 0 0 0\n3\nb\nN 1 0 0\n";
  EXPECT_EQ(input_error("a.xyz", text),
            "a.xyz:6: expected 3 atoms after the count on line 4, got 1 before the end of the file");
  ReadOptions options;
  options.frame = 0;
  const ReadResult read = read_text("a.xyz", text, options);
  EXPECT_EQ(read.atoms.species_name(0), "C");
  ASSERT_EQ(read.report.notes.size(), 1u);
  EXPECT_NE(read.report.notes[0].find("a.xyz:6"), std::string::npos);
  options.frame = 1;
  EXPECT_NE(input_error("a.xyz", text, options), "");
}

TEST(ReadXyz, SaysWhatWasExpectedAndWhere) {
  const std::string properties = "2\nProperties=species:S:1:pos:R:3";
  const std::pair<std::string, const char*> cases[] = {
      {"2\n\nC 0 0 0\n", "a.xyz:3: expected 2 atoms after the count on line 1, got 1 before the end of the file"},
      {"1\n\nC 0 0 0\nC 0 0 1\n", "a.xyz:4: expected the number of atoms of a frame, got \"C 0 0 1\""},
      {"-3\n\nC 0 0 0\n", "a.xyz:1: expected a number of atoms, got -3"},
      {"99999999999\n\nC 0 0 0\n",
       "a.xyz:1: 99999999999 atoms are announced; expected as many lines, but only 9 bytes follow"},
      {"99999999999999999999\n\nC 0 0 0\n", "a.xyz:1: expected the number of atoms of a frame"},
      {"0\n\n", "a.xyz: holds no atoms"},
      {"1", "a.xyz:1: expected 1 atom after the count on line 1, got 0 before the end of the file"},
      {"1\n\nC 0 0\n      \n", "a.xyz:3: expected \"species x y z\", got 3 fields"},
      {"2\n\nC 0 0 0\n\nC 0 0 0\n", "a.xyz:5: expected the number of atoms of a frame, got \"C 0 0 0\""},
      {"1\n\nC 0 inf 0\n", "a.xyz:3: expected a finite number for y, got \"inf\""},
      {properties + ":e:R:1\nC 0 0 0 1\nC 0 0 0\n",
       "a.xyz:4: expected an atom with the fields of Properties, got 4 fields"},
      {properties + "\nC 0 0 0\nC 0 0 0 1\n", "a.xyz:4: expected an atom with the fields of Properties, got 5 fields"},
      {properties + ":e:R:1\nC 0 0 0 1\nC 0 0 1 nan\n", "a.xyz:4: expected a finite number for e, got \"nan\""},
      {properties + ":e:R:1:e:R:1\nC 0 0 0 1 1\nC 0 0 1 1 1\n", "a.xyz:2: expected every column once"},
      {properties + ":f:L:1\nC 0 0 0 T\nC 0 0 1 maybe\n", "a.xyz:4: expected T or F for f, got \"maybe\""},
      {properties + ":id:I:1\nC 0 0 0 1\nC 0 0 1 1.5\n", "a.xyz:4: expected a whole number for id, got \"1.5\""},
      {properties + ":e:R\nC 0 0 0 1\nC 0 0 0 2\n", "a.xyz:2: expected Properties as name:type:count three by three"},
      {properties + ":e:R:9999999\nC 0 0 0 1\nC 0 0 0 2\n", "a.xyz:2: expected a count from 1 to 1000"},
      {"1\nProperties=pos:R:3\n0 0 0 0\n", "a.xyz:2: expected species:S:1 in Properties, got no species"},
      {"1\nProperties=species:S:1:e:R:3\nC 0 0 0\n", "a.xyz:2: expected pos:R:3 in Properties, got no pos"},
      {"1\nProperties=species:S:1:pos:R:2\nC 0 0 0\n", "a.xyz:2: expected pos:R:3, got \"pos:R:2\""},
      {"1\nLattice=\"1 0 0 0 1 0 0 0\"\nC 0 0 0\n", "a.xyz:2: expected 9 numbers in Lattice, got 8"},
      {"1\nLattice=\"1 0 0 0 1 0 0 0 x\"\nC 0 0 0\n", "a.xyz:2: expected a finite number for Lattice, got \"x\""},
      {"1\nLattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T F\"\nC 0 0 0\n", "a.xyz:2: expected pbc="},
  };
  for (const auto& [content, message] : cases) {
    const std::string error = input_error("a.xyz", content);
    EXPECT_TRUE(error.starts_with(message)) << "for\n" << content << "got: " << error;
  }
}

}  // namespace
}  // namespace atomesh::test
