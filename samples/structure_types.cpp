#include "samples/structure_types.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "samples/crystal.h"

namespace atomesh {

namespace {

// A cell from edges and the angle between a and b (90° or 120°), its basis in fractions of the vectors.
UnitCell make_cell(double a, double b, double c, bool hexagonal, const std::vector<BasisAtom>& fractional) {
  UnitCell cell;
  cell.primitive = {Vec3(a, 0, 0), hexagonal ? Vec3(-0.5 * b, 0.5 * std::numbers::sqrt3 * b, 0) : Vec3(0, b, 0),
                    Vec3(0, 0, c)};
  for (const BasisAtom& atom : fractional) {
    cell.basis.push_back({atom.species, cell.matrix() * (atom.position - glm::floor(atom.position))});
  }
  return cell;
}

UnitCell cubic(double a, const std::vector<BasisAtom>& fractional) {
  return make_cell(a, a, a, false, fractional);
}

UnitCell fluorite_cell(double a) {
  UnitCell cell = fcc_cell("Ca", a);
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    cell.basis.push_back({"F", a * (0.25 + 0.5 * corner)});
  }
  return cell;
}

UnitCell rutile_cell(double a, double c, double u) {
  return make_cell(a, a, c, false,
                   {{"Ti", {0, 0, 0}},
                    {"Ti", {0.5, 0.5, 0.5}},
                    {"O", {u, u, 0}},
                    {"O", {-u, -u, 0}},
                    {"O", {0.5 + u, 0.5 - u, 0.5}},
                    {"O", {0.5 - u, 0.5 + u, 0.5}}});
}

std::vector<StructureType> make_structure_types() {
  constexpr double third = 1.0 / 3.0;
  std::vector<StructureType> types{
      {"fcc", "Cu", fcc_cell("Cu", 3.6149), 225, "Fm-3m", 1, 0.0, "Ni", "Straumanis and Yu 1969"},
      {"bcc", "Fe", cubic(2.8665, {{"Fe", {0, 0, 0}}, {"Fe", {0.5, 0.5, 0.5}}}), 229, "Im-3m", 1, 0.0, "Cr",
       "Wyckoff, Crystal Structures, 1963"},
      {"hcp", "Mg",
       make_cell(3.2094, 3.2094, 5.2105, true, {{"Mg", {third, 2 * third, 0.25}}, {"Mg", {2 * third, third, 0.75}}}),
       194, "P6_3/mmc", 2, 0.0, "Al", "von Batchelder and Raeuchle 1957"},
      {"diamond", "C", zinc_blende_cell("C", "C", 3.56684), 227, "Fd-3m", 2, 0.0, "N", "Straumanis and Aka 1951"},
      {"zinc-blende", "GaAs", zinc_blende_cell("Ga", "As", 5.65325), 216, "F-43m", 2, 0.0, "In", "Blakemore 1982"},
      {"rock-salt", "NaCl", rock_salt_cell("Na", "Cl", 5.6402), 225, "Fm-3m", 2, 0.0, "K", "Swanson and Fuyat 1953"},
      {"cscl", "CsCl", cubic(4.123, {{"Cs", {0, 0, 0}}, {"Cl", {0.5, 0.5, 0.5}}}), 221, "Pm-3m", 2, 0.0, "Rb",
       "Wyckoff, Crystal Structures, 1963"},
      {"perovskite", "SrTiO3",
       cubic(3.905, {{"Sr", {0, 0, 0}},
                     {"Ti", {0.5, 0.5, 0.5}},
                     {"O", {0.5, 0.5, 0}},
                     {"O", {0.5, 0, 0.5}},
                     {"O", {0, 0.5, 0.5}}}),
       221, "Pm-3m", 5, 0.0, "Ba", "Swanson and Fuyat 1954"},
      {"graphite", "C",
       make_cell(2.464, 2.464, 6.711, true,
                 {{"C", {0, 0, 0.25}},
                  {"C", {0, 0, 0.75}},
                  {"C", {third, 2 * third, 0.25}},
                  {"C", {2 * third, third, 0.75}}}),
       194, "P6_3/mmc", 4, 0.0, "B", "Trucano and Chen 1975"},
      {"fluorite", "CaF2", fluorite_cell(5.46295), 225, "Fm-3m", 3, 0.0, "Sr", "Wyckoff, Crystal Structures, 1963"},
      {"wurtzite", "GaN",
       make_cell(3.190, 3.190, 5.189, true,
                 {{"Ga", {third, 2 * third, 0}},
                  {"Ga", {2 * third, third, 0.5}},
                  {"N", {third, 2 * third, 0.377}},
                  {"N", {2 * third, third, 0.877}}}),
       186, "P6_3mc", 4, 0.0, "Al", "Schulz and Thiemann 1977"},
      {"rutile", "TiO2", rutile_cell(4.593659, 2.958682, 0.30479), 136, "P4_2/mnm", 6, 0.0, "Zr",
       "Abrahams and Bernstein 1971"},
  };
  for (StructureType& type : types) type.nearest_neighbour = nearest_neighbour_distance(type.cell);
  return types;
}

// Every atom of the endless crystal within `reach` of `centre`.
std::vector<Vec3> atoms_near(const UnitCell& cell, const Vec3& centre, double reach) {
  const Mat3 to_cells = glm::inverse(cell.matrix());
  std::array<int, 3> n{};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row(to_cells[0][axis], to_cells[1][axis], to_cells[2][axis]);
    n[axis] = static_cast<int>(std::ceil(reach * glm::length(row))) + 1;
  }
  std::vector<Vec3> found;
  for (const BasisAtom& atom : cell.basis) {
    const Vec3 base = glm::round(to_cells * (centre - atom.position));
    for (int i = -n[0]; i <= n[0]; ++i) {
      for (int j = -n[1]; j <= n[1]; ++j) {
        for (int k = -n[2]; k <= n[2]; ++k) {
          const Vec3 p = atom.position + cell.matrix() * (base + Vec3(i, j, k));
          if (glm::distance(p, centre) <= reach) found.push_back(p);
        }
      }
    }
  }
  return found;
}

