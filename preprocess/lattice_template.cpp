#include "preprocess/lattice_template.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "core/circumsphere.h"
#include "core/error.h"
#include "preprocess/neighbour_grid.h"
#include "preprocess/pull_polytope.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

// Cells a polytope may reach, so that offsets fit eight bits with room for differences.
constexpr int farthest_cell = 100;
constexpr std::size_t most_sites = 1'000'000;

struct Site {
  std::array<int, 3> cell{};
  std::uint16_t basis = 0;
};

Vec3 position_of(const UnitCell& cell, const Site& s) {
  return cell.matrix() * Vec3(s.cell[0], s.cell[1], s.cell[2]) + cell.basis[s.basis].position;
}

// Every site within `reach` of a site of cell (0, 0, 0); those of that cell first.
struct Block {
  std::vector<Site> sites;
  std::vector<Vec3> points;
};

Block cut_block(const UnitCell& cell, double reach) {
  const Mat3 inverse = glm::inverse(cell.matrix());
  std::array<int, 3> n{};
  double sites = static_cast<double>(cell.basis.size());
  for (int k = 0; k < 3; ++k) {
    // Rows of the inverse are the reciprocal vectors; home and neighbour lie up to a cell further apart.
    const double cells = std::ceil(reach * glm::length(Vec3(inverse[0][k], inverse[1][k], inverse[2][k]))) + 1.0;
    sites *= 2.0 * cells + 1.0;
    if (!(sites < static_cast<double>(most_sites))) {
      throw Error(
          "unit cell: its edges are too unequal, or its atoms too many, for the pattern of its crystal; give a"
          " cell with fewer atoms");
    }
    n[k] = static_cast<int>(cells);
  }
  Block block;
  const auto add = [&](const Site& s) {
    block.sites.push_back(s);
    block.points.push_back(position_of(cell, s));
  };
  for (std::size_t b = 0; b < cell.basis.size(); ++b) add({{0, 0, 0}, static_cast<std::uint16_t>(b)});
  Site s;
  for (s.cell[0] = -n[0]; s.cell[0] <= n[0]; ++s.cell[0]) {
    for (s.cell[1] = -n[1]; s.cell[1] <= n[1]; ++s.cell[1]) {
      for (s.cell[2] = -n[2]; s.cell[2] <= n[2]; ++s.cell[2]) {
        if (s.cell == std::array<int, 3>{}) continue;
        for (std::size_t b = 0; b < cell.basis.size(); ++b) {
          s.basis = static_cast<std::uint16_t>(b);
          const Vec3 p = position_of(cell, s);
          const bool near = std::any_of(cell.basis.begin(), cell.basis.end(), [&](const BasisAtom& home) {
            return glm::distance(home.position, p) <= reach;
          });
          if (near) add(s);
        }
      }
    }
  }
  return block;
}

// What a polytope shares with its translates: its corners as (basis atom, cell), ascending, the first one in cell
// (0, 0, 0).
using Name = std::vector<std::array<int, 4>>;

struct Class {
  Name name;
  std::array<int, 3> moved{};  // the cell that went to (0, 0, 0)
};

Class class_of(const std::vector<Index>& corners, const Block& block) {
  Class result;
  Name& name = result.name;
  for (const Index c : corners) {
    const Site& s = block.sites[c];
    name.push_back({s.basis, s.cell[0], s.cell[1], s.cell[2]});
  }
  std::sort(name.begin(), name.end());
  result.moved = {name[0][1], name[0][2], name[0][3]};
  for (auto& corner : name) {
    for (int k = 0; k < 3; ++k) corner[k + 1] -= result.moved[k];
  }
  return result;
}

double fatness(const Tetrahedron& t, std::span<const Vec3> p) {
  double longest = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) longest = std::max(longest, glm::distance(p[t[i]], p[t[j]]));
  }
  return signed_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) / (longest * longest * longest);
}

// The Delaunay tetrahedra at the sites of the cell, fat ones first: they know their sphere best.
std::vector<Tetrahedron> star_of_cell(const Block& block, std::size_t home) {
  std::vector<std::pair<double, Tetrahedron>> ordered;
  for (const Tetrahedron& t : delaunay_cgal(block.points, no_progress())) {
    if (std::any_of(t.begin(), t.end(), [&](Index v) { return v < home; })) {
      ordered.emplace_back(-fatness(t, block.points), t);
    }
  }
  std::sort(ordered.begin(), ordered.end());
  std::vector<Tetrahedron> star;
  for (const auto& [minus_fatness, t] : ordered) star.push_back(t);
  return star;
}

