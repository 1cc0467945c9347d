// Real files of other people (see INDEX.md beside them): what is in each was counted independently.
#include <cstdio>

#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

struct Expected {
  const char* file;
  const char* format;
  std::size_t atoms;
  const char* species;   // names in the order of the table
  const char* periodic;  // "TTF"; "-" for no box
  const char* columns = "";
  std::size_t frames = 1;
  std::size_t duplicates = 0;
};

const Expected readable[] = {
    {"atoms/atomman__fcc_Al_base.dump", "lammps-dump", 32640, "1", "TTT", "q"},
    {"atoms/atomman__fcc_Al_disl.dump", "lammps-dump", 32640, "1 2", "TFF", "c_peatom"},
    {"atoms/cascades__w_cascadesdb_sand_200000_004-fpos-200-17.xyz", "lammps-dump", 1748, "0 74", "TTT"},
    {"atoms/csaransh__data_lammps_Pos1.xyz", "lammps-dump", 2000, "1", "TTT"},
    {"atoms/dissolve__argon100000.xyz", "xyz", 100000, "Ar", "-"},
    {"atoms/gravelle__graphite.data", "lammps-data", 1000, "C", "TTT", "mol q"},
    {"atoms/grip__Cu_210_tilt_lammps_0.936_0.455_0.97_1.76_1_11_900_1000", "lammps-dump", 1924, "1", "TTF", "c_eng"},
    {"atoms/grip__Cu_210_tilt_lammps_0.953_0.857_1.18_2.59_2_7_500_12000", "lammps-dump", 2460, "1", "TTF", "c_eng"},
    {"atoms/grip__Si_310_twist_lammps_1.081_0.20_2.91_2.38_1_2_1400_100000", "lammps-dump", 544, "1", "TTF", "c_eng"},
    {"atoms/grip__Ti_2130_tilt_lammps_0.462_0.000_2.51_0.59_2_1_500_7000", "lammps-dump", 292, "1", "TTF", "c_eng"},
    {"atoms/grip__W_310_twist_lammps_2.297_0.200_0.59_0.60_1_1_1100_3000", "lammps-dump", 472, "1", "TTF", "c_eng"},
    {"atoms/grip__W_552_tilt_Marinica_2013_lammps_2.731_0.571_0.71_0.80_2_7_1600_88000", "lammps-dump", 3298, "1",
     "TTF", "c_eng"},
    {"atoms/grip__W_552_tilt_Marinica_2013_lammps_2.732_0.571_6.41_1.31_2_7_2200_66000", "lammps-dump", 3298, "1",
     "TTF", "c_eng"},
    {"atoms/grip__W_552_tilt_Marinica_2013_lammps_2.734_0.600_5.70_3.35_2_5_1400_113000", "lammps-dump", 2356, "1",
     "TTF", "c_eng"},
    {"atoms/grip__W_552_tilt_Marinica_2013_lammps_2.736_0.500_1.94_3.91_1_6_1900_166000", "lammps-dump", 1413, "1",
     "TTF", "c_eng"},
    {"atoms/grip__W_552_tilt_Marinica_2013_lammps_3.047_0.000_1.37_1.49_1_1_1700_0", "lammps-dump", 236, "1", "TTF",
     "c_eng"},
    {"atoms/grip__W_552_tilt_Zhou_2004_lammps_2.467_0.33_4.38_0.05_3_3_1900_154000", "lammps-dump", 1470, "1", "TTF",
     "c_eng"},
    {"atoms/grip__W_552_tilt_Zhou_2004_lammps_2.869_0.00_2.40_0.03_1_1_2700_0", "lammps-dump", 164, "1", "TTF",
     "c_eng"},
    {"atoms/lammps__SiC_bulk_data.SiC", "lammps-data", 5000, "Si C H", "TTT", "q", 1, 2000},  // pairs of electrons
    {"atoms/lammps_amorphous_Si.xyz", "xyz", 10648, "Si", "-"},
    {"atoms/pyscal__conf.bcc", "lammps-dump", 3456, "Mo", "TTT", "mass vx vy vz"},
    {"atoms/pyscal__conf.fcc.dump", "lammps-dump", 1008, "Mo", "TTT", "mass vx vy vz"},
    {"atoms/qdlib__In1242Zn29As1108Cl460_HLE17_48ang_OPT.xyz", "xyz", 2839, "In As Cl Zn", "-"},
    {"atoms/quip__quartz_crack.xyz", "extxyz", 4320, "O Si", "TTT", "*"},
    {"odd/chemfiles__lammps-data_molid.lmp", "lammps-data", 12, "1", "TTT", "mol q"},
    {"odd/chemfiles__lammps-data_whitespaces.lmp", "lammps-data", 1, "1", "TTT", "mol q"},
    {"odd/chemfiles__lammps_nacl.lammpstrj", "lammps-dump", 512, "1", "TTT", "vx vy vz", 6},
    {"odd/chemfiles__lammps_properties.lammpstrj", "lammps-dump", 4000, "1", "TTT", "*", 4},
    {"odd/chemfiles__xyz_helium.xyz", "xyz", 125, "He", "-", "", 397},
    {"odd/chemfiles__xyz_methane.xyz", "xyz", 5, "C H", "-"},
    {"odd/chemfiles__xyz_trajectory.xyz", "xyz", 9, "He", "-", "", 2},
    {"odd/lammps__oxDNA2_duplex2_data.duplex2", "lammps-data", 16, "1 2 3 4", "TTT"},
};

