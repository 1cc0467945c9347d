#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/material_file.h"
#include "core/parallel.h"
#include "tests/core/random_material.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

using test::difference;
using test::MaterialKind;
using test::random_material;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

// Fixtures by property: each leaves out or twists one thing.
std::vector<std::pair<std::string, MaterialKind>> kinds() {
  std::vector<std::pair<std::string, MaterialKind>> list{{"everything", {}}};
  list.emplace_back("own vertices", MaterialKind{.own_vertices = true});
  list.emplace_back("no ids", MaterialKind{.ids = false});
  list.emplace_back("no columns", MaterialKind{.columns = false});
  list.emplace_back("no unit cell", MaterialKind{.unit_cell = false});
  list.emplace_back("no defects", MaterialKind{.defects = false});
  list.emplace_back("no fields", MaterialKind{.fields = false});
  list.emplace_back("surface without cells", MaterialKind{.surface_cells = false});
  list.emplace_back("no tetrahedra", MaterialKind{.atoms = 3, .tetrahedra = 0});
  list.emplace_back("one atom", MaterialKind{.atoms = 1, .tetrahedra = 0});
  list.emplace_back("no atoms", MaterialKind{.atoms = 0, .tetrahedra = 0});
  list.emplace_back("several blocks", MaterialKind{.atoms = 60000, .tetrahedra = 150000, .own_vertices = true});
  return list;
}

TEST(MaterialFile, EveryBitComesBack) {
  const TemporaryFolder folder;
  for (const auto& [name, kind] : kinds()) {
    const Material material = random_material(5, kind);
    for (const char* file : {"a.crb", "a.crt"}) {
      write_material(folder.file(file), material);
      EXPECT_EQ(difference(read_material(folder.file(file)), material), "") << name << " " << file;
      EXPECT_TRUE(is_material_file(folder.file(file)));
    }
    write_material(folder.file("raw.crb"), material, {.compress = false});
    EXPECT_EQ(difference(read_material(folder.file("raw.crb")), material), "") << name;
    EXPECT_EQ(difference(read_material(folder.file("a.crb")), Material()) == "", false);
  }
  EXPECT_EQ(difference(Material(), Material()), "");
}

TEST(MaterialFile, AnEmptyMaterialComesBack) {
  const TemporaryFolder folder;
  for (const char* file : {"a.crb", "a.crt"}) {
    write_material(folder.file(file), Material());
    EXPECT_EQ(difference(read_material(folder.file(file)), Material()), "");
  }
}

TEST(MaterialFile, BinaryToTextAndBackIsTheSameFile) {
  const TemporaryFolder folder;
  for (const auto& [name, kind] : kinds()) {
    write_material(folder.file("a.crb"), random_material(6, kind));
    write_material(folder.file("b.crt"), read_material(folder.file("a.crb")));
    write_material(folder.file("c.crb"), read_material(folder.file("b.crt")));
    write_material(folder.file("d.crt"), read_material(folder.file("c.crb")));
    EXPECT_EQ(read_bytes(folder.file("a.crb")), read_bytes(folder.file("c.crb"))) << name;
    EXPECT_EQ(read_bytes(folder.file("b.crt")), read_bytes(folder.file("d.crt"))) << name;
  }
}

TEST(MaterialFile, BytesDoNotDependOnTheNumberOfThreads) {
  const TemporaryFolder folder;
  const Material material = random_material(7, {.atoms = 60000, .tetrahedra = 150000});
  for (const char* extension : {".crb", ".crt"}) {
    std::string first;
    for (const int n : {1, 2, 5}) {
      set_threads(n);
      write_material(folder.file("a") + extension, material);
      const std::string bytes = read_bytes(folder.file("a") + extension);
      if (first.empty()) first = bytes;
      EXPECT_EQ(bytes, first) << n << extension;
      EXPECT_EQ(difference(read_material(folder.file("a") + extension), material), "");
    }
  }
  set_threads(0);
}

