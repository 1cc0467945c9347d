// Files of every format, damaged at random: each is either read into consistent atoms or refused by name. Meant to run
// under the address and undefined-behaviour sanitizers too.
#include <cmath>
#include <random>

#include "tests/preprocess/read_checks.h"

namespace atomesh::test {
namespace {

struct Whole {
  const char* format;
  std::string content;
};

std::vector<Whole> whole_files() {
  const std::string dump_frame =
      "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS xy xz yz pp pp ff\n-2 13 -2\n-4 20 3\n0 30 -4\n"
      "ITEM: ATOMS id type mass xs ys zs c_e\n3 1 28.08 0.1 0.2 0.3 1\n1 2 72.6 0.5 0.5 0.5 2\n2 2 72.6 0 0.25 0.75 "
      "3\n";
  return {
      {"dat",
       "# salt\nNa 0 0 0\nCl 2.82 0 0\nprimitive\n0 2.82 2.82\n2.82 0 2.82\n2.82 2.82 0\nbasis 2\nNa 0 0 0\n"
       "Cl 2.82 0 0\nradius Na 0.9\nbox\n5.64 0 0 periodic\n0 5.64 0 open\n0 0 5.64 periodic\norigin 0 1 2\nNa 1 2 "
       "3\n"},
      {"xyz",
       "2\nLattice=\"4 0 0 1 5 0 0 0 6\" Properties=species:S:1:pos:R:3:id:I:1:velo:R:2:f:L:1 pbc=\"T F T\"\n"
       "Na 1 2 3 9 0.1 0.2 T\nCl 4 5 6 8 0.3 0.4 F\n2\nprose\nC 0 0 0\nC 1e-3 -2 +3\n"},
      {"lammps-data",
       "title\n\n3 atoms\n2 atom types\n0 10 xlo xhi\n-5 5 ylo yhi\n0 4 zlo zhi\n1 2 -1 xy xz yz\n\nMasses\n\n1 "
       "28.0855\n"
       "2 72.64 # Ge\n\nAtoms # charge\n\n3 2 0.5 1 2 3 0 0 1\n1 1 -0.5 4 5 6 0 0 0\n2 1 0 7 8 9 0 1 "
       "0\n\nVelocities\n\n"
       "1 0 0 0\n2 0 0 0\n3 0 0 0\n"},
      {"lammps-dump", dump_frame + "ITEM: UNITS\nmetal\n" + dump_frame},
  };
}

void expect_consistent(const ReadResult& read) {
  const Atoms& atoms = read.atoms;
  ASSERT_GT(atoms.size(), 0u);
  EXPECT_EQ(read.report.atoms, atoms.size());
  ASSERT_EQ(atoms.species.size(), atoms.size());
  EXPECT_TRUE(atoms.ids.empty() || atoms.ids.size() == atoms.size());
  for (const Column& column : atoms.columns) EXPECT_EQ(column.values.size(), atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    EXPECT_LT(atoms.species[i], atoms.species_table.size());
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(atoms.positions[i][k]));
  }
  if (read.unit_cell) {
    EXPECT_NO_THROW(check_unit_cell(*read.unit_cell));
  }
}

// Reads, and counts what became of it.
void read_damaged(const std::string& file, const std::string& format, const std::string& content, int& read_count,
                  int& refused_count) {
  // A new file is never flushed to the disk before it is gone; one written over is.
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << content;
  for (const bool named : {true, false}) {
    ReadOptions options;
    if (named) options.format = format;
    options.frame = named ? -1 : 0;
    try {
      expect_consistent(read_atoms(file, options));
      ++read_count;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(file)) << error.what();
      ++refused_count;
    }
  }
}

TEST(ReadDamaged, WholeFilesAreRead) {
  for (const Whole& whole : whole_files()) {
    const ReadResult read = read_text("a.txt", whole.content);
    expect_consistent(read);
  }
}

TEST(ReadDamaged, CutAnywhere) {
  const TemporaryFolder folder;
  for (const Whole& whole : whole_files()) {
    SCOPED_TRACE(whole.format);
    int read = 0;
    int refused = 0;
    for (std::size_t length = 0; length < whole.content.size(); ++length) {
      read_damaged(folder.file("a.dat"), whole.format, whole.content.substr(0, length), read, refused);
    }
    EXPECT_GT(read, 0);
    EXPECT_GT(refused, 0);
  }
}

TEST(ReadDamaged, BytesAndLinesChangedAtRandom) {
  const TemporaryFolder folder;
  std::mt19937 random(20);
  const auto below = [&random](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  // Bytes that matter to some grammar more often than others.
  const std::string_view telling = "0123456789.-+eE #\n\r\t\"'={}:\\nanifTFabcxyz\0\x80\xff";
  for (const Whole& whole : whole_files()) {
    SCOPED_TRACE(whole.format);
    int read = 0;
    int refused = 0;
    for (int round = 0; round < 1500; ++round) {
      std::string content = whole.content;
      const std::size_t changes = 1 + below(4);
      for (std::size_t change = 0; change < changes; ++change) {
        const std::size_t at = below(content.size());
        switch (below(6)) {
          case 0:
            content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
            break;
          case 1:
            content[at] = telling[below(telling.size())];
            break;
          case 2:
            content.insert(at, 1, telling[below(telling.size())]);
            break;
          case 3:
            content.erase(at, 1 + below(8));
            break;
          case 4:  // a stretch repeated: sections, fields and frames twice
            content.insert(at, content.substr(below(content.size()), 1 + below(60)));
            break;
          default:  // a number grown absurd
            content.insert(at, "99999999999");
            break;
        }
        if (content.empty()) content = "x";
      }
      read_damaged(folder.file("a.xyz"), whole.format, content, read, refused);
    }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 100);
  }
}

TEST(ReadDamaged, Garbage) {
  const TemporaryFolder folder;
  std::mt19937 random(21);
  int read = 0;
  int refused = 0;
  for (const Whole& whole : whole_files()) {
    for (int round = 0; round < 100; ++round) {
      std::string content(std::uniform_int_distribution<std::size_t>(1, 300)(random), ' ');
      for (char& c : content) c = static_cast<char>(random() % 256);
      read_damaged(folder.file("a.dump"), whole.format, content, read, refused);
    }
  }
  EXPECT_EQ(read, 0);
}

}  // namespace
}  // namespace atomesh::test
