// What goes wrong: the exit code, what the message says, and that nothing half-written stays behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

constexpr int wrong_use = 1;
constexpr int bad_input = 2;
constexpr int not_here = 3;
constexpr int cancelled = 130;

const std::string cube_dat = "Na 0 0 0\nNa 2 0 0\nNa 0 2 0\nNa 0 0 2\nNa 2 2 0\nNa 2 0 2\nNa 0 2 2\nNa 2 2 2\n";

// The program failed like this, said all of these words, and left only `files`.
void expect_failure(const Workplace& place, const std::vector<std::string>& arguments, int exit_code,
                    const std::vector<std::string>& words, const std::vector<std::string>& files) {
  const Outcome outcome = place.run(arguments);
  std::string command;
  for (const std::string& argument : arguments) command += argument + " ";
  EXPECT_EQ(outcome.exit_code, exit_code) << command << "\n" << outcome.out << outcome.err;
  for (const std::string& word : words) {
    EXPECT_NE(outcome.err.find(word), std::string::npos) << command << "does not say " << word << ":\n" << outcome.err;
  }
  EXPECT_EQ(place.files(), files) << command;
  // So that one failure does not look like many.
  for (const std::string& file : place.files()) {
    if (std::find(files.begin(), files.end(), file) == files.end()) std::filesystem::remove(place.path(file));
  }
}

TEST(ExitCodes, WrongUseNamesTheNearest) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  const std::vector<std::string> left{"a.dat"};
  const auto expect_usage = [&](const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    expect_failure(place, arguments, wrong_use, words, left);
  };
  expect_usage({"rendr"}, {"rendr", "render"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--mod", "atoms"}, {"--mod", "--mode"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--mode", "atom"}, {"atom", "atoms"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--set", "atoms.scael=2"}, {"atoms.scael", "atoms.scale"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--set", "atoms.scale=2x"}, {"atoms.scale", "2x"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--set", "atoms.scale=-1"}, {"atoms.scale", "-1"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--set", "atoms.scale"}, {"key=value"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--set", "atoms.color.Nq=#ff0000"}, {"Nq", "Na"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--size", "640"}, {"640", "WIDTHxHEIGHT"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--size", "0x5"}, {"0x5"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--view", "fornt"}, {"fornt", "front"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--renderer", "cup"}, {"cup", "cpu"});
  expect_usage({"render", "a.dat", "-o", "a.jpg"}, {"a.jpg", ".png"});
  expect_usage({"render", "a.dat", "-o", "nowhere/a.png"}, {"nowhere"});
  expect_usage({"render", "a.dat", "-o", "a.png", "--mode", "xray", "--channel", "depth=d.npy"}, {"depth", "xray"});
  expect_usage({"render", "a.dat"}, {"-o"});
  expect_usage({"preprocess", "a.dat"}, {"--output"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crv"}, {"a.crv", ".crb"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--mesher", "delauny"}, {"delauny", "delaunay"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--carve", "wide"}, {"wide", "auto"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--tolerance", "-1"}, {"-1"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--scalar", "energy"}, {"energy"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--scalar", "Cl=1"}, {"Cl", "Na"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--mask", "Cl"}, {"Cl", "Na"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--threads", "many"}, {"many"});
  expect_usage({"sample", "nacl-craked", "-o", "s.dat"}, {"nacl-cracked"});
  expect_usage({"sample", "nacl-cracked", "-o", "s.txt"}, {".dat"});
  expect_usage({"sample"}, {"--list"});
  expect_usage({"defects", "a.dat", "--kind", "vacancies"}, {"vacancy"});
  expect_usage({"defects", "a.dat", "--top", "-1"}, {"--top", "-1"});
  expect_usage({"defects", "a.dat", "--sites", "--kind", "mixed"}, {"--sites", "mixed"});
  expect_usage({"defects", "a.dat", "--csv", "-", "--json", "-"}, {"--csv", "--json"});
  expect_usage({"sample", "nacl-cracked", "-o", "s.dat", "--atoms", "-5"}, {"--atoms", "-5"});
  expect_usage({"sample", "nacl-cracked", "-o", "s.dat", "--seed", "1e3"}, {"--seed", "1e3"});
  expect_usage({"sample", "nacl-cracked", "-o", "s.dat", "--truth", "nowhere/t.json"}, {"nowhere"});
  expect_usage({"preprocess", "a.dat", "-o", "a.crb", "--json", "nowhere/j.json"}, {"nowhere"});
  expect_usage({"convert", "a.dat", "a.stl"}, {".stl", ".vtu"});
  expect_usage({"compare", "a.png"}, {"B"});
  expect_usage({"compare", "a.png", "b.png", "--tolerance", "2"}, {"2/255"});
  expect_usage({"bench", "seed-tabel"}, {"seed-table"});
}

TEST(ExitCodes, EmptyPicturesSayWhyTheyAre) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  place.write("one.dat", "Na 0 0 0\n");
  const auto note_of = [&place](std::vector<std::string> words) {
    words.insert(words.begin(), "render");
    words.insert(words.end(), {"-o", "x.png", "--size", "8x8"});
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.exit_code, 0);
    return outcome.err;
  };
  const std::vector<std::string> cut{"--set", "cut_plane.1.enabled=true", "cut_plane.1.distance=-1e6"};
  for (const char* mode : {"volume-surface", "xray", "atoms"}) {
    std::vector<std::string> words{"a.dat", "--mode", mode};
    words.insert(words.end(), cut.begin(), cut.end());
    EXPECT_NE(note_of(words).find("cut planes"), std::string::npos) << mode;
    EXPECT_EQ(note_of({"a.dat", "--mode", mode}).find("empty"), std::string::npos) << mode;
  }
  EXPECT_NE(note_of({"one.dat", "--mode", "surface"}).find("--mode atoms"), std::string::npos);
}