using Classes = std::map<Name, Sphere>;

// The polytopes at the sites of the cell. A sphere of at most half the block's reach that touches one of them lies in
// the block with all it could hold, so what is empty here is empty in the endless crystal. A fat tetrahedron names the
// polytope; the thin ones that rounding leaves are found to be parts of it.
Classes find_classes(const UnitCell& cell, const Block& block, const std::vector<Tetrahedron>& star, double reach,
                     double tolerance) {
  const std::size_t home = cell.basis.size();
  const NeighbourGrid grid(block.points, Box{}, reach, 0.25 * reach);
  std::vector<std::vector<std::vector<Index>>> at(home);  // each home site's polytopes, corners ascending
  Classes classes;
  std::vector<Index> slots;
  for (const Tetrahedron& tet : star) {
    const Index own = *std::min_element(tet.begin(), tet.end());
    const bool known = std::any_of(at[own].begin(), at[own].end(), [&](const std::vector<Index>& corners) {
      return std::all_of(tet.begin(), tet.end(),
                         [&](Index v) { return std::binary_search(corners.begin(), corners.end(), v); });
    });
    if (known) continue;
    const auto& p = block.points;
    const Sphere sphere = circumsphere(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]);
    if (!(2.0 * sphere.radius * (1.0 + tolerance) <= reach)) continue;
    grid.find(sphere.center, sphere.radius * (1.0 + tolerance), slots);
    std::vector<Index> corners;
    bool empty = true;
    for (const Index slot : slots) {
      const Index v = grid.point(slot);
      empty = empty && glm::distance(p[v], sphere.center) >= sphere.radius * (1.0 - tolerance);
      corners.push_back(v);
    }
    if (!empty || corners.size() < 4) continue;
    std::sort(corners.begin(), corners.end());
    for (const Index v : corners) {
      if (v < home) at[v].push_back(corners);
    }
    const Class c = class_of(corners, block);
    const Vec3 moved = cell.matrix() * Vec3(c.moved[0], c.moved[1], c.moved[2]);
    classes.emplace(c.name, Sphere{sphere.center - moved, sphere.radius});
  }
  return classes;
}

// Moves the basis into the cell spanned by reduced vectors.
LatticeTemplate reduced(const UnitCell& cell) {
  LatticeTemplate result;
  result.cell.primitive = reduce_lattice(cell.primitive);
  const Mat3 matrix = result.cell.matrix();
  const Mat3 inverse = glm::inverse(matrix);
  for (std::size_t b = 0; b < cell.basis.size(); ++b) {
    Vec3 fraction = inverse * cell.basis[b].position;
    fraction -= glm::floor(fraction);
    for (int k = 0; k < 3; ++k) fraction[k] = fraction[k] < 1.0 ? fraction[k] : 0.0;
    result.cell.basis.push_back({cell.basis[b].species, matrix * fraction});
    result.given_basis.push_back(static_cast<std::uint16_t>(b));
  }
  return result;
}

// Whether the classes fill space: together with being empty spheres of the whole crystal, that is what makes them its
// Delaunay complex. Fills in polytopes, direction and void.
bool assemble(LatticeTemplate& pattern, const Classes& classes) {
  pattern.polytopes.clear();
  pattern.largest_void = 0.0;
  std::vector<std::vector<Vec3>> corners;
  for (const auto& [name, sphere] : classes) {
    if (name.size() > pull_polytope_corners) {
      throw Error("unit cell: " + std::to_string(name.size()) +
                  " atoms of its crystal lie on one empty sphere; at most " + std::to_string(pull_polytope_corners) +
                  " can be meshed by pattern");
    }
    TemplatePolytope polytope;
    for (const auto& corner : name) {
      SiteOffset offset;
      offset.basis = static_cast<std::uint16_t>(corner[0]);
      for (int k = 0; k < 3; ++k) {
        if (std::abs(corner[k + 1]) > farthest_cell) {
          throw Error("unit cell: an empty sphere of its crystal reaches further than " +
                      std::to_string(farthest_cell) + " cells; its edges are too unequal");
        }
        offset.cell[k] = static_cast<std::int8_t>(corner[k + 1]);
      }
      polytope.corners.push_back(offset);
    }
    polytope.center = sphere.center;
    polytope.radius = sphere.radius;
    pattern.largest_void = std::max(pattern.largest_void, sphere.radius);
    corners.emplace_back();
    for (const SiteOffset& s : polytope.corners) corners.back().push_back(pattern.position(s));
    pattern.polytopes.push_back(std::move(polytope));
  }
  pattern.pulling_direction = find_pulling_direction(corners).direction;
  double sum = 0.0;
  for (std::size_t p = 0; p < corners.size(); ++p) {
    pattern.polytopes[p].tetrahedra = cut_polytope(corners[p], pattern.pulling_direction);
    for (const auto& t : pattern.polytopes[p].tetrahedra) {
      sum += signed_volume(corners[p][t[0]], corners[p][t[1]], corners[p][t[2]], corners[p][t[3]]);
    }
  }
  return std::abs(sum - pattern.cell.volume()) <= 1e-5 * pattern.cell.volume();
}

}  // namespace

