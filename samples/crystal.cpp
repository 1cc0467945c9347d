#include "samples/crystal.h"

#include <cmath>

namespace atomesh {

namespace {

constexpr std::array<Vec3, 4> fcc_sites{Vec3(0, 0, 0), Vec3(0, 0.5, 0.5), Vec3(0.5, 0, 0.5), Vec3(0.5, 0.5, 0)};

UnitCell cubic_cell(double edge) {
  UnitCell cell;
  cell.primitive = {Vec3(edge, 0, 0), Vec3(0, edge, 0), Vec3(0, 0, edge)};
  return cell;
}

void add_fcc(UnitCell& cell, std::string_view species, const Vec3& offset) {
  const double edge = cell.primitive[0].x;
  for (const Vec3& site : fcc_sites) {
    const Vec3 p = site + offset;
    cell.basis.push_back({std::string(species), edge * (p - glm::floor(p))});
  }
}

}  // namespace

UnitCell fcc_cell(std::string_view species, double edge) {
  UnitCell cell = cubic_cell(edge);
  add_fcc(cell, species, Vec3(0.0));
  return cell;
}

UnitCell rock_salt_cell(std::string_view cation, std::string_view anion, double edge) {
  UnitCell cell = cubic_cell(edge);
  add_fcc(cell, cation, Vec3(0.0));
  add_fcc(cell, anion, Vec3(0.5, 0, 0));
  return cell;
}

UnitCell zinc_blende_cell(std::string_view first, std::string_view second, double edge) {
  UnitCell cell = cubic_cell(edge);
  add_fcc(cell, first, Vec3(0.0));
  add_fcc(cell, second, Vec3(0.25));
  return cell;
}

BlockShape choose_block(double cells, const Vec3& extent, const Vec3& proportions) {
  const Vec3 edges = proportions / extent;
  const Vec3 ideal = edges * std::cbrt(cells / (edges.x * edges.y * edges.z));
  const auto candidates = [](double n) {
    std::vector<std::size_t> result;
    const auto last = static_cast<std::size_t>(std::ceil(1.5 * n));
    for (auto i = static_cast<std::size_t>(std::max(1.0, std::floor(n / 1.5))); i <= last; ++i) result.push_back(i);
    return result;
  };
  const auto squared_log = [](double ratio) { return std::log(ratio) * std::log(ratio); };
  BlockShape best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const std::size_t x : candidates(ideal.x)) {
    for (const std::size_t y : candidates(ideal.y)) {
      const double area = static_cast<double>(x) * static_cast<double>(y);
      const double z = std::max(1.0, std::round(cells / area));
      const double cost = std::abs(area * z / cells - 1.0) +
                          0.003 * (squared_log(static_cast<double>(x) / ideal.x) +
                                   squared_log(static_cast<double>(y) / ideal.y) + squared_log(z / ideal.z));
      if (cost < best_cost) {
        best_cost = cost;
        best.cells = {x, y, static_cast<std::size_t>(z)};
      }
    }
  }
  return best;
}

Atoms build_block(const UnitCell& cell, const BlockShape& shape) {
  Atoms atoms;
  std::vector<std::uint16_t> species;
  for (const BasisAtom& site : cell.basis) species.push_back(atoms.add_species(site.species));
  atoms.positions.reserve(shape.total() * cell.basis.size());
  atoms.species.reserve(shape.total() * cell.basis.size());
  for (std::size_t k = 0; k < shape.cells[2]; ++k) {
    for (std::size_t j = 0; j < shape.cells[1]; ++j) {
      for (std::size_t i = 0; i < shape.cells[0]; ++i) {
        const Vec3 corner = static_cast<double>(i) * cell.primitive[0] + static_cast<double>(j) * cell.primitive[1] +
                            static_cast<double>(k) * cell.primitive[2];
        for (std::size_t b = 0; b < cell.basis.size(); ++b) {
          atoms.positions.push_back(corner + cell.basis[b].position);
          atoms.species.push_back(species[b]);
        }
      }
    }
  }
  return atoms;
}

Atoms without(const Atoms& atoms, const std::vector<bool>& removed) {
  std::vector<Index> kept;
  kept.reserve(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (!removed[i]) kept.push_back(static_cast<Index>(i));
  }
  return atoms.subset(kept);
}

}  // namespace atomesh
