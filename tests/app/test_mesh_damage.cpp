// Whatever is done to a mesh file, reading it ends in a material that is sound or in an InputError that names the file:
// never in another exception, a crash, memory a small file has no right to, or VTK's own words on the terminal.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "app/cli/read_mesh.h"
#include "app/cli/write_vtu.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/surface.h"
#include "tests/app/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::cli {
namespace {

using test::legacy_vtk;
using test::Plot3dGrid;
using test::TemporaryFolder;
using test::VtkCell;
using test::vtu;

// The message of the InputError, "" where it is read and sound. Anything else goes through.
std::string refusal(const std::string& path, const std::string& name) {
  try {
    MeshFileReport report;
    const Material material = read_mesh_file(path, {}, report);
    EXPECT_EQ(validate(material.mesh), std::vector<std::string>()) << path;
    EXPECT_TRUE(is_closed(material.surface)) << path;
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(name.substr(0, name.find('.'))), std::string::npos) << what;
    EXPECT_EQ(what.find("(0x"), std::string::npos) << "words of VTK's own: " << what;
    return what;
  }
  return "";
}

const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<VtkCell> cells{
    {12, {0, 1, 2, 3, 4, 5, 6, 7}}, {10, {0, 1, 2, 5}}, {42, {6, 4, 0, 4, 7, 3, 4, 1, 2, 6, 5, 4, 0, 1, 5, 4,
                                                              4, 3, 7, 6, 2, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7}}};

std::string big_endian(std::int32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}
std::string big_endian(float value) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, 4);
  return big_endian(bits);
}

std::string binary_vtk() {
  std::string text = "# vtk DataFile Version 3.0\ntest\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n";
  for (const Vec3& p : cube) {
    for (int axis = 0; axis < 3; ++axis) text += big_endian(static_cast<float>(p[axis]));
  }
  text += "\nCELLS 2 14\n";
  for (const std::int32_t n : {8, 0, 1, 2, 3, 4, 5, 6, 7, 4, 0, 1, 2, 5}) text += big_endian(n);
  text += "\nCELL_TYPES 2\n" + big_endian(12) + big_endian(10);
  text += "\nPOINT_DATA 8\nSCALARS s float 1\nLOOKUP_TABLE default\n";
  for (int p = 0; p < 8; ++p) text += big_endian(static_cast<float>(p));
  return text + "\n";
}

const std::string point_data =
    "POINT_DATA 8\nSCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\nFIELD more 1\nfour 4 8 float\n" +
    [] {
      std::string numbers;
      for (int i = 0; i < 32; ++i) numbers += std::to_string(i) + " ";
      return numbers;
    }() +
    "\n";

std::string xml_data() {
  return "<PointData Scalars=\"s\"><DataArray type=\"Float32\" Name=\"s\" format=\"ascii\">0 1 2 3 4 5 6 7</DataArray>"
         "</PointData><CellData><DataArray type=\"Float32\" Name=\"c\" NumberOfComponents=\"2\" format=\"ascii\">"
         "0 1 2 3</DataArray></CellData>";
}

// As write_vtu() does it: raw data behind the XML.
std::string appended_vtu(const TemporaryFolder& folder) {
  MeshFileReport report;
  const Material material =
      read_mesh_file(folder.file("sound.vtk", legacy_vtk(cube, {cells[0]}, point_data)), {}, report);
  write_vtu(folder.file("sound.vtu"), material);
  return test::read_bytes(folder.file("sound.vtu"));
}

Plot3dGrid grid() {
  return {{3, 3, 2}, [](int i, int j, int k) { return Vec3(i, j, k); }, [](int i, int, int) { return i == 0 ? 0 : 1; }};
}

const std::string structured =
    "# vtk DataFile Version 2.0\ntest\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
    "SPACING 1 1 1\n" +
    point_data;
const std::string nodes = "5 3 1 0\n0 0 0 0 1\n1 1 0 0 2\n2 0 1 0 3\n3 0 0 1 4\n4 1 1 1 5\n";
const std::string elements = "2 4 1\n0 0 1 2 3 7\n1 1 2 3 4 8\n";

// (name, content) of a sound file of each kind.
std::vector<std::pair<std::string, std::string>> sound_files(const TemporaryFolder& folder) {
  const std::vector<VtkCell> two{cells[0], cells[1]};
  folder.file("gridxyz.q", test::plot3d_solution({}, {grid()}));
  folder.file("text.ele", elements);
  return {{"ascii.vtk", legacy_vtk(cube, cells, point_data)},
          {"binary.vtk", binary_vtk()},
          {"structured.vtk", structured},
          {"ascii.vtu", vtu(cube, two, xml_data())},
          {"appended.vtu", appended_vtu(folder)},
          {"grid.x", test::plot3d_grid({}, {grid()})},
          {"marked.x", test::plot3d_grid({.record_marks = true, .multi_grid = true}, {grid(), grid()})},
          {"text.node", nodes}};
}