struct Refused {
  const char* file;
  long frame;
  const char* message;  // after the path
};

const Refused unreadable[] = {
    {"odd/pyscal__conf.fcc", -1, ":6919: expected 6912 atoms as line 4 says, got 6910 before the end of the file"},
    {"odd/pyscal__conf.triclinic.dump", -1,
     ":391: expected 384 atoms as line 4 says, got 382 before the end of the file"},
    {"odd/chemfiles__lammps-data_triclinic-1.lmp", -1, ":2: expected at least one atom, got 0 atoms"},
    {"odd/chemfiles__lammps-data_triclinic-2.lmp", -1, ":2: expected at least one atom, got 0 atoms"},
    {"odd/chemfiles__lammps_bad_atom-duplicated-id.lammpstrj", -1, ":11: atom id 2 stands on line 10 already"},
    {"odd/chemfiles__lammps_bad_atom-item-name.lammpstrj", -1, ":9: expected \"ITEM: TIMESTEP\""},
    {"odd/chemfiles__lammps_bad_atom-not-enough-lines.lammpstrj", -1, ":11: expected 3 atoms as line 4 says, got 2"},
    {"odd/chemfiles__lammps_bad_box-item-name.lammpstrj", -1, ":5: expected \"ITEM: TIMESTEP\""},
    {"odd/chemfiles__lammps_bad_box-not-numbers.lammpstrj", 0,
     ":6: expected 2 numbers of the box bounds, got \"DUMMY\""},
    {"odd/chemfiles__lammps_bad_box-not-numbers.lammpstrj", 1, ":18: expected 2 numbers of the box bounds, got"},
    {"odd/chemfiles__lammps_bad_box-not-numbers.lammpstrj", -1, ":30: expected 2 numbers of the box bounds, got"},
    {"odd/chemfiles__lammps_bad_items-after-atoms.lammpstrj", -1, ":15: expected a frame with its ITEM: ATOMS"},
    {"odd/chemfiles__lammps_bad_timestep-no-item.lammpstrj", -1, ":1: expected \"ITEM: TIMESTEP\""},
    {"odd/chemfiles__xyz_bad_extended-bad-properties.xyz", 0, ":3: expected a finite number for x, got \"H\""},
    {"odd/chemfiles__xyz_bad_extended-bad-properties.xyz", 1,
     ":5: expected a count from 1 to 1000 for property \"bad\""},
    {"odd/chemfiles__xyz_bad_extended-bad-properties.xyz", 2, ":8: expected name:type:count"},
    {"odd/chemfiles__xyz_bad_extended-bad-properties.xyz", 3, ":11: expected a count from 1 to 1000"},
    {"odd/chemfiles__xyz_bad_extended-bad-properties.xyz", 4, ":14: expected a count from 1 to 1000"},
    {"odd/chemfiles__xyz_bad_helium.xyz", -1, ":6: expected 8 atoms after the count on line 1, got 4"},
    {"odd/chemfiles__xyz_water.6.xyz.gz", -1, ": is compressed (gzip)"},
    {"odd/chemfiles__xyz_water.xyz.xz", -1, ": is compressed (xz)"},
};

