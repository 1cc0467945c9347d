// What is foretold against what the stages take.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/memory.h"
#include "core/surface.h"
#include "preprocess/carve.h"
#include "preprocess/memory_needs.h"
#include "preprocess/simplify.h"
#include "preprocess/tetrahedralize.h"
#include "samples/planted_crystal.h"
#include "samples/samples.h"

namespace atomesh {
namespace {

// The bytes that `work` held at most beyond what was held when it began.
std::uint64_t taken_by(auto&& work) {
  release_free_memory();
  reset_peak_memory();
  const std::uint64_t before = current_memory();
  work();
  return recent_peak_memory() - before;
}

// Foretold is enough, and no more than three times too much and the fixed allowance.
void expect_enough(std::uint64_t foretold, std::uint64_t taken, const char* what) {
  EXPECT_LE(taken, foretold) << what;
  EXPECT_LE(foretold, 3 * taken + 40'000'000) << what;
}

TEST(MemoryNeeds, AreWhatTheStagesTake) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
#endif
  const Sample sample = make_sample("cu-line-defect", {.atoms = 200'000});
  const std::size_t atoms = sample.atoms.size();
  TetMesh mesh;
  const std::uint64_t meshing = taken_by([&] {
    TetrahedralizeReport report;
    mesh = tetrahedralize(sample.atoms, {.mesher = "delaunay"}, report);
  });
  expect_enough(memory_to_mesh("delaunay", atoms), meshing, "delaunay");

  const std::size_t vertices = mesh.vertices.size();
  const std::size_t tetrahedra = mesh.tetrahedra.size();
  CarveReport carve_report;
  const std::uint64_t carving = taken_by([&] { mesh = carve(std::move(mesh), {}, carve_report); });
  expect_enough(memory_to_carve(vertices, tetrahedra), carving, "carve");
  Surface surface;
  const std::uint64_t surfacing = taken_by([&] { surface = extract_surface(mesh); });
  expect_enough(memory_to_extract_surface(vertices, tetrahedra), surfacing, "extract_surface");
  SimplifyReport simplify_report;
  const std::size_t carved = mesh.tetrahedra.size();
  const std::uint64_t simplifying = taken_by([&] { simplify(mesh, surface, sample.atoms, {}, {}, simplify_report); });
  expect_enough(memory_to_simplify(vertices, carved), simplifying, "simplify");
}

TEST(MemoryNeeds, StampingTakesAFractionOfThat) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
#endif
  const Sample sample = make_planted_crystal({.structure = "rock-salt", .atoms = 200'000, .vacancies = 20});
  TetrahedralizeReport report;
  const std::uint64_t stamping = taken_by([&] {
    const TetMesh mesh = tetrahedralize(sample.atoms, {{*sample.unit_cell}, {}}, 0.0, {.mesher = "pattern"}, report);
  });
  EXPECT_EQ(report.mesher, "pattern");
  // What is kept ready for surfaces and defects, which this sample has few of.
  EXPECT_LE(stamping, memory_to_mesh("pattern", sample.atoms.size()));
  EXPECT_LE(stamping, memory_to_mesh("delaunay", sample.atoms.size()) / 2);
}

TEST(MemoryNeeds, GrowWithTheCounts) {
  EXPECT_LT(memory_to_read(1'000'000, 0, false), memory_to_read(1'000'000, 3, false));
  EXPECT_LT(memory_to_read(1'000'000, 3, false), memory_to_read(1'000'000, 3, true));
  for (const char* mesher : {"delaunay", "tetgen", "pattern"}) {
    EXPECT_NEAR(static_cast<double>(memory_to_mesh(mesher, 100'000'000)) /
                    static_cast<double>(memory_to_mesh(mesher, 10'000'000)),
                10.0, 0.1);
  }
  // The promises for a million atoms (4 GB) and for ten million (a machine of 24 GB).
  EXPECT_LT(memory_to_mesh("delaunay", 1'000'000), 4'000'000'000U);
  EXPECT_LT(memory_to_mesh("delaunay", 10'000'000), 20'000'000'000U);
}

TEST(MemoryNeeds, WhatDoesNotFitIsRefused) {
  try {
    require_memory_for("carve", 12'345'678, "tetrahedra", std::uint64_t{1} << 60);
    FAIL();
  } catch (const UnavailableError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("carve of 12,345,678 tetrahedra needs"), std::string::npos) << text;
    EXPECT_NE(text.find("--keep-every"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace atomesh