PullingDirection find_pulling_direction(std::span<const std::vector<Vec3>> polytopes) {
  std::vector<Vec3> edges;
  for (const auto& corners : polytopes) {
    if (corners.size() < 5) continue;  // nothing to cut
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) edges.push_back(corners[j] - corners[i]);
    }
  }
  // Directions spread evenly over a hemisphere (Fibonacci's spiral), none of them special to any lattice.
  constexpr int trials = 2000;
  PullingDirection best;
  for (int n = 0; n < trials; ++n) {
    const double z = (n + 0.5) / trials;
    const double angle = n * std::numbers::pi * (3.0 - std::sqrt(5.0)) + 0.1;
    const double r = std::sqrt(1.0 - z * z);
    const Vec3 direction(r * std::cos(angle), r * std::sin(angle), z);
    double separation = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < edges.size() && separation > best.separation; ++e) {
      separation = std::min(separation, std::abs(glm::dot(direction, edges[e])));
    }
    if (separation > best.separation) best = {direction, separation};
  }
  return best;
}

std::vector<std::array<std::uint8_t, 4>> cut_polytope(std::span<const Vec3> corners, const Vec3& direction) {
  std::vector<Index> all(corners.size());
  std::iota(all.begin(), all.end(), Index{0});
  std::vector<Index> order = all;
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return glm::dot(corners[a], direction) < glm::dot(corners[b], direction); });
  std::vector<Index> rank(corners.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<Index>(i);
  // A cell given to six digits has faces that plane; a strained one keeps them.
  const double tolerance = 1e-4 * bounds_of(corners).diagonal();
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::array<std::uint8_t, 4>> result;
  if (!pull_polytope(all, corners, rank, tolerance, tetrahedra)) return result;
  for (const Tetrahedron& t : tetrahedra) {
    result.push_back({static_cast<std::uint8_t>(t[0]), static_cast<std::uint8_t>(t[1]), static_cast<std::uint8_t>(t[2]),
                      static_cast<std::uint8_t>(t[3])});
  }
  return result;
}

LatticeTemplate make_lattice_template(const UnitCell& cell) {
  check_unit_cell(cell);
  LatticeTemplate pattern = reduced(cell);
  // Half the diagonal bounds the covering radius of a reduced lattice (nearest-plane rounding reaches it at most), and
  // a basis only makes the voids smaller; mostly they are far smaller, so small blocks are tried first.
  double squares = 0.0;
  for (const Vec3& v : pattern.cell.primitive) squares += glm::dot(v, v);
  const double enough = 1.001 * std::sqrt(squares);
  const double spacing = std::cbrt(pattern.cell.volume() / static_cast<double>(cell.basis.size()));
  for (double reach = std::min(3.0 * spacing, enough);; reach = std::min(1.6 * reach, enough)) {
    const Block block = cut_block(pattern.cell, reach);
    const std::vector<Tetrahedron> star = star_of_cell(block, cell.basis.size());
    // What rounds a cell to six digits moves spheres by more than a millionth; where that joins too much or too little,
    // the volumes do not add up and another tolerance is tried.
    for (const double tolerance : {3e-6, 3e-5, 1e-7, 1e-9}) {
      if (assemble(pattern, find_classes(pattern.cell, block, star, reach, tolerance))) return pattern;
    }
    if (reach >= enough) break;
  }
  throw Error(
      "unit cell: the empty spheres of its crystal are too nearly equal to tell which atoms share one; give the"
      " cell with more digits");
}

}  // namespace atomesh
