#include "tests/support/lattices.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace atomesh::test {

namespace {

struct FractionalAtom {
  const char* species;
  Vec3 position;  // in units of the cell's edges
};

Lattice cubic(const std::string& name, double edge, const std::vector<FractionalAtom>& basis, double nearest) {
  Lattice lattice{name, {}, nearest};
  lattice.cell.primitive = {Vec3(edge, 0, 0), Vec3(0, edge, 0), Vec3(0, 0, edge)};
  for (const auto& atom : basis) lattice.cell.basis.push_back({atom.species, atom.position * edge});
  return lattice;
}

Lattice graphite() {
  const double a = 2.461;
  const double c = 6.708;
  const double h = a * std::sqrt(3.0) / 2.0;
  Lattice lattice{"graphite", {}, a / std::sqrt(3.0)};
  lattice.cell.primitive = {Vec3(a, 0, 0), Vec3(-a / 2, h, 0), Vec3(0, 0, c)};
  // Bernal (AB) stacking: the second layer is shifted by one bond.
  lattice.cell.basis = {
      {"C", Vec3(0, 0, 0)}, {"C", Vec3(0, 2 * h / 3, 0)}, {"C", Vec3(0, 0, c / 2)}, {"C", Vec3(a / 2, h / 3, c / 2)}};
  return lattice;
}

std::vector<Lattice> make_lattices() {
  const double si = 5.431;
  const std::vector<FractionalAtom> fcc{
      {"Cu", {0, 0, 0}}, {"Cu", {0, 0.5, 0.5}}, {"Cu", {0.5, 0, 0.5}}, {"Cu", {0.5, 0.5, 0}}};
  std::vector<FractionalAtom> diamond;
  std::vector<FractionalAtom> nacl;
  for (const auto& atom : fcc) {
    diamond.push_back({"Si", atom.position});
    nacl.push_back({"Na", atom.position});
  }
  for (const auto& atom : fcc) {
    diamond.push_back({"Si", atom.position + Vec3(0.25)});
    nacl.push_back({"Cl", glm::mod(atom.position + Vec3(0.5), Vec3(1.0))});
  }
  return {cubic("sc", 3.35, {{"Po", {0, 0, 0}}}, 3.35),
          cubic("fcc", 3.615, fcc, 3.615 * std::sqrt(0.5)),
          cubic("bcc", 2.866, {{"Fe", {0, 0, 0}}, {"Fe", {0.5, 0.5, 0.5}}}, 2.866 * std::sqrt(0.75)),
          cubic("diamond", si, diamond, si * std::sqrt(3.0) / 4.0),
          cubic("nacl", 5.64, nacl, 2.82),
          graphite(),
          cubic("perovskite", 3.905,
                {{"Sr", {0, 0, 0}},
                 {"Ti", {0.5, 0.5, 0.5}},
                 {"O", {0.5, 0.5, 0}},
                 {"O", {0.5, 0, 0.5}},
                 {"O", {0, 0.5, 0.5}}},
                1.9525)};
}

void add(Atoms& atoms, const std::string& species, const Vec3& position) {
  atoms.species.push_back(atoms.add_species(species));
  atoms.positions.push_back(position);
}

}  // namespace

const std::vector<Lattice>& lattices() {
  static const std::vector<Lattice> all = make_lattices();
  return all;
}

const Lattice& lattice(const std::string& name) {
  for (const Lattice& candidate : lattices()) {
    if (candidate.name == name) return candidate;
  }
  throw std::out_of_range("no lattice " + name);
}

Vec3 site(const UnitCell& cell, std::size_t b, int i, int j, int k) {
  return cell.basis[b].position + static_cast<double>(i) * cell.primitive[0] +
         static_cast<double>(j) * cell.primitive[1] + static_cast<double>(k) * cell.primitive[2];
}