TEST(ExitCodes, AFileThatIsNotThereIsSaidToBeMissing) {
  const Outcome outcome = Workplace().run({"nope.crb"});
  EXPECT_EQ(outcome.exit_code, wrong_use);
  EXPECT_NE(outcome.err.find("nope.crb: there is no such file"), std::string::npos) << outcome.err;
}

TEST(ExitCodes, PipelineOptionsDoNothingForAMaterialFile) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  ASSERT_EQ(place.run({"preprocess", "a.dat", "-o", "a.crb"}).exit_code, 0);
  expect_failure(place, {"render", "a.crb", "-o", "a.png", "--carve", "off"}, wrong_use, {"--carve", "preprocessed"},
                 {"a.crb", "a.dat"});
}

TEST(ExitCodes, BadAtomsFilesNameFileAndLine) {
  const Workplace place;
  place.write("fields.dat", "Na 0 0 0\nNa 1 0\n");
  place.write("nan.dat", "Na 0 0 0\nNa nan 0 0\n");
  place.write("count.xyz", "3\n\nNa 0 0 0\nNa 1 0 0\n");
  place.write("empty.dat", "");
  place.write("lammps.data",
              "LAMMPS\n\n2 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n1 1 0 0 0\n");
  place.write("frames.dump",
              "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
              "ITEM: ATOMS id type x y z\n1 1 0 0 0\n");
  place.write("binary.dat", std::string("\x00\x01\xff\xfe\x00", 5));
  const std::vector<std::string> left = place.files();
  const auto expect_bad = [&](const std::string& file, const std::string& where) {
    expect_failure(place, {"preprocess", file, "-o", "out.crb"}, bad_input, {where}, left);
    expect_failure(place, {"render", file, "-o", "out.png"}, bad_input, {where}, left);
    expect_failure(place, {"convert", file, "out.vtu"}, bad_input, {where}, left);
    expect_failure(place, {"info", file, "--json", "out.json"}, bad_input, {where}, left);
  };
  expect_bad("fields.dat", "fields.dat:2: ");
  expect_bad("nan.dat", "nan.dat:2: ");
  expect_bad("count.xyz", "count.xyz:");
  expect_bad("empty.dat", "empty.dat");
  expect_bad("lammps.data", "lammps.data:");
  expect_bad("frames.dump", "frames.dump:");
  expect_bad("binary.dat", "binary.dat");
  expect_bad("missing.dat", "missing.dat");
}