TEST(MeshDamage, SoundFilesAreRead) {
  const TemporaryFolder folder;
  for (const auto& [name, content] : sound_files(folder)) {
    EXPECT_EQ(refusal(folder.file(name, content), name), "") << name;
  }
}

TEST(MeshDamage, EveryTruncationIsReadSoundOrRefused) {
  const TemporaryFolder folder;
  for (const auto& [name, content] : sound_files(folder)) {
    std::size_t refused = 0;
    std::size_t tried = 0;
    for (std::size_t length = 0; length < content.size(); length += 1 + content.size() / 400) {
      ++tried;
      refused += refusal(folder.file(name, content.substr(0, length)), name).empty() ? 0 : 1;
    }
    // What is cut behind the last cell leaves a mesh without some of its values.
    EXPECT_GT(refused, tried / 4) << name;
  }
}

// Deterministic rough handling.
std::string mauled(std::string text, std::mt19937& random) {
  const auto changes = 1 + random() % 3;
  for (unsigned change = 0; change < changes && !text.empty(); ++change) {
    const std::size_t at = random() % text.size();
    switch (random() % 6) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text[at] = static_cast<char>('0' + random() % 10);
        break;
      case 2:
        text.erase(at, 1 + random() % 10);
        break;
      case 3:
        text.insert(at, 1, "0123456789 -+.eE\n\"<>/="[random() % 23]);
        break;
      case 4:
        text.insert(at, "99999999999");
        break;
      default:
        text[at] = static_cast<char>(random() % 2 == 0 ? 0xFF : 0x7F);
    }
  }
  return text;
}

TEST(MeshDamage, RoughHandlingEndsInASoundMeshOrARefusal) {
  const TemporaryFolder folder;
  std::mt19937 random(5);
  for (const auto& [name, content] : sound_files(folder)) {
    std::size_t refused = 0;
    const std::size_t before = peak_memory();
    for (int round = 0; round < 300; ++round) {
      const std::string damaged = mauled(content, random);
      // So that one that kills the test can be looked at.
      refused += refusal(folder.file(name, damaged), name).empty() ? 0 : 1;
    }
    EXPECT_GT(refused, 50U) << name;
    EXPECT_LT(peak_memory(), before + 400'000'000U) << name;
  }
}

TEST(MeshDamage, HugeCountsAreRefusedAndNamed) {
  const TemporaryFolder folder;
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string ascii = legacy_vtk(cube, cells, point_data);
  const std::vector<std::pair<std::string, std::string>> damaged{
      {"a.vtk", replaced(ascii, "POINTS 8", "POINTS 4000000000")},
      {"a.vtk", replaced(ascii, "POINTS 8", "POINTS 99999999999999999999")},
      {"a.vtk", replaced(ascii, "POINTS 8", "POINTS -8")},
      {"a.vtk", replaced(ascii, "CELLS 3", "CELLS 2000000000")},
      {"a.vtk", replaced(ascii, "CELLS 3", "CELLS 4")},
      {"a.vtk", replaced(ascii, "\n8 0 1", "\n800 0 1")},
      {"a.vtk", replaced(ascii, "\n8 0 1", "\n-8 0 1")},
      {"a.vtk", replaced(ascii, "\n8 0 1", "\n8 77 1")},
      {"a.vtk", replaced(ascii, "\n8 0 1", "\n8 -1 1")},
      {"a.vtk", replaced(ascii, "\n31 6 4", "\n31 6000000 4")},
      {"a.vtk", replaced(ascii, "\n31 6 4", "\n31 6 4000000")},
      {"a.vtk", replaced(structured, "DIMENSIONS 2 2 2", "DIMENSIONS 20000 20000 20000")},
      {"a.vtk", replaced(structured, "DIMENSIONS 2 2 2", "DIMENSIONS 2 2 3")},
      {"a.vtu", replaced(vtu(cube, cells), "NumberOfPoints=\"8\"", "NumberOfPoints=\"8000000000\"")},
      {"a.vtu", replaced(vtu(cube, cells), "NumberOfCells=\"3\"", "NumberOfCells=\"-3\"")},
      {"a.vtu", replaced(vtu(cube, {cells[0]}), "0 1 2 3 4 5 6 7", "0 1 2 3 4 5 6 8")},
      {"a.vtu", replaced(vtu(cube, {cells[0]}), "\n8\n", "\n9\n")},
      {"a.vtu", replaced(vtu(cube, {cells[0]}), "\n12\n", "\n16\n")},
      {"a.x", test::plot3d_grid({}, {grid()}) + "x"},
      {"text.node", replaced(nodes, "5 3", "5000000000 3")},
      {"text.node", replaced(nodes, "5 3 1", "5 3 1000000000")},
      {"text.node", replaced(nodes, "5 3", "5 2")},
      {"text.node", replaced(nodes, "\n2 ", "\n3 ")},
  };
  folder.file("text.ele", elements);
  for (const auto& [name, content] : damaged) {
    EXPECT_NE(refusal(folder.file(name, content), name), "") << content.substr(0, 300);
  }
  folder.file("text.node", nodes);
  for (const std::string& wrong : {replaced(elements, "\n0 0 1", "\n0 0 9"), replaced(elements, "2 4", "2 5"),
                                   replaced(elements, "2 4", "3 4"), replaced(elements, "2 4", "90000000000 4")}) {
    folder.file("text.ele", wrong);
    EXPECT_NE(refusal(folder.file("text.node"), "text.ele"), "") << wrong;
  }
}