Atoms cut_block(const UnitCell& cell, int na, int nb, int nc) {
  Atoms atoms;
  for (int i = 0; i < na; ++i) {
    for (int j = 0; j < nb; ++j) {
      for (int k = 0; k < nc; ++k) {
        for (std::size_t b = 0; b < cell.basis.size(); ++b) add(atoms, cell.basis[b].species, site(cell, b, i, j, k));
      }
    }
  }
  return atoms;
}

Atoms periodic_block(const UnitCell& cell, int na, int nb, int nc) {
  Atoms atoms = cut_block(cell, na, nb, nc);
  atoms.box.vectors = {static_cast<double>(na) * cell.primitive[0], static_cast<double>(nb) * cell.primitive[1],
                       static_cast<double>(nc) * cell.primitive[2]};
  atoms.box.periodic = {true, true, true};
  return atoms;
}

Atoms cut_sphere(const UnitCell& cell, double radius) {
  return cut_where(cell, Vec3(radius), [&](const Vec3& p) { return glm::length(p) <= radius; });
}

Atoms cut_where(const UnitCell& cell, const Vec3& half_size, const std::function<bool(const Vec3&)>& keep) {
  // Cells far enough along each vector to cover the block's corners.
  const Mat3 to_cells = glm::inverse(cell.matrix());
  const double reach = glm::length(half_size);
  std::array<int, 3> n{};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row(to_cells[0][axis], to_cells[1][axis], to_cells[2][axis]);
    n[axis] = static_cast<int>(std::ceil(reach * glm::length(row))) + 1;
  }
  Atoms atoms;
  for (int i = -n[0]; i <= n[0]; ++i) {
    for (int j = -n[1]; j <= n[1]; ++j) {
      for (int k = -n[2]; k <= n[2]; ++k) {
        for (std::size_t b = 0; b < cell.basis.size(); ++b) {
          const Vec3 p = site(cell, b, i, j, k);
          if (glm::all(glm::lessThanEqual(glm::abs(p), half_size)) && keep(p)) add(atoms, cell.basis[b].species, p);
        }
      }
    }
  }
  return atoms;
}

Atoms atoms_at(std::vector<Vec3> positions, const std::string& species) {
  Atoms atoms;
  atoms.species.assign(positions.size(), atoms.add_species(species));
  atoms.positions = std::move(positions);
  return atoms;
}

Atoms random_atoms(std::size_t count, double size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, size);
  std::vector<Vec3> positions(count);
  for (Vec3& p : positions) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = uniform(generator);
  }
  return atoms_at(std::move(positions));
}

Vec3 remove_nearest(Atoms& atoms, const Vec3& position) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return glm::length(a - position) < glm::length(b - position);
  };
  const auto found = std::min_element(atoms.positions.begin(), atoms.positions.end(), nearer);
  const Vec3 removed = *found;
  atoms.species.erase(atoms.species.begin() + (found - atoms.positions.begin()));
  atoms.positions.erase(found);
  return removed;
}

void shake(Atoms& atoms, double amplitude, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  for (Vec3& p : atoms.positions) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += uniform(generator);
  }
}

void translate(Atoms& atoms, const Vec3& offset) {
  for (Vec3& p : atoms.positions) p += offset;
}

Mat3 odd_rotation() {
  const double a = 0.4711;
  const double b = 0.8153;
  const Mat3 about_z(std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1);
  const Mat3 about_x(1, 0, 0, 0, std::cos(b), std::sin(b), 0, -std::sin(b), std::cos(b));
  return about_z * about_x;
}

void transform(Atoms& atoms, const Mat3& matrix) {
  for (Vec3& p : atoms.positions) p = matrix * p;
}

Atoms shuffled(const Atoms& atoms, std::uint64_t seed) {
  std::vector<std::size_t> order(atoms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 generator(seed);
  std::shuffle(order.begin(), order.end(), generator);
  Atoms result = atoms;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.positions[i] = atoms.positions[order[i]];
    result.species[i] = atoms.species[order[i]];
  }
  return result;
}

}  // namespace atomesh::test