TEST(ExitCodes, BadUnitCellFile) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  place.write("flat.dat", "primitive\n1 0 0\n0 1 0\n1 1 0\nbasis 1\nNa 0 0 0\n");
  const auto left = place.files();
  expect_failure(place, {"preprocess", "a.dat", "-o", "a.crb", "--unit-cell", "no.dat"}, bad_input, {"no.dat"}, left);
  expect_failure(place, {"preprocess", "a.dat", "-o", "a.crb", "--unit-cell", "a.dat"}, bad_input, {"a.dat"}, left);
  expect_failure(place, {"preprocess", "a.dat", "-o", "a.crb", "--unit-cell", "flat.dat"}, bad_input, {}, left);
}

TEST(ExitCodes, DamagedMaterialFiles) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  ASSERT_EQ(place.run({"preprocess", "a.dat", "-o", "good.crb"}).exit_code, 0);
  ASSERT_EQ(place.run({"preprocess", "a.dat", "-o", "good.crt"}).exit_code, 0);
  const std::string crb = place.read("good.crb");
  const std::string crt = place.read("good.crt");
  std::string flipped = crb;
  flipped[flipped.size() - 5] = static_cast<char>(flipped[flipped.size() - 5] ^ 4);
  place.write("flipped.crb", flipped);
  place.write("cut.crb", crb.substr(0, crb.size() / 2));
  place.write("cut.crt", crt.substr(0, crt.size() / 2));
  const auto left = place.files();
  for (const std::string file : {"flipped.crb", "cut.crb", "cut.crt"}) {
    expect_failure(place, {"info", file}, bad_input, {file}, left);
    expect_failure(place, {"render", file, "-o", "out.png"}, bad_input, {file}, left);
    expect_failure(place, {"convert", file, "out.dat"}, bad_input, {file}, left);
  }
}

TEST(ExitCodes, BadPicturesAndParameters) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  place.write("not.png", "GIF89a");
  place.write("bad.crf", "mode = \"atoms\"\n[atoms]\nscale = \"big\"\n");
  place.write("unknown.crf", "[atoms]\nscael = 1.0\n");
  const auto left = place.files();
  expect_failure(place, {"compare", "not.png", "not.png"}, bad_input, {"not.png"}, left);
  expect_failure(place, {"render", "a.dat", "-o", "a.png", "--params", "bad.crf"}, bad_input, {"bad.crf:3"}, left);
  expect_failure(place, {"render", "a.dat", "-o", "a.png", "--params", "unknown.crf"}, bad_input,
                 {"unknown.crf:2", "atoms.scale"}, left);
  expect_failure(place, {"render", "a.dat", "-o", "a.png", "--params", "none.crf"}, bad_input, {"none.crf"}, left);
}

TEST(ExitCodes, ReferenceIsAnotherPictureThatIsThere) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  expect_failure(place, {"render", "a.dat", "-o", "b.png", "--reference", "none.png"}, bad_input, {"none.png"},
                 {"a.dat"});
  ASSERT_EQ(place.run({"render", "a.dat", "-o", "a.png", "--size", "8x8"}).exit_code, 0);
  expect_failure(place, {"render", "a.dat", "-o", "a.png", "--reference", "./a.png"}, wrong_use, {"a.png", "-o"},
                 {"a.dat", "a.png"});
}

TEST(ExitCodes, DefectsWithoutUnitCellSayWhatToDo) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  expect_failure(place, {"defects", "a.dat"}, bad_input, {"a.dat", "--unit-cell"}, {"a.dat"});
}

