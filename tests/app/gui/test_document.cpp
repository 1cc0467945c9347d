// What is open: what a file is, which of its parts are read, and what happens when it changes on the disk.
#include <gtest/gtest.h>

#include <QElapsedTimer>
#include <filesystem>
#include <fstream>

#include "app/gui/document.h"
#include "core/error.h"
#include "preprocess/write_atoms.h"
#include "render/scene.h"
#include "samples/samples.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

#if defined(__SANITIZE_ADDRESS__)
constexpr double slowdown = 10.0;  // of code under the sanitizers
#else
constexpr double slowdown = 1.0;
#endif

constexpr MaterialParts atoms_alone{
    .atoms = true, .tetrahedra = false, .surface = false, .defects = false, .fields = false};

std::string crystal_dat(const test::TemporaryFolder& folder, std::size_t atoms) {
  const Sample sample = make_sample("diamond-vacancy", {.atoms = atoms});
  const std::string path = folder.file("d.dat");
  write_atoms(path, sample.atoms, sample.unit_cell);
  return path;
}

std::string crystal_crb(const test::TemporaryFolder& folder, std::size_t atoms) {
  PipelineReport report;
  const Material material = preprocess(crystal_dat(folder, atoms), {}, report);
  const std::string path = folder.file("d.crb");
  write_material(path, material);
  return path;
}

// Flips a byte in the middle of a section of the .crb; reading that section is then an error.
void damage_section(const std::string& path, const std::string& section) {
  std::uint64_t offset = std::filesystem::file_size(path);
  const std::vector<SectionInfo> sections = list_sections(path);
  for (auto it = sections.rbegin(); it != sections.rend(); ++it) {
    offset -= it->stored_bytes;
    if (it->name == section) {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      const auto place = static_cast<std::streamoff>(offset + it->stored_bytes / 2);
      file.seekg(place);
      const int byte = file.get();
      file.seekp(place);
      file.put(static_cast<char>(byte ^ 0x55));
      return;
    }
  }
  FAIL() << "no section " << section;
}

TEST(FileKinds, AreToldByContentAndExtension) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(file_kind(crystal_crb(folder, 3000)), FileKind::material);
  EXPECT_EQ(file_kind(folder.file("d.dat")), FileKind::atoms);
  EXPECT_EQ(file_kind(folder.file("a.vtk", "# vtk DataFile Version 3.0\n")), FileKind::mesh);
  EXPECT_EQ(file_kind(folder.file("a.PNG", "\x89PNG")), FileKind::picture);
  EXPECT_EQ(file_kind(folder.file("renamed.txt", "atomesh-crt 3\n")), FileKind::material);
  EXPECT_THROW(file_kind(folder.file("none.crb")), InputError);
}

TEST(Documents, HoldTheParts) {
  const test::TemporaryFolder folder;
  const std::string path = crystal_crb(folder, 3000);
  const Document balls = open_document(path, atoms_alone, no_progress());
  EXPECT_EQ(balls.kind, FileKind::material);
  EXPECT_TRUE(std::filesystem::path(balls.path).is_absolute());
  EXPECT_GT(balls.material->atoms.size(), 2900U);
  EXPECT_TRUE(balls.material->mesh.tetrahedra.empty());
  EXPECT_TRUE(balls.material->surface.triangles.empty());
  EXPECT_EQ(balls.species(), std::vector<std::string>{"C"});
  ASSERT_EQ(balls.times.size(), 1U);
  EXPECT_GT(balls.times[0].ms, 0.0);

  const Document same = with_parts(balls, atoms_alone, no_progress());
  EXPECT_EQ(same.material, balls.material);  // the same object
  MaterialParts surface = atoms_alone;
  surface.atoms = false;
  surface.surface = true;
  const Document both = with_parts(balls, surface, no_progress());
  EXPECT_EQ(both.material->atoms.positions, balls.material->atoms.positions);
  EXPECT_FALSE(both.material->surface.triangles.empty());
  EXPECT_TRUE(both.material->mesh.tetrahedra.empty());
  EXPECT_TRUE(covers(both.parts, atoms_alone) && covers(both.parts, surface));
  EXPECT_FALSE(covers(both.parts, MaterialParts{}));
}

TEST(Documents, AreNotMixedFromTwoFiles) {
  const test::TemporaryFolder folder;
  const std::string path = crystal_crb(folder, 3000);
  const Document balls = open_document(path, atoms_alone, no_progress());
  crystal_crb(folder, 5000);  // in its place
  EXPECT_THROW(with_parts(balls, {}, no_progress()), InputError);
  std::filesystem::remove(path);
  EXPECT_THROW(with_parts(balls, {}, no_progress()), InputError);
  EXPECT_EQ(with_parts(balls, atoms_alone, no_progress()).material, balls.material);  // nothing to read
}

// The counts are the same, and so is the name: only the input's hash tells them apart.
TEST(Documents, AreNotMixedFromTwoFilesOfOneSize) {
  const test::TemporaryFolder folder;
  const std::string path = crystal_crb(folder, 3000);
  const Document balls = open_document(path, atoms_alone, no_progress());
  Sample sample = make_sample("diamond-vacancy", {.atoms = 3000});
  for (Vec3& position : sample.atoms.positions) position += Vec3(1.0, 0.0, 0.0);
  write_atoms(folder.file("d.dat"), sample.atoms, sample.unit_cell);
  PipelineReport report;
  write_material(path, preprocess(folder.file("d.dat"), {}, report));
  EXPECT_EQ(report.read.atoms, balls.material->atoms.size());
  EXPECT_THROW(with_parts(balls, {}, no_progress()), InputError);
}

TEST(Documents, OfOtherKindsSayWhatTheyAre) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(open_document(crystal_dat(folder, 3000), {}, no_progress()), UsageError);
  EXPECT_THROW(open_document(folder.file("a.png", "\x89PNG"), {}, no_progress()), UsageError);
  EXPECT_THROW(open_document(folder.file("a.crb", "ATOMESH"), {}, no_progress()), InputError);
  Progress cancelled;
  cancelled.request_cancel();
  EXPECT_THROW(open_document(crystal_crb(folder, 3000), {}, cancelled), CancelledError);
}

// In atom-ball mode nothing of the mesh is read: not even that it is damaged is noticed.
TEST(Documents, AMillionAtomsOpenAsBallsWithoutTheirMesh) {
  const test::TemporaryFolder folder;
  const std::string path = crystal_crb(folder, 1'000'000);
  Parameters parameters;
  parameters.mode = Mode::atoms;
  const MaterialParts parts = parts_needed(parameters);
  EXPECT_FALSE(parts.tetrahedra || parts.surface);
  for (const char* section : {"tetrahedra", "surface"}) damage_section(path, section);
  QElapsedTimer watch;
  watch.start();
  const Document document = open_document(path, parts, no_progress());
  const auto ms = watch.elapsed();
  std::printf("a million atoms in %lld ms\n", static_cast<long long>(ms));
  EXPECT_LT(static_cast<double>(ms), 3000.0 * slowdown);
  EXPECT_GT(document.material->atoms.size(), 990'000U);
  EXPECT_THROW(with_parts(document, {}, no_progress()), InputError);  // the mesh is damaged indeed
}

}  // namespace
