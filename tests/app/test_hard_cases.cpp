// Inputs that break programs, taken the whole way: file → material → .crb → scene → all five pictures, by both
// renderers. One test a case; what is known about the case is checked on the way.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/camera.h"
#include "core/error.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "tests/support/lattices.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

constexpr double agreement = 2.0 / 255.0;

class HardCases : public testing::Test {
 protected:
  // Writes the atoms, preprocesses them, checks what holds for every material, and draws every mode.
  Material run(const Atoms& atoms, const std::optional<UnitCell>& cell = {}) {
    const std::string input = folder_.file("case.dat");
    write_atoms(input, atoms, cell);
    return run_file(input);
  }

  Material run_text(const std::string& text) {
    const std::string input = folder_.file("case.dat");
    test::write_bytes(input, text);
    return run_file(input);
  }

  Material run_file(const std::string& input) {
    const Material made = preprocess(input, {}, report_);
    EXPECT_EQ(validate(made.mesh), std::vector<std::string>{});
    EXPECT_EQ(validate(made.surface, made.mesh), std::vector<std::string>{});
    const std::string output = folder_.file("case.crb");
    write_material(output, made);
    for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms})
      draw(output, mode);
    return made;
  }

  void draw(const std::string& file, Mode mode) {
    Parameters parameters;
    parameters.mode = mode;
    const Material material = read_material(file, parts_needed(parameters));
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 48, 48);
    RenderStats stats;
    const Image fast = render(find_renderer("cpu"), scene, camera, parameters, stats);
    const Image judge = render(find_renderer("reference"), scene, camera, parameters, stats);
    const ImageDifference difference = compare_images(fast, judge, agreement);
    EXPECT_EQ(difference.pixels_over, 0U)
        << mode_name(mode) << ": largest difference " << difference.max * 255 << "/255";
    drawn_[static_cast<std::size_t>(mode)] = compare_images(fast, blank(camera, parameters)).max > 0.0;
  }

  static Image blank(const Camera& camera, const Parameters& parameters) {
    Image image(camera.width, camera.height);
    for (Vec4f& pixel : image.pixels) pixel = parameters.background;
    return image;
  }
  bool shows(Mode mode) const { return drawn_[static_cast<std::size_t>(mode)]; }

  test::TemporaryFolder folder_;
  PipelineReport report_;
  std::array<bool, 5> drawn_{};
};

TEST_F(HardCases, OneAtom) {
  const Material m = run(test::atoms_at({{1, 2, 3}}));
  EXPECT_TRUE(m.mesh.tetrahedra.empty());
  EXPECT_TRUE(shows(Mode::atoms));
  EXPECT_FALSE(shows(Mode::volume_surface));
}

TEST_F(HardCases, ThreeAtoms) {
  const Material m = run(test::atoms_at({{0, 0, 0}, {1.5, 0, 0}, {0, 1.5, 0}}));
  EXPECT_TRUE(m.mesh.tetrahedra.empty());
  EXPECT_TRUE(shows(Mode::atoms));
}

TEST_F(HardCases, FourCoplanarAtoms) {
  const Material m = run(test::atoms_at({{0, 0, 1}, {2, 0, 1}, {0, 2, 1}, {2, 2, 1}}));
  EXPECT_TRUE(m.mesh.tetrahedra.empty());
  EXPECT_TRUE(m.surface.triangles.empty());
}

TEST_F(HardCases, AllAtomsOnALine) {
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(0.1 * i, 0.2 * i, 0.3 * i);
  EXPECT_TRUE(run(test::atoms_at(line)).mesh.tetrahedra.empty());
}

TEST_F(HardCases, ExactDuplicatesAreMergedAndReported) {
  Atoms atoms = test::cut_block(test::lattice("nacl").cell, 2, 2, 2);
  const std::size_t distinct = atoms.size();
  std::vector<Index> twice;
  for (Index i = 0; i < distinct; ++i) {
    twice.push_back(i);
    if (i % 3 == 0) twice.push_back(i);
  }
  const Material m = run(atoms.subset(twice), test::lattice("nacl").cell);
  EXPECT_EQ(m.atoms.size(), distinct);
  EXPECT_EQ(report_.read.duplicates, twice.size() - distinct);
  for (std::size_t i = 0; i < m.atoms.size(); ++i) ASSERT_FALSE(m.defects.defective(i)) << i;
}