std::string shared(const char* file) {
  return std::string(ATOMESH_SHARED_DATA) + "/" + file;
}

bool shared_data_is_here() {
  return std::filesystem::exists(shared("INDEX.md"));
}

TEST(ReadSharedFiles, EveryReadableFileHoldsWhatWasCounted) {
  if (!shared_data_is_here()) GTEST_SKIP() << "no shared data at " << ATOMESH_SHARED_DATA;
  for (const Expected& expected : readable) {
    SCOPED_TRACE(expected.file);
    const ReadResult read = read_atoms(shared(expected.file));
    EXPECT_EQ(read.report.format, expected.format);
    EXPECT_EQ(read.report.atoms + read.report.duplicates, expected.atoms);
    EXPECT_EQ(read.report.duplicates, expected.duplicates);
    EXPECT_EQ(read.report.frames, expected.frames);
    EXPECT_EQ(read.report.frame, expected.frames - 1);
    std::string species;
    for (const Species& s : read.atoms.species_table) species += (species.empty() ? "" : " ") + s.name;
    EXPECT_EQ(species, expected.species);
    std::string periodic = "-";
    if (read.atoms.box.present()) {
      periodic.clear();
      for (const bool p : read.atoms.box.periodic) periodic += p ? 'T' : 'F';
    }
    EXPECT_EQ(periodic, expected.periodic);
    std::string columns;
    for (const Column& column : read.atoms.columns) {
      columns += (columns.empty() ? "" : " ") + column.name;
      EXPECT_EQ(column.values.size(), read.atoms.size());
    }
    if (std::string(expected.columns) != "*") {
      EXPECT_EQ(columns, expected.columns);
    }
    for (const std::string& note : read.report.notes) std::printf("  %s: %s\n", expected.file, note.c_str());
  }
}

TEST(ReadSharedFiles, EveryBadFileIsRefusedWithFileAndLine) {
  if (!shared_data_is_here()) GTEST_SKIP() << "no shared data at " << ATOMESH_SHARED_DATA;
  for (const Refused& refused : unreadable) {
    SCOPED_TRACE(refused.file);
    try {
      ReadOptions options;
      options.frame = refused.frame;
      read_atoms(shared(refused.file), options);
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(shared(refused.file) + refused.message)) << error.what();
    }
  }
}

TEST(ReadSharedFiles, KnownAtomsOfSomeFiles) {
  if (!shared_data_is_here()) GTEST_SKIP() << "no shared data at " << ATOMESH_SHARED_DATA;
  // Sorted by id: the file begins with atom 2, written on its line 10.
  const Atoms molybdenum = read_atoms(shared("atoms/pyscal__conf.bcc")).atoms;
  EXPECT_EQ(molybdenum.ids[1], 2);
  EXPECT_EQ(molybdenum.positions[1], Vec3(1.63761, 1.46879, 1.71425));
  EXPECT_EQ(molybdenum.find_column("vy")->values[1], 8.38807);
  // Scaled: 0.0625 of a box from -1.41005 to 21.150751.
  ReadOptions first;
  first.frame = 0;
  const Atoms salt = read_atoms(shared("odd/chemfiles__lammps_nacl.lammpstrj"), first).atoms;
  EXPECT_NEAR(salt.positions[1].x, -1.41005 + 0.0625 * 22.560801, 1e-12);
  EXPECT_NEAR(salt.positions[1].z, -1.41005 + 0.1875 * 22.560801, 1e-12);
  const ReadResult quartz = read_atoms(shared("atoms/quip__quartz_crack.xyz"));
  EXPECT_EQ(quartz.atoms.box.vectors[0], Vec3(242.71850332, 0, 0));
  EXPECT_NE(quartz.atoms.find_column("travel_3"), nullptr);
  EXPECT_EQ(quartz.atoms.find_column("Z")->values[0], 8.0);
}

}  // namespace
}  // namespace atomesh::test