// As write_vtu() packs them: the first array of its appended data has one block, whose size stands fourth.
TEST(MeshDamage, SizesOfPackedBlocksThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  const std::string sound = appended_vtu(folder);
  const std::size_t data = sound.find('_', sound.find("<AppendedData")) + 1;
  ASSERT_NE(sound.find("compressor="), std::string::npos);
  const std::size_t word = sound.find("UInt64") < sound.find("<Piece") ? 8 : 4;
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, sound.data() + data + at * word, word);
    return value;
  };
  ASSERT_EQ(number(0), 1U);
  const auto with = [&](std::size_t at, std::uint64_t value) {
    std::string damaged = sound;
    std::memcpy(damaged.data() + data + at * word, &value, word);
    return refusal(folder.file("a.vtu", damaged), "a.vtu");
  };
  EXPECT_EQ(with(3, number(3)), "");
  const std::string said = "an array's blocks are not of a size that can be in it";
  const std::uint64_t unpacked = number(2) > 0 ? number(2) : number(1);
  for (const std::uint64_t size : {std::uint64_t{0}, unpacked + unpacked / 64 + 1025, std::uint64_t{sound.size()},
                                   std::uint64_t{0x7FFFFFFF}, std::uint64_t{0xFFFFFFFF}}) {
    EXPECT_NE(with(3, size).find(said), std::string::npos) << size;
  }
  // No block, but a last one; blocks of no size, a last one larger than the others, and more of them than the sizes
  // that follow.
  EXPECT_NE(with(0, 0).find(said), std::string::npos);
  EXPECT_NE(with(1, 0).find(said), std::string::npos);
  EXPECT_NE(with(2, number(1) + 1).find(said), std::string::npos);
  EXPECT_NE(with(0, sound.size()).find(said), std::string::npos);
  // Cut within the sizes.
  EXPECT_NE(refusal(folder.file("a.vtu", sound.substr(0, data + 3 * word + 2)), "a.vtu"), "");
}

// Every byte of the headers changed to every kind of value.
TEST(MeshDamage, PackedHeadersOfAnyNumbersAreReadSoundOrRefused) {
  const TemporaryFolder folder;
  const std::string sound = appended_vtu(folder);
  const std::size_t data = sound.find('_', sound.find("<AppendedData")) + 1;
  const std::string name = " offset=\"";
  std::size_t refused = 0;
  for (std::size_t at = sound.find(name); at < data; at = sound.find(name, at + 1)) {
    const std::size_t array = data + std::stoul(sound.substr(at + name.size(), 20));
    for (std::size_t byte = array; byte < std::min(array + 32, sound.size()); ++byte) {
      for (const int value : {0, 1, 0x7F, 0x80, 0xFF}) {
        std::string damaged = sound;
        damaged[byte] = static_cast<char>(value);
        refused += refusal(folder.file("a.vtu", damaged), "a.vtu").empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GT(refused, 100U);
}

TEST(MeshDamage, VtkSaysNothingByItself) {
  const TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_NE(refusal(folder.file("a.vtu", vtu(cube, cells).substr(0, 700)), "a.vtu"), "");
  EXPECT_NE(refusal(folder.file("a.vtk", legacy_vtk(cube, cells) + "POINT_DATA 9\n"), "a.vtk"), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace atomesh::cli