TEST_F(HardCases, CoordinatesOffsetByAMillionAngstrom) {
  Atoms atoms = test::cut_block(test::lattice("diamond").cell, 3, 3, 3);
  test::translate(atoms, Vec3(1e6, -1e6, 1e6));
  const Material m = run(atoms, test::lattice("diamond").cell);
  const Bounds bounds = bounds_of(m.atoms.positions);
  const Vec3 extent = bounds.extent();
  EXPECT_GT(m.mesh.tetrahedra.size(), m.atoms.size());
  EXPECT_LE(report_.volume, extent.x * extent.y * extent.z * (1 + 1e-9));
  for (std::size_t i = 0; i < m.atoms.size(); ++i) ASSERT_FALSE(m.defects.defective(i)) << i;
}

TEST_F(HardCases, NeedleShapedSample) {
  const Material m = run(test::cut_block(test::lattice("fcc").cell, 200, 1, 1), test::lattice("fcc").cell);
  EXPECT_GT(m.mesh.tetrahedra.size(), m.atoms.size());
  EXPECT_TRUE(shows(Mode::surface));
  for (std::size_t i = 0; i < m.atoms.size(); ++i) ASSERT_FALSE(m.defects.defective(i)) << i;
}

TEST_F(HardCases, DensityRatioOfAMillionToOne) {
  // 1,000 atoms within 1 Å, 1,000 within 100 Å.
  Atoms atoms = test::random_atoms(1000, 1.0, 1);
  const Atoms sparse = test::random_atoms(1000, 100.0, 2);
  for (const Vec3& p : sparse.positions) {
    atoms.positions.push_back(p);
    atoms.species.push_back(0);
  }
  EXPECT_GT(run(atoms).mesh.tetrahedra.size(), 1000U);
}

TEST_F(HardCases, TwoSpeciesOnOneSite) {
  const UnitCell& cell = test::lattice("fcc").cell;
  Atoms atoms = test::cut_block(cell, 4, 4, 4);
  const std::uint16_t foreign = atoms.add_species("N");
  Vec3 centre = bounds_of(atoms.positions).center();
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (glm::distance(atoms.positions[i], centre) < glm::distance(atoms.positions[nearest], centre)) nearest = i;
  }
  atoms.positions.push_back(atoms.positions[nearest]);
  atoms.species.push_back(foreign);
  const Material m = run(atoms, cell);
  EXPECT_EQ(m.atoms.size(), m.mesh.vertices.size() + 1);
  ASSERT_EQ(m.defects.extras.size(), 1U);
  EXPECT_EQ(m.defects.extras[0].atom, m.atoms.size() - 1);
  EXPECT_TRUE(m.defects.vacancies.empty());
}

TEST_F(HardCases, SingularCellIsRefusedByFileAndLine) {
  const std::string text =
      "primitive\n1 0 0\n0 1 0\n1 1 0\nbasis 1\nCu 0 0 0\nCu 0 0 0\nCu 1 0 0\nCu 0 1 0\nCu 0 0 1\n";
  try {
    run_text(text);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("case.dat:"), std::string::npos) << error.what();
  }
}

TEST_F(HardCases, LeftHandedCellIsACellLikeAnyOther) {
  UnitCell cell = test::lattice("nacl").cell;
  std::swap(cell.primitive[0], cell.primitive[1]);
  ASSERT_LT(glm::determinant(cell.matrix()), 0.0);
  const Material m = run(test::cut_block(test::lattice("nacl").cell, 3, 3, 3), cell);
  ASSERT_TRUE(m.defects.present());
  for (std::size_t i = 0; i < m.atoms.size(); ++i) ASSERT_FALSE(m.defects.defective(i)) << i;
}

TEST_F(HardCases, WrongCellIsSaidAndInventsNoSites) {
  UnitCell wrong = test::lattice("bcc").cell;
  wrong.basis.resize(1);
  wrong.basis[0].species = "Cu";
  Atoms atoms = test::cut_block(test::lattice("diamond").cell, 4, 4, 4);
  for (Species& species : atoms.species_table) species.name = "Cu";
  const Material m = run(atoms, wrong);
  EXPECT_FALSE(report_.defects.notes.empty()) << "nothing said about a cell that does not fit";
  EXPECT_LT(report_.defects.matched_fraction, 0.5);
  EXPECT_LE(m.defects.vacancies.size(), atoms.size() / 20);
}

}  // namespace
}  // namespace atomesh
