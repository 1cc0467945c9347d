// The space group of a cell by spglib (A. Togo, I. Tanaka, https://arxiv.org/abs/1808.01590).
#include <spglib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "preprocess/find_unit_cell.h"
#include "preprocess/fitted_cell.h"

namespace atomesh {

namespace {

double degrees_between(const Vec3& a, const Vec3& b) {
  const double cosine = glm::dot(a, b) / (glm::length(a) * glm::length(b));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

}  // namespace

std::optional<SpaceGroup> find_space_group(const UnitCell& cell, double tolerance) {
  check_unit_cell(cell);
  const std::size_t count = cell.basis.size();
  std::vector<Vec3> sites;
  std::vector<std::string> names;
  std::vector<int> types;
  const Mat3 to_fraction = glm::inverse(cell.matrix());
  const std::unique_ptr<double[][3]> fractions(new double[count][3]);
  for (std::size_t i = 0; i < count; ++i) {
    const BasisAtom& atom = cell.basis[i];
    sites.push_back(atom.position);
    const Vec3 fraction = to_fraction * atom.position;
    for (int k = 0; k < 3; ++k) fractions[i][k] = fraction[k];
    auto name = std::find(names.begin(), names.end(), atom.species);
    if (name == names.end()) name = names.insert(names.end(), atom.species);
    types.push_back(static_cast<int>(name - names.begin()) + 1);
  }
  if (tolerance <= 0.0) tolerance = 0.02 * nearest_site_distance(cell.matrix(), sites);
  // spglib's rows are the Cartesian components, its columns the vectors.
  double lattice[3][3];
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) lattice[row][k] = cell.primitive[static_cast<std::size_t>(k)][row];
  }
  const std::unique_ptr<SpglibDataset, void (*)(SpglibDataset*)> dataset(
      spg_get_dataset(lattice, fractions.get(), types.data(), static_cast<int>(count), tolerance), spg_free_dataset);
  if (!dataset || dataset->spacegroup_number == 0) return std::nullopt;

  SpaceGroup group;
  group.number = dataset->spacegroup_number;
  group.symbol = dataset->international_symbol;
  group.point_group = dataset->pointgroup_symbol;
  for (std::string* text : {&group.symbol, &group.point_group}) {
    while (!text->empty() && text->back() == ' ') text->pop_back();
  }
  for (int k = 0; k < 3; ++k) {
    group.conventional.primitive[static_cast<std::size_t>(k)] =
        Vec3(dataset->std_lattice[0][k], dataset->std_lattice[1][k], dataset->std_lattice[2][k]);
  }
  for (int i = 0; i < dataset->n_std_atoms; ++i) {
    const Vec3 fraction(dataset->std_positions[i][0], dataset->std_positions[i][1], dataset->std_positions[i][2]);
    group.conventional.basis.push_back(
        {names.at(static_cast<std::size_t>(dataset->std_types[i] - 1)), group.conventional.matrix() * fraction});
  }
  const auto& v = group.conventional.primitive;
  group.a = glm::length(v[0]);
  group.b = glm::length(v[1]);
  group.c = glm::length(v[2]);
  group.alpha = degrees_between(v[1], v[2]);
  group.beta = degrees_between(v[2], v[0]);
  group.gamma = degrees_between(v[0], v[1]);
  return group;
}

}  // namespace atomesh