double nearest(const std::vector<Vec3>& atoms, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec3& a : atoms) best = std::min(best, glm::distance(a, p));
  return best;
}

// The sphere's centre relative to the first of four corners; false when they lie nearly in a plane.
bool centre_of(const Vec3& b, const Vec3& c, const Vec3& d, Vec3& centre) {
  const double volume = glm::dot(b, glm::cross(c, d));
  if (std::abs(volume) < 1e-6 * glm::length(b) * glm::length(c) * glm::length(d)) return false;
  centre = (glm::dot(b, b) * glm::cross(c, d) + glm::dot(c, c) * glm::cross(d, b) + glm::dot(d, d) * glm::cross(b, c)) /
           (2.0 * volume);
  return true;
}

}  // namespace

const std::vector<StructureType>& structure_types() {
  static const std::vector<StructureType> types = make_structure_types();
  return types;
}

const StructureType& find_structure_type(std::string_view name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const StructureType& type : structure_types()) {
    if (type.name == name) return type;
    names.push_back(type.name);
    all.append(all.empty() ? "" : ", ").append(type.name);
  }
  const std::string near = nearest_name(name, names);
  throw UsageError("no structure is called \"" + std::string(name) + "\"" +
                   (near.empty() ? "" : "; did you mean \"" + near + "\"?") + " (there are " + all + ")");
}

double nearest_neighbour_distance(const UnitCell& cell) {
  const double reach = 1.001 * glm::length(reduce_lattice(cell.primitive)[0]);  // its own image is no further
  double best = std::numeric_limits<double>::infinity();
  for (const BasisAtom& atom : cell.basis) {
    for (const Vec3& p : atoms_near(cell, atom.position, reach)) {
      const double d = glm::distance(p, atom.position);
      if (d > 1e-6) best = std::min(best, d);
    }
  }
  return best;
}

LargestVoids largest_voids(const UnitCell& cell) {
  // No void is larger than what a grid finds and the way from a void to the grid.
  constexpr int steps = 12;
  const double diagonal =
      glm::length(cell.primitive[0]) + glm::length(cell.primitive[1]) + glm::length(cell.primitive[2]);
  const std::vector<Vec3> around = atoms_near(cell, cell.matrix() * Vec3(0.5), diagonal);
  double coarse = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      for (int k = 0; k < steps; ++k) {
        coarse = std::max(coarse, nearest(around, cell.matrix() * (Vec3(i, j, k) / static_cast<double>(steps))));
      }
    }
  }
  const double largest = coarse + 0.5 * diagonal / steps;

  LargestVoids voids;
  const Mat3 to_cells = glm::inverse(cell.matrix());
  const auto offer = [&](const Vec3& centre, double radius) {
    constexpr double tolerance = 1e-6;  // Å
    if (radius < voids.radius - tolerance) return;
    if (radius > voids.radius + tolerance) voids = {{}, radius};
    Vec3 f = to_cells * centre;
    for (int axis = 0; axis < 3; ++axis) {
      f[axis] -= std::floor(f[axis]);
      if (f[axis] > 1.0 - 1e-6 || f[axis] < 1e-6) f[axis] = 0.0;
    }
    const Vec3 p = cell.matrix() * f;
    const bool known = std::any_of(voids.positions.begin(), voids.positions.end(),
                                   [&](const Vec3& q) { return glm::distance(p, q) < 1e-4; });
    if (!known) voids.positions.push_back(p);
  };
  for (const BasisAtom& first : cell.basis) {
    std::vector<Vec3> near = atoms_near(cell, first.position, 2.0 * largest);
    for (Vec3& p : near) p -= first.position;
    std::erase_if(near, [](const Vec3& p) { return glm::length(p) < 1e-6; });
    for (std::size_t b = 0; b < near.size(); ++b) {
      for (std::size_t c = b + 1; c < near.size(); ++c) {
        for (std::size_t d = c + 1; d < near.size(); ++d) {
          Vec3 centre;
          if (!centre_of(near[b], near[c], near[d], centre)) continue;
          const double radius = glm::length(centre);
          if (radius < voids.radius - 1e-6 || radius > largest) continue;
          if (nearest(near, centre) > radius - 1e-6) offer(first.position + centre, radius);
        }
      }
    }
  }
  std::sort(voids.positions.begin(), voids.positions.end(), [](const Vec3& a, const Vec3& b) {
    return std::array{a.z, a.y, a.x} < std::array{b.z, b.y, b.x};
  });
  return voids;
}

}  // namespace atomesh
