// LAMMPS data and dump files.
#include <cmath>

#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

std::string frame_of(const std::string& bounds, const std::string& columns, const std::string& rows,
                     const std::string& count) {
  return "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n" + count + "\nITEM: BOX BOUNDS " + bounds + "ITEM: ATOMS " +
         columns + "\n" + rows;
}
const std::string cube = "pp ff pp\n0 10\n-10 10\n5 15\n";

TEST(ReadLammpsDump, ColumnsByName) {
  const ReadResult read = read_text(
      "a.dump", "ITEM: UNITS\nmetal\nITEM: TIME\n0.5\n" +
                    frame_of(cube, "c_e z type id y x tag xu", "0.5 3 2 7 2 1 abc 11\n0.25 6 1 4 5 4 de 14\n", "2"));
  const Atoms& atoms = read.atoms;
  EXPECT_EQ(read.report.format, "lammps-dump");
  EXPECT_EQ(atoms.ids, (std::vector<std::int64_t>{4, 7}));
  EXPECT_EQ(atoms.positions, (std::vector<Vec3>{{4, 5, 6}, {1, 2, 3}}));
  EXPECT_EQ(atoms.species_name(0), "1");
  EXPECT_EQ(atoms.species_name(1), "2");
  EXPECT_EQ(atoms.species_table[0].name, "1");
  ASSERT_EQ(atoms.columns.size(), 2u);
  EXPECT_EQ(atoms.find_column("c_e")->values, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(atoms.find_column("xu")->values, (std::vector<double>{14, 11}));
  EXPECT_EQ(atoms.box.origin, Vec3(0, -10, 5));
  EXPECT_EQ(atoms.box.vectors[1], Vec3(0, 20, 0));
  EXPECT_EQ(atoms.box.periodic, (std::array{true, false, true}));
  EXPECT_EQ(read.report.notes, (std::vector<std::string>{"Column tag is text; it is left out."}));
}

TEST(ReadLammpsDump, ScaledUnwrappedAndMixed) {
  for (const char* columns : {"xs ys zs", "xsu ysu zsu"}) {
    EXPECT_EQ(read_text("a.dump", frame_of(cube, columns, "0.5 0.25 1.5\n", "1")).atoms.positions[0], Vec3(5, -5, 20));
  }
  EXPECT_EQ(read_text("a.dump", frame_of(cube, "xu yu zu", "0.5 0.25 -9\n", "1")).atoms.positions[0],
            Vec3(0.5, 0.25, -9));
  EXPECT_EQ(read_text("a.dump", frame_of(cube, "x ys zu", "0.1 0.25 7\n", "1")).atoms.positions[0], Vec3(0.1, -5, 7));
}

TEST(ReadLammpsDump, TriclinicBoundsEncloseTheBox) {
  // lo = (0,0,0), lengths 10, 20, 30, tilts xy=-2, xz=3, yz=-4: bounds as LAMMPS writes them.
  const std::string bounds = "xy xz yz pp pp ff\n-2 13 -2\n-4 20 3\n0 30 -4\n";
  const Atoms atoms = read_text("a.dump", frame_of(bounds, "xs ys zs", "0.5 0.5 0.5\n0 0 0\n", "2")).atoms;
  EXPECT_EQ(atoms.box.origin, Vec3(0));
  EXPECT_EQ(atoms.box.vectors[0], Vec3(10, 0, 0));
  EXPECT_EQ(atoms.box.vectors[1], Vec3(-2, 20, 0));
  EXPECT_EQ(atoms.box.vectors[2], Vec3(3, -4, 30));
  EXPECT_EQ(atoms.positions[0], Vec3(5.5, 8, 15));
  EXPECT_EQ(atoms.box.periodic, (std::array{true, true, false}));
  const std::string general = "abc origin pp pp pp\n1 2 3 -1\n-2 1 0 -2\n0 0 4 -3\n";
  const Atoms turned = read_text("a.dump", frame_of(general, "xs ys zs", "1 1 0.5\n", "1")).atoms;
  EXPECT_EQ(turned.box.origin, Vec3(-1, -2, -3));
  EXPECT_EQ(turned.box.vectors[0], Vec3(1, 2, 3));
  EXPECT_EQ(turned.positions[0], Vec3(-2, 1, 2));
}

TEST(ReadLammpsDump, NamesOfSpecies) {
  const std::string rows = "2 1 28.0855 0 0 0\n1 2 72.64 1 0 0\n3 3 500 2 0 0\n";
  const std::string file = frame_of(cube, "id type mass x y z", rows, "3");
  const auto names = [](const Atoms& atoms) {
    std::string list;
    for (std::size_t i = 0; i < atoms.size(); ++i) list += atoms.species_name(i) + " ";
    return list;
  };
  EXPECT_EQ(names(read_text("a.dump", file).atoms), "Ge Si 3 ");
  ReadOptions options;
  options.type_names = {"Ga", "In", "As"};
  EXPECT_EQ(names(read_text("a.dump", file, options).atoms), "In Ga As ");
  options.type_names = {"Ga", "In"};
  EXPECT_THROW(read_text("a.dump", file, options), UsageError);
  const std::string elements = frame_of(cube, "element type x y z", "Ga 1 0 0 0\nAs 2 1 0 0\n", "2");
  EXPECT_EQ(names(read_text("a.dump", elements).atoms), "Ga As ");
  EXPECT_EQ(read_text("a.dump", elements).atoms.find_column("type")->values, (std::vector<double>{1, 2}));
  EXPECT_EQ(names(read_text("a.dump", elements, options).atoms), "Ga In ");
  // Masses of 1 are reduced units, not hydrogen.
  EXPECT_EQ(names(read_text("a.dump", frame_of(cube, "type mass x y z", "1 1 0 0 0\n2 1 1 0 0\n", "2")).atoms), "1 2 ");
}

TEST(ReadLammpsDump, Frames) {
  const std::string text = frame_of(cube, "x y z", "1 0 0\n", "1") + frame_of(cube, "x y z", "2 0 0\n3 0 0\n", "2") +
                           "Egb = 0.9\n" + frame_of(cube, "x y z", "4 0 0\n", "1");
  const auto frame = [&](long index) {
    ReadOptions options;
    options.frame = index;
    return read_text("a.dump", text, options);
  };
  EXPECT_EQ(frame(0).atoms.positions[0].x, 1.0);
  EXPECT_EQ(frame(1).atoms.size(), 2u);
  EXPECT_EQ(frame(-1).atoms.positions[0].x, 4.0);
  EXPECT_EQ(frame(-1).report.frames, 3u);
  EXPECT_EQ(frame(-1).report.skipped, 1u);
}

TEST(ReadLammpsDump, SaysWhatWasExpectedAndWhere) {
  const std::pair<std::string, const char*> cases[] = {
      {frame_of(cube, "id x y z", "1 0 0 0\n", "2"),
       "a.dump:10: expected 2 atoms as line 4 says, got 1 before the end"},
      {frame_of(cube, "id x y z", "1 0 0 0\n2 0 0 0\n", "1"), "a.dump:11: expected \"ITEM: TIMESTEP\""},
      {frame_of(cube, "element x y z", "C 0 0 0\nC 1 0 0\n", "1"), "a.dump:11: expected \"ITEM: TIMESTEP\""},
      {frame_of(cube, "xs ys zs", "0 0 0\n1e308 0 0\n", "2"), "a.dump:11: the position is beyond every number"},
      {frame_of(cube, "id x y z", "1 0 0 0\n", "2") + frame_of(cube, "id x y z", "1 0 0 0\n", "1"),
       "a.dump:11: expected 2 atoms as line 4 says, got 1 before the next ITEM"},
      {frame_of(cube, "id x y z", "1 0 0 0\n2 1 1 1\n1 2 2 2\n", "3"),
       "a.dump:12: atom id 1 stands on line 10 already"},
      {frame_of(cube, "id x y z", "1 0 0 0\n900 1 1 1\n1 2 2 2\n", "3"),
       "a.dump:12: atom id 1 stands on line 10 already"},
      {frame_of(cube, "id x y z", "1 0 nan 0\n", "1"), "a.dump:10: expected a finite number for y, got \"nan\""},
      {frame_of(cube, "id x y z e", "1 0 0 0 -inf\n", "1"), "a.dump:10: expected a finite number for e, got \"-inf\""},
      {frame_of(cube, "id x y z", "1 0 0\n", "1"),
       "a.dump:10: expected an atom with the fields of ITEM: ATOMS, got 3 fields"},
      {frame_of(cube, "id x y z", "1 0 0 0 0\n", "1"),
       "a.dump:10: expected an atom with the fields of ITEM: ATOMS, got 5 fields"},
      {frame_of(cube, "id x y", "1 0 0\n", "1"), "a.dump:9: expected a column z, zs, zu or zsu"},
      {frame_of(cube, "x y z x", "1 0 0 0\n", "1"), "a.dump:9: expected every column once, got \"x\" twice"},
      {frame_of(cube, "x y z", "1 0 0\n", "99999999999"), "a.dump:4: 99999999999 atoms are announced"},
      {frame_of(cube, "x y z", "1 0 0\n", "-1"), "a.dump:4: expected a number of atoms, got -1"},
      {frame_of(cube, "x y z", "", "0"), "a.dump: holds no atoms"},
      {frame_of("pp pp\n0 1\n0 1\n0 1\n", "x y z", "0 0 0\n", "1"), "a.dump:5: expected three boundary flags"},
      {frame_of("pp pp pp\n1 0\n0 1\n0 1\n", "x y z", "0 0 0\n", "1"), "a.dump:6: expected an upper bound not below"},
      {frame_of("pp pp pp\n0 0\n0 1\n0 1\n", "x y z", "0 0 0\n", "1"), "a.dump:5: the box has no volume"},
      {frame_of("ff ff ff\n0 0\n0 1\n0 1\n", "xs ys zs", "0 0 0\n", "1"), "a.dump:5: scaled coordinates need a box"},
      {frame_of("xy xz yz pp pp pp\n0 3 1\n0 1 1\n0 1 0\n", "x ys zs", "0 0 0\n", "1"),
       "a.dump:9: scaled and unscaled"},
      {frame_of("xy xz yz pp pp pp\n0 3\n0 1\n0 1\n", "x y z", "0 0 0\n", "1"),
       "a.dump:6: expected 3 numbers of the box"},
      {"ITEM: TIMESTEP\nx\n", "a.dump:2: expected a whole number for the timestep, got \"x\""},
      {"ITEM: TIMESTEP\n", "a.dump:1: expected the timestep, got the end of the file"},
      {"ITEM: TIMESTEP\n0\nITEM: ATOMS x y z\n0 0 0\n", "a.dump:3: expected ITEM: NUMBER OF ATOMS before ITEM: ATOMS"},
      {"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\n", "a.dump:3: expected \"ITEM: TIMESTEP\", NUMBER OF ATOMS"},
  };
  for (const auto& [content, message] : cases) {
    const std::string error = input_error("a.dump", content);
    EXPECT_TRUE(error.starts_with(message)) << "for\n" << content << "got: " << error;
  }
}

std::string data_of(const std::string& header, const std::string& sections) {
  return "title 12 atoms\n\n" + header + "\n" + sections;
}
const std::string bounds = "0 10 xlo xhi\n-5 5 ylo yhi\n0 4 zlo zhi\n";

TEST(ReadLammpsData, EveryStyleHasItsFields) {
  const std::pair<const char*, const char*> styles[] = {{"atomic", "5 2 1 2 3"},
                                                        {"charge", "5 2 -0.5 1 2 3"},
                                                        {"molecular", "5 9 2 1 2 3"},
                                                        {"bond", "5 9 2 1 2 3"},
                                                        {"angle", "5 9 2 1 2 3"},
                                                        {"full", "5 9 2 -0.5 1 2 3"},
                                                        {"sphere", "5 2 1.5 7.8 1 2 3"},
                                                        {"dipole", "5 2 -0.5 1 2 3 0 0 1"},
                                                        {"electron", "5 2 -0.5 1 0.3 1 2 3"},
                                                        {"ellipsoid", "5 2 1 7.8 1 2 3"},
                                                        {"line", "5 9 2 0 1.0 1 2 3"},
                                                        {"hybrid sphere bond", "5 2 1 2 3 1.5 7.8 1"}};
  for (const auto& [style, atom] : styles) {
    for (const char* images : {"", " 1 0 -1"}) {
      if (std::string_view(style).starts_with("hybrid") && *images != '\0') continue;
      const std::string section = "Atoms # " + std::string(style) + "\n\n" + atom + images + " # comment\n";
      const ReadResult read = read_text("a.data", data_of("1 atoms\n2 atom types\n" + bounds, section));
      ASSERT_EQ(read.atoms.size(), 1u);
      EXPECT_EQ(read.atoms.positions[0], Vec3(1, 2, 3)) << style;
      EXPECT_EQ(read.atoms.species_name(0), "2") << style;
      EXPECT_EQ(read.atoms.ids[0], 5) << style;
      const Column* charge = read.atoms.find_column("q");
      EXPECT_TRUE(charge == nullptr || charge->values[0] == -0.5);
    }
  }
}

TEST(ReadLammpsData, StyleToldByTheFields) {
  const std::pair<const char*, const char*> atoms[] = {{"1 2 1 2 3", ""},          {"1 2 1 2 3 0 0 1", ""},
                                                       {"1 9 2 1 2 3", "mol"},     {"1 2 0.5 1 2 3", "q"},
                                                       {"1 9 2 0.5 1 2 3", "mol"}, {"1 9 2 0.5 1 2 3 0 0 1", "mol"},
                                                       {"1 2 1.5 7.8 1 2 3", ""},  {"1 2 0.5 1 1.2 1.0 2.0 3.0", "q"}};
  for (const auto& [atom, column] : atoms) {
    const ReadResult read =
        read_text("a.data", data_of("1 atoms\n2 atom types\n" + bounds, "Atoms\n\n" + std::string(atom) + "\n"));
    EXPECT_EQ(read.atoms.positions[0], Vec3(1, 2, 3)) << atom;
    EXPECT_EQ(read.atoms.species_name(0), "2") << atom;
    EXPECT_EQ(*column == '\0', read.atoms.columns.empty()) << atom;
    if (*column != '\0') {
      EXPECT_NE(read.atoms.find_column(column), nullptr) << atom;
    }
    EXPECT_NE(read.report.notes[0].find("does not name its atom style"), std::string::npos);
  }
}

TEST(ReadLammpsData, SectionsInAnyOrder) {
  const std::string atoms = "Atoms # charge\n\n3 2 0.5 1 2 3\n# between\n1 1 -0.5 4 5 6\n\n";
  const std::string masses = "Masses\n\n1 28.0855\n2 72.64 # germanium\n\n";
  const std::string others = "Pair Coeffs # lj\n\n1 1.0 2.0\n2 1.0 2.0\n\nVelocities\n\n1 0 0 0\n3 0 0 0\n\n";
  for (const std::string& sections : {atoms + masses + others, others + masses + atoms, masses + others + atoms}) {
    const ReadResult read =
        read_text("a.lmp", data_of("2 atoms\n2 atom types\n7 bonds\n" + bounds + "1 2 -1 xy xz yz\n", sections));
    EXPECT_EQ(read.atoms.ids, (std::vector<std::int64_t>{1, 3}));
    EXPECT_EQ(read.atoms.positions[0], Vec3(4, 5, 6));
    EXPECT_EQ(read.atoms.species_name(0), "Si");
    EXPECT_EQ(read.atoms.species_name(1), "Ge");
    EXPECT_EQ(read.atoms.find_column("q")->values, (std::vector<double>{-0.5, 0.5}));
    EXPECT_EQ(read.atoms.box.origin, Vec3(0, -5, 0));
    EXPECT_EQ(read.atoms.box.vectors[2], Vec3(2, -1, 4));
    EXPECT_EQ(read.atoms.box.periodic, (std::array{true, true, true}));
    EXPECT_EQ(read.report.notes.back(), "Sections not used: Pair Coeffs, Velocities.");
  }
}

TEST(ReadLammpsData, NamesOfTypes) {
  const std::string header = "4 atoms\n4 atom types\n" + bounds;
  const std::string atoms = "Atoms # atomic\n\n1 1 0 0 0\n2 2 1 0 0\n3 3 2 0 0\n4 4 3 0 0\n";
  const auto names = [](const Atoms& a) {
    std::string list;
    for (std::size_t i = 0; i < a.size(); ++i) list += a.species_name(i) + " ";
    return list;
  };
  const std::string masses = "Masses\n\n1 12.011 # CT\n2 55 # Fe\n3 500 # Ow\n4 12.01\n\n";
  const ReadResult read = read_text("a.data", data_of(header, masses + atoms));
  EXPECT_EQ(names(read.atoms), "C Fe Ow C ");
  EXPECT_EQ(read.atoms.species_table.size(), 3u);
  EXPECT_EQ(read.atoms.find_column("type")->values, (std::vector<double>{1, 2, 3, 4}));
  const std::string labels = "Atom Type Labels\n\n1 Si\n2 Ge\n3 Ow\n4 Xe\n\n";
  EXPECT_EQ(names(read_text("a.data", data_of(header, labels + atoms)).atoms), "Si Ge Ow Xe ");
  const std::string labelled = "Atoms # atomic\n\n1 Ge 0 0 0\n2 Ow 1 0 0\n3 Ow 2 0 0\n4 Xe 3 0 0\n";
  EXPECT_EQ(names(read_text("a.data", data_of(header, labels + labelled)).atoms), "Ge Ow Ow Xe ");
  EXPECT_EQ(
      names(
          read_text("a.data", data_of(header, labels + "Masses\n\nSi 1\nGe 2\nOw 15.999\nXe 4\n\n" + labelled)).atoms),
      "Ge O O Xe ");
  const std::string general = "4 atoms\n4 atom types\n1 2 3 avec\n-2 1 0 bvec\n0 0 4 cvec\n-1 -2 -3 abc origin\n";
  const Atoms turned = read_text("a.data", data_of(general, atoms)).atoms;
  EXPECT_EQ(turned.box.vectors[1], Vec3(-2, 1, 0));
  EXPECT_EQ(turned.box.origin, Vec3(-1, -2, -3));
}

TEST(ReadLammpsData, SaysWhatWasExpectedAndWhere) {
  const std::string header = "2 atoms\n2 atom types\n" + bounds;  // lines 3 to 7
  const std::pair<std::string, const char*> cases[] = {
      {data_of(header, ""), "a.data:8: expected an Atoms section, got the end of the file"},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\n"),
       "a.data:11: expected 2 atoms as line 3 says, got 1 before the end"},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\n2 1 1 0 0\n3 1 2 0 0\n"),
       "a.data:13: expected the end of section Atoms"},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\nVelocities\n\n1 0 0 0\n"),
       "a.data:12: expected an atom of style atomic"},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\n\n1 1 1 0 0\n"), "a.data:13: atom id 1 stands on line 11 already"},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\n2 3 1 0 0\n"),
       "a.data:12: expected an atom type from 1 to 2, got \"3\""},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0\n2 1 1 0 inf\n"),
       "a.data:12: expected a finite number for z, got \"inf\""},
      {data_of(header, "Atoms # atomic\n\n1 1 0 0 0 7\n2 1 1 0 0 7\n"),
       "a.data:11: expected an atom of style atomic (id type x y z), got 6 fields"},
      {data_of(header, "Atoms # granular\n\n1 1 0 0 0\n2 1 1 0 0\n"),
       "a.data:9: expected an atom style of angle, atomic"},
      {data_of(header, "Atoms\n\n1 1 0 0\n2 1 1 0\n"), "a.data:11: expected the atom style behind \"Atoms\""},
      {data_of("99999999999 atoms\n1 atom types\n" + bounds, "Atoms\n"), "a.data:3: 99999999999 atoms are announced"},
      {data_of("0 atoms\n1 atom types\n" + bounds, ""), "a.data:3: expected at least one atom, got 0 atoms"},
      {data_of("2 atoms\n2 atom types\n5 0 xlo xhi\n", ""), "a.data:5: expected xhi not below xlo"},
      {data_of("2 atoms\n2 atom types\nx 0 xlo xhi\n", ""), "a.data:6: expected an Atoms section"},
      {data_of("2 atom types\n" + bounds, "Atoms\n\n1 1 0 0 0\n"),
       "a.data:8: expected \"N atoms\" in the header, got none"},
      {data_of(header, "Masses\n\n1 x\n2 1\n"), "a.data:11: expected a finite number for the mass, got \"x\""},
  };
  for (const auto& [content, message] : cases) {
    const std::string error = input_error("a.data", content);
    EXPECT_TRUE(error.starts_with(message)) << "for\n" << content << "got: " << error;
  }
}

}  // namespace
}  // namespace atomesh::test