TEST(MaterialFile, OnlyWhatIsAskedForIsRead) {
  const TemporaryFolder folder;
  for (const bool own : {false, true}) {
    const Material whole = random_material(8, {.own_vertices = own});
    for (const char* file : {"a.crb", "a.crt"}) {
      write_material(folder.file(file), whole);
      for (int bits = 0; bits < 32; ++bits) {
        const MaterialParts parts{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
        Material expected = whole;
        if (!parts.atoms) {
          expected.atoms = {};
          expected.atoms.species_table = whole.atoms.species_table;
        }
        if (!parts.tetrahedra) expected.mesh.tetrahedra = {};
        if (!parts.surface) expected.surface = {};
        if (!parts.tetrahedra) expected.surface.tetrahedron = {};
        if (!parts.tetrahedra) expected.surface.face = {};
        if (!parts.tetrahedra && !parts.surface) expected.mesh.vertices = {};
        if (!parts.tetrahedra && !parts.surface) expected.mesh.vertex_atom = {};
        if (!parts.defects) expected.defects = {};
        if (!parts.fields || (!parts.tetrahedra && !parts.surface)) expected.fields = {};
        EXPECT_EQ(difference(read_material(folder.file(file), parts), expected), "") << file << " parts " << bits;
      }
    }
  }
}

TEST(MaterialFile, SectionsAreListedAndVerticesNotStoredTwice) {
  const TemporaryFolder folder;
  const auto names = [&](const Material& material) {
    write_material(folder.file("a.crb"), material);
    std::vector<std::string> list;
    std::uint64_t stored = 0;
    for (const SectionInfo& section : list_sections(folder.file("a.crb"))) {
      list.push_back(section.name);
      stored += section.stored_bytes;
      EXPECT_GT(section.bytes, 0U) << section.name;
    }
    EXPECT_EQ(stored + 32 + 56 * list.size(), read_bytes(folder.file("a.crb")).size());
    return list;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(
      names(random_material(1)),
      (Names{"counts",       "species", "box",           "unit cell",   "positions",     "atom species",  "ids",
             "scalar names", "scalars", "tetrahedra",    "surface",     "surface cells", "surface faces", "defects",
             "vacancies",    "extras",  "substitutions", "field names", "fields",        "provenance"}));
  const Names own = names(random_material(1, {.own_vertices = true}));
  EXPECT_NE(std::find(own.begin(), own.end(), "vertices"), own.end());
  EXPECT_NE(std::find(own.begin(), own.end(), "vertex atoms"), own.end());
  write_material(folder.file("a.crt"), random_material(1));
  EXPECT_THROW(list_sections(folder.file("a.crt")), InputError);
}

// A perfect crystal's defects and a single species pack to almost nothing; the file must still obey its own rule.
TEST(MaterialFile, WhatPacksTooWellIsStoredRaw) {
  const TemporaryFolder folder;
  Material material;
  material.atoms.species_table = {{"Ar", 1.0}};
  material.atoms.positions.assign(2000000, Vec3(1.5));
  material.atoms.species.assign(2000000, 0);
  write_material(folder.file("a.crb"), material);
  EXPECT_GT(read_bytes(folder.file("a.crb")).size(), 2000000U * 26U);
  EXPECT_EQ(difference(read_material(folder.file("a.crb")), material), "");
}

TEST(MaterialFile, AMaterialThatCouldNotBeReadBackIsNotWritten) {
  const TemporaryFolder folder;
  const auto refuses = [&](const char* what, auto&& spoil) {
    for (const char* file : {"a.crb", "a.crt"}) {
      Material material = random_material(9);
      spoil(material);
      EXPECT_THROW(write_material(folder.file(file), material), Error) << what;
      EXPECT_EQ(folder.count(), 0U) << what;
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuses("position", [&](Material& m) { m.atoms.positions[3].y = nan; });
  refuses("infinite position", [&](Material& m) { m.atoms.positions[3].y = 1.0 / 0.0; });
  refuses("vertex", [&](Material& m) { m.mesh.vertices[3].z = nan; });
  refuses("defect", [&](Material& m) { m.defects.extra[0] = static_cast<float>(nan); });
  refuses("column", [&](Material& m) { m.atoms.columns[0].values[1] = nan; });
  refuses("column length", [&](Material& m) { m.atoms.columns[0].values.pop_back(); });
  refuses("box", [&](Material& m) { m.atoms.box.vectors[1].x = nan; });
  refuses("unit cell", [&](Material& m) { m.unit_cell->basis[0].position.x = nan; });
  refuses("unit cell species", [&](Material& m) { m.unit_cell->basis[0].species = ""; });
  refuses("time", [&](Material& m) { m.provenance.stages[0].ms = nan; });
  refuses("species index", [&](Material& m) { m.atoms.species[0] = 3; });
  refuses("species length", [&](Material& m) { m.atoms.species.pop_back(); });
  refuses("species name", [&](Material& m) { m.atoms.species_table[0].name = "a b"; });
  refuses("species twice", [&](Material& m) { m.atoms.species_table[0].name = "Cl"; });
  refuses("ids", [&](Material& m) { m.atoms.ids.pop_back(); });
  refuses("tetrahedron", [&](Material& m) { m.mesh.tetrahedra[1][2] = 40; });
  refuses("tetrahedron with a corner twice", [&](Material& m) { m.mesh.tetrahedra[1][2] = m.mesh.tetrahedra[1][0]; });
  refuses("vertex atom", [&](Material& m) { m.mesh.vertex_atom[1] = 40; });
  refuses("vertex atoms", [&](Material& m) { m.mesh.vertex_atom.pop_back(); });
  refuses("triangle", [&](Material& m) { m.surface.triangles[1][2] = 40; });
  refuses("surface cell", [&](Material& m) { m.surface.tetrahedron[1] = 60; });
  refuses("surface face", [&](Material& m) { m.surface.face[1] = 4; });
  refuses("another face", [&](Material& m) { m.surface.face[1] = (m.surface.face[1] + 1) & 3; });
  refuses("defect length", [&](Material& m) { m.defects.vacancy.pop_back(); });
  refuses("vacancy species", [&](Material& m) { m.defects.vacancies[0].species = 3; });
  refuses("extra", [&](Material& m) { m.defects.extras[0].atom = 40; });
  refuses("substitution", [&](Material& m) { m.defects.substitutions[0].atom = 40; });
  refuses("substitution that is no extra atom", [&](Material& m) { m.defects.extras.clear(); });
  refuses("substitution's species", [&](Material& m) { m.defects.substitutions[0].expected = 3; });
  refuses("substitution's vacancy", [&](Material& m) { m.defects.substitutions[0].vacancy = 2; });
  refuses("field", [&](Material& m) { m.fields[0].values[1] = static_cast<float>(nan); });
  refuses("field length", [&](Material& m) { m.fields[0].values.pop_back(); });
  refuses("field without a name", [&](Material& m) { m.fields[0].name = ""; });
  refuses("field twice", [&](Material& m) { m.fields[0].name = m.fields[1].name; });
  EXPECT_THROW(write_material(folder.file("a.vtu"), random_material(1)), UsageError);
}

TEST(MaterialFile, CancellingLeavesNoFileAndTheOldOneAlone) {
  const TemporaryFolder folder;
  const Material material = random_material(7, {.atoms = 60000, .tetrahedra = 150000});
  for (const char* extension : {".crb", ".crt"}) {
    const std::string path = folder.file("a") + extension;
    write_bytes(path, "the old one");
    Progress* following = nullptr;
    Progress progress([&](std::string_view, double fraction) {
      if (fraction > 0.5) following->request_cancel();
    });
    following = &progress;
    EXPECT_THROW(write_material(path, material, {}, progress), CancelledError);
    EXPECT_EQ(read_bytes(path), "the old one");
  }
  EXPECT_EQ(folder.count(), 2U);
  for (const char* extension : {".crb", ".crt"}) {
    const std::string path = folder.file("b") + extension;
    write_material(path, material);
    Progress* following = nullptr;
    Progress progress([&](std::string_view, double fraction) {
      if (fraction > 0.2) following->request_cancel();
    });
    following = &progress;
    EXPECT_THROW(read_material(path, {}, progress), CancelledError);
  }
}

TEST(MaterialFile, OtherFilesAreNot) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_material(folder.file("none.crb")), InputError);
  EXPECT_THROW(is_material_file(folder.file("none.crb")), InputError);
  for (const std::string text : {"", "\n", "# only a comment\n", "Na 0 0 0\n", "atomesh-crtx 1\n", "PK\x03\x04"}) {
    write_bytes(folder.file("a.crb"), text);
    EXPECT_FALSE(is_material_file(folder.file("a.crb"))) << text;
    EXPECT_THROW(read_material(folder.file("a.crb")), InputError) << text;
  }
}

}  // namespace
}  // namespace atomesh