TEST(ExitCodes, AFullDiskBehindStandardOutputIsNoSuccess) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", "a.dat"}, {"info", "a.dat", "--json", "-"}, {"sample", "--list"}}) {
    const Outcome outcome = place.run_printing_to("/dev/full", arguments);
    EXPECT_EQ(outcome.exit_code, bad_input) << arguments.front();
    EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
  }
}

TEST(ExitCodes, WithoutADisplayTheWindowNamesWhatWorksWithoutOne) {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(variable);
  const Workplace place;
  place.write("a.dat", cube_dat);
  const std::vector<std::string> words{"no window", "DISPLAY", "atomesh render", "preprocess", "defects"};
  expect_failure(place, {}, not_here, words, {"a.dat"});
  expect_failure(place, {"a.dat"}, not_here, words, {"a.dat"});
}

TEST(ExitCodes, WordsForTheWindowThatAreNoFiles) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  place.write("b.dat", cube_dat);
  place.write("v.crf", "");
  const std::vector<std::string> left{"a.dat", "b.dat", "v.crf"};
  expect_failure(place, {"none.crb"}, wrong_use, {"none.crb", "no such file"}, left);
  expect_failure(place, {"."}, wrong_use, {"folder"}, left);
  expect_failure(place, {"a.dat", "b.dat"}, wrong_use, {"a.dat, b.dat", "one"}, left);
  expect_failure(place, {"a.dat", "v.crf", "--params", "v.crf"}, wrong_use, {".crf"}, left);
  expect_failure(place, {"a.dat", "--params", "none.crf"}, wrong_use, {"--params", "none.crf"}, left);
  expect_failure(place, {"--params", "v.crf", "info", "a.dat"}, wrong_use, {"--params", "info"}, left);
  expect_failure(place, {"a.dat", "--parms", "v.crf"}, wrong_use, {"--parms", "--params"}, left);
}

TEST(ExitCodes, RenderersOfOtherBuilds) {
  const Workplace place;
  place.write("a.dat", cube_dat);
  expect_failure(place, {"render", "a.dat", "-o", "a.png", "--renderer", "cuda"}, not_here, {"cuda", "cpu"}, {"a.dat"});
}

TEST(ExitCodes, InterruptLeavesNothingBehind) {
  const Workplace place;
  ASSERT_EQ(place.run({"sample", "nacl-cracked", "--atoms", "20000", "-o", "a.dat"}).exit_code, 0);
  // Minutes of work when nobody interrupts.
  const Outcome outcome =
      place.run_interrupted({"render", "a.dat", "-o", "a.png", "--renderer", "reference", "--size", "3000x3000"}, 1500);
  EXPECT_EQ(outcome.exit_code, cancelled) << outcome.err;
  EXPECT_NE(outcome.err.find("cancelled"), std::string::npos) << outcome.err;
  EXPECT_EQ(place.files(), std::vector<std::string>{"a.dat"});
}

TEST(ExitCodes, FewAtomsAreNoError) {
  const Workplace place;
  place.write("one.dat", "Na 1 2 3\n");
  place.write("line.dat", "Na 0 0 0\nNa 1 0 0\nNa 2 0 0\nNa 3 0 0\nNa 4 0 0\n");
  for (const std::string file : {"one.dat", "line.dat"}) {
    EXPECT_EQ(place.run({"preprocess", file, "-o", "few.crb"}).exit_code, 0);
    for (const std::string mode : {"volume-surface", "volume", "surface", "xray", "atoms"}) {
      const Outcome outcome = place.run({"render", "few.crb", "-o", "few.png", "--mode", mode, "--size", "16x16"});
      EXPECT_EQ(outcome.exit_code, 0) << file << " " << mode << ": " << outcome.err;
    }
    EXPECT_EQ(place.run({"info", "few.crb"}).exit_code, 0);
  }
}

}  // namespace
}  // namespace atomesh::testing
