// The space group of a cell by spglib (A. Togo, I. Tanaka, https://arxiv.org/abs/1808.01590).
#include <spglib.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

using Dataset = std::unique_ptr<SpglibDataset, void (*)(SpglibDataset*)>;

// What spglib says; `fractions` are the basis atoms', `names` the species that its types 1, 2, … stand for.
Dataset look_up(const UnitCell& cell, double tolerance, std::vector<Vec3>& fractions, std::vector<std::string>& names) {
  check_unit_cell(cell);
  const std::size_t count = cell.basis.size();
  std::vector<int> types;
  const Mat3 to_fraction = glm::inverse(cell.matrix());
  const std::unique_ptr<double[][3]> places(new double[count][3]);
  for (std::size_t i = 0; i < count; ++i) {
    const BasisAtom& atom = cell.basis[i];
    fractions.push_back(to_fraction * atom.position);
    for (int k = 0; k < 3; ++k) places[i][k] = fractions[i][k];
    auto name = std::find(names.begin(), names.end(), atom.species);
    if (name == names.end()) name = names.insert(names.end(), atom.species);
    types.push_back(static_cast<int>(name - names.begin()) + 1);
  }
  // spglib's rows are the Cartesian components, its columns the vectors.
  double lattice[3][3];
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) lattice[row][k] = cell.primitive[static_cast<std::size_t>(k)][row];
  }
  return {spg_get_dataset(lattice, places.get(), types.data(), static_cast<int>(count), tolerance), spg_free_dataset};
}

double nearest_distance(const UnitCell& cell) {
  std::vector<Vec3> sites;
  for (const BasisAtom& atom : cell.basis) sites.push_back(atom.position);
  return nearest_site_distance(cell.matrix(), sites);
}

// The upper triangular matrix with non-negative diagonal whose columns have these scalar products.
Mat3 vectors_of(const Mat3& metric) {
  Mat3 u(0.0);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      double sum = metric[j][i];
      for (int k = 0; k < i; ++k) sum -= u[i][k] * u[j][k];
      u[j][i] = i == j ? std::sqrt(std::max(sum, 0.0)) : sum / u[i][i];
    }
  }
  return u;
}

}  // namespace

std::optional<UnitCell> symmetrized(const UnitCell& cell, double tolerance) {
  std::vector<Vec3> fractions;
  std::vector<std::string> names;
  const Dataset dataset = look_up(cell, tolerance, fractions, names);
  if (!dataset || dataset->spacegroup_number == 0) return std::nullopt;

  const std::size_t count = fractions.size();
  const Mat3 vectors = cell.matrix();
  const Mat3 metric = glm::transpose(vectors) * vectors;
  Mat3 mean_metric(0.0);
  std::vector<Vec3> sum(count, Vec3(0.0));
  std::vector<double> terms(count, 0.0);
  for (int n = 0; n < dataset->n_operations; ++n) {
    Mat3 rotation(0.0);
    Vec3 translation(0.0);
    for (int row = 0; row < 3; ++row) {
      translation[row] = dataset->translations[n][row];
      for (int column = 0; column < 3; ++column) rotation[column][row] = dataset->rotations[n][row][column];
    }
    mean_metric += glm::transpose(rotation) * metric * rotation;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 image = rotation * fractions[i] + translation;
      std::size_t nearest = count;
      Vec3 shift(0.0);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < count; ++j) {
        if (cell.basis[j].species != cell.basis[i].species) continue;
        Vec3 d = image - fractions[j];
        d -= glm::round(d);
        const double distance = glm::length(vectors * d);
        if (distance >= least) continue;
        least = distance;
        nearest = j;
        shift = d;
      }
      if (nearest == count || least > 4.0 * tolerance) return std::nullopt;
      sum[nearest] += fractions[nearest] + shift;
      terms[nearest] += 1.0;
    }
  }
  mean_metric *= 1.0 / dataset->n_operations;

  const Mat3 standing = vectors_of(mean_metric);
  const Mat3 lattice = rotation_of(vectors * glm::inverse(standing)) * standing;
  UnitCell result = cell;
  for (std::size_t k = 0; k < 3; ++k) {
    result.primitive[k] = lattice[static_cast<int>(k)];
    if (!(glm::distance(result.primitive[k], cell.primitive[k]) <= 4.0 * tolerance)) return std::nullopt;
  }
  for (std::size_t i = 0; i < count; ++i) {
    result.basis[i].position = lattice * (sum[i] / terms[i] - sum[0] / terms[0] + fractions[0]);
  }
  return result;
}

std::optional<SpaceGroup> find_space_group(const UnitCell& cell, double tolerance) {
  if (tolerance <= 0.0) {
    check_unit_cell(cell);
    tolerance = 0.02 * nearest_distance(cell);
  }
  std::vector<Vec3> fractions;
  std::vector<std::string> names;
  const Dataset dataset = look_up(cell, tolerance, fractions, names);
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
