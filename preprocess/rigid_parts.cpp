#include "preprocess/rigid_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/site_finder.h"

namespace atomesh {

namespace {

constexpr std::size_t most_asked = 10'000, most_asked_around = 3'000;
// Share of the differences that must crowd about one value.
constexpr double crowd = 0.3;
// Pieces of fewer atoms, as a share of those asked, are not looked for.
constexpr double least_piece = 0.005;
constexpr std::size_t most_pieces = 16;
constexpr double piece_grid = 1e-3;  // nearest-neighbour distances: atoms of one piece lie nearer together than that
constexpr std::size_t points_per_range = 1 << 15;

// The middle of the narrowest interval that holds a `crowd` of the values.
double crowded_value(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const auto wide = static_cast<std::size_t>(crowd * static_cast<double>(values.size()));
  double best = 0.0;
  double width = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n + wide < values.size(); ++n) {
    if (values[n + wide] - values[n] >= width) continue;
    width = values[n + wide] - values[n];
    best = values[n + wide / 2];
  }
  return best;
}

Vec3 crowded_value(const std::vector<Vec3>& vectors) {
  Vec3 result;
  std::vector<double> values(vectors.size());
  for (int k = 0; k < 3; ++k) {
    std::transform(vectors.begin(), vectors.end(), values.begin(), [k](const Vec3& v) { return v[k]; });
    result[k] = crowded_value(values);
  }
  return result;
}

Vec3 cell_of(const LatticeSite& site) {
  return {site.cell[0], site.cell[1], site.cell[2]};
}

// Evenly chosen atoms of the patch.
std::vector<Index> choose(const LatticeSites& sites, std::uint16_t patch, std::size_t most = most_asked) {
  std::vector<Index> chosen;
  const std::size_t stride = sites.patches[patch].atoms / most + 1;
  std::size_t n = 0;
  for (std::size_t i = 0; i < sites.of.size(); ++i) {
    if (sites.of[i].patch == patch && n++ % stride == 0) chosen.push_back(static_cast<Index>(i));
  }
  return chosen;
}

// False where there are too few neighbours to tell.
bool find_lattice(std::span<const Vec3> points, const LatticeSites& sites, const SiteTable& table,
                  std::span<const Index> chosen, RigidLattice& lattice) {
  constexpr std::size_t enough = 20;
  const std::size_t basis = sites.patterns[sites.patches[lattice.patch].pattern].cell.basis.size();
  lattice.offsets.assign(basis, Vec3(0.0));
  // The three vectors, then the offsets of the basis atoms after the first.
  std::vector<std::uint8_t> known(basis + 2, 0);
  parallel_for(known.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3> differences;
    for (std::size_t n = begin; n < end; ++n) {
      differences.clear();
      for (const Index i : chosen) {
        const LatticeSite& site = sites.of[i];
        Index from = i;
        Index to = no_index;
        if (n < 3) {
          auto cell = site.cell;
          ++cell[n];
          to = table.atom(cell, site.basis);
        } else {
          from = table.atom(site.cell, 0);
          if (from != no_index) to = table.atom(site.cell, static_cast<std::uint16_t>(n - 2));
        }
        if (to != no_index) differences.push_back(points[to] - points[from]);
      }
      known[n] = differences.size() < enough ? 0 : 1;
      if (known[n] == 0) continue;
      Vec3& result = n < 3 ? lattice.matrix[static_cast<glm::length_t>(n)] : lattice.offsets[n - 2];
      result = crowded_value(differences);
    }
  });
  if (std::find(known.begin(), known.end(), 0) != known.end()) return false;
  return std::abs(glm::determinant(lattice.matrix)) > 0.0;
}

Vec3 origin_of(const Vec3& point, const LatticeSite& site, const RigidLattice& lattice) {
  return point - lattice.matrix * cell_of(site) - lattice.offsets[site.basis];
}

// Where atoms crowd when each is moved back to its site of cell (0, 0, 0).
void find_pieces(std::span<const Vec3> points, const LatticeSites& sites, std::span<const Index> chosen, double nearest,
                 RigidLattice& lattice) {
  using Key = std::array<std::int64_t, 3>;
  const double grid = piece_grid * nearest;
  std::map<Key, std::vector<Vec3>> cells;
  const Vec3 first = origin_of(points[chosen[0]], sites.of[chosen[0]], lattice);
  for (const Index i : chosen) {
    const Vec3 origin = origin_of(points[i], sites.of[i], lattice);
    Key key;
    for (int k = 0; k < 3; ++k) key[k] = std::llround((origin[k] - first[k]) / grid);
    cells[key].push_back(origin);
  }
  std::vector<std::pair<std::size_t, Vec3>> found;
  const double least = std::max(50.0, least_piece * static_cast<double>(chosen.size()));
  for (const auto& [key, origins] : cells) {
    if (static_cast<double>(origins.size()) < least) continue;
    const Vec3 middle = crowded_value(origins);
    const auto same = std::find_if(found.begin(), found.end(), [&](const auto& piece) {
      return glm::distance(piece.second, middle) < rigid_tolerance * nearest;
    });
    if (same == found.end()) {
      found.emplace_back(origins.size(), middle);
    } else {
      same->first += origins.size();  // a piece on the border of two cells
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (found.size() > most_pieces) found.resize(most_pieces);
  for (const auto& [count, origin] : found) lattice.origins.push_back(origin);
}

// How far the nearest piece's site is, squared, and which piece.
std::pair<double, std::size_t> nearest_piece(const Vec3& origin, const std::vector<Vec3>& origins) {
  std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t n = 0; n < origins.size(); ++n) {
    const Vec3 d = origin - origins[n];
    if (glm::dot(d, d) < best.first) best = {glm::dot(d, d), n};
  }
  return best;
}

// Which piece an atom belongs to, to rounding; none: the number of pieces.
std::size_t piece_of(Index atom, std::span<const Vec3> points, const LatticeSites& sites, const RigidLattice& lattice,
                     double limit) {
  const auto [squared, piece] = nearest_piece(origin_of(points[atom], sites.of[atom], lattice), lattice.origins);
  return squared <= limit ? piece : lattice.origins.size();
}

// For how many of the atoms the answer is yes.
template <class Asked>
std::size_t count_of(std::span<const Index> atoms, const Asked& asked) {
  constexpr std::size_t atoms_per_range = 512;
  std::vector<std::size_t> part((atoms.size() + atoms_per_range - 1) / atoms_per_range, 0);
  parallel_for(atoms.size(), atoms_per_range, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (const Index i : atoms.subspan(begin, end - begin)) count += asked(i) ? 1 : 0;
    part[begin / atoms_per_range] = count;
  });
  return std::accumulate(part.begin(), part.end(), std::size_t{0});
}

// How many of the atoms have every polytope around them whole and in place.
std::size_t count_undisturbed(std::span<const Vec3> points, const LatticeSites& sites, const SiteTable& table,
                              std::span<const Index> chosen, const RigidLattice& lattice, double limit) {
  const LatticeTemplate& pattern = sites.patterns[sites.patches[lattice.patch].pattern];
  // Of each basis atom: the other corners of its polytopes, counted from it.
  std::vector<std::vector<SiteOffset>> around(pattern.cell.basis.size());
  for (const TemplatePolytope& polytope : pattern.polytopes) {
    for (const SiteOffset& own : polytope.corners) {
      for (const SiteOffset& other : polytope.corners) {
        SiteOffset offset = other;
        for (int k = 0; k < 3; ++k) offset.cell[k] = static_cast<std::int8_t>(other.cell[k] - own.cell[k]);
        auto& list = around[own.basis];
        if (other != own && std::find(list.begin(), list.end(), offset) == list.end()) list.push_back(offset);
      }
    }
  }
  return count_of(chosen, [&](Index i) {
    const LatticeSite& site = sites.of[i];
    const std::size_t piece = piece_of(i, points, sites, lattice, limit);
    if (piece == lattice.origins.size()) return false;
    const auto& offsets = around[site.basis];
    return std::all_of(offsets.begin(), offsets.end(), [&](const SiteOffset& offset) {
      auto cell = site.cell;
      for (int k = 0; k < 3; ++k) cell[k] += offset.cell[k];
      const Index other = table.atom(cell, offset.basis);
      return other != no_index && piece_of(other, points, sites, lattice, limit) == piece;
    });
  });
}

// A pattern, and how sites of the one it takes the place of read in its numbers: site (c, b) is (turn · c + shift[b],
// b).
struct Refined {
  LatticeTemplate pattern;
  Mat3 turn{1.0};
  std::vector<Vec3> shift;
};

// How far the shapes of two cells (scale apart) and the places of their atoms differ, as shares.
double difference(const UnitCell& a, const UnitCell& b) {
  const Mat3 ma = a.matrix(), mb = b.matrix();
  const double scale = std::cbrt(glm::determinant(ma) / glm::determinant(mb));
  const Mat3 ga = glm::transpose(ma) * ma;
  const Mat3 gb = scale * scale * (glm::transpose(mb) * mb);
  const Mat3 to_a = glm::inverse(ma), to_b = glm::inverse(mb);
  double off = 0.0;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) off = std::max(off, std::abs(ga[k][l] - gb[k][l]) / ga[k][k]);
  }
  for (std::size_t n = 0; n < a.basis.size(); ++n) {
    const Vec3 moved = to_a * a.basis[n].position - to_b * b.basis[n].position;
    off = std::max({off, std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)});
  }
  return off;
}

// The pattern of the lattice as it is. The polytopes stand unless the cell given has another shape.
Refined refine(const LatticeTemplate& given, const RigidLattice& lattice) {
  constexpr double same_shape = 1e-7;
  const std::size_t basis = lattice.offsets.size();
  Refined result{given, Mat3(1.0), std::vector<Vec3>(basis, Vec3(0.0))};
  UnitCell& cell = result.pattern.cell;
  for (int k = 0; k < 3; ++k) cell.primitive[k] = lattice.matrix[k];
  const Vec3 first = lattice.matrix * (glm::inverse(given.cell.matrix()) * given.cell.basis[0].position);
  for (std::size_t b = 0; b < basis; ++b) cell.basis[b].position = first + lattice.offsets[b] - lattice.offsets[0];
  if (difference(cell, given.cell) <= same_shape) return result;
  try {
    Refined anew{make_lattice_template(cell), Mat3(1.0), {}};
    // Rounding may have put equally short vectors in another order.
    const Mat3 back = glm::inverse(anew.pattern.cell.matrix());
    const Mat3 turn = back * cell.matrix();
    double off = 0.0;
    for (int k = 0; k < 3; ++k) {
      anew.turn[k] = glm::round(turn[k]);
      off = std::max(off, glm::length(turn[k] - anew.turn[k]));
    }
    for (std::size_t b = 0; b < basis; ++b) {
      const Vec3 shift = back * (cell.basis[b].position - anew.pattern.cell.basis[b].position);
      anew.shift.push_back(glm::round(shift));
      off = std::max(off, glm::length(shift - anew.shift[b]));
    }
    if (off < 1e-6) return anew;
  } catch (const Error&) {
    // The polytopes of the cell given will have to do; what does not fit them is left to Delaunay.
  }
  return result;
}

}  // namespace

RigidParts find_rigid_parts(std::span<const Vec3> points, const LatticeSites& sites, Progress& progress) {
  constexpr std::size_t least_atoms = 200;
  RigidParts parts;
  for (std::size_t p = 0; p < sites.patches.size() && sites.patches[p].atoms >= least_atoms; ++p) {
    progress.check();
    if (sites.patches.size() + parts.parts + most_pieces >= no_patch) break;  // patches have 16-bit numbers
    RigidLattice lattice;
    lattice.patch = static_cast<std::uint16_t>(p);
    const std::vector<Index> chosen = choose(sites, lattice.patch);
    const double nearest = shortest_distance(sites.patterns[sites.patches[p].pattern].cell);
    const SiteTable table(sites, lattice.patch);
    if (!find_lattice(points, sites, table, chosen, lattice)) continue;
    find_pieces(points, sites, chosen, nearest, lattice);
    if (lattice.origins.empty()) continue;
    const double limit = std::pow(rigid_tolerance * nearest, 2.0);
    const auto share_of_all = [&](std::size_t count, std::size_t asked) {
      return static_cast<double>(count) / static_cast<double>(asked) * static_cast<double>(sites.patches[p].atoms) /
             static_cast<double>(points.size());
    };
    const std::size_t held =
        count_of(chosen, [&](Index i) { return piece_of(i, points, sites, lattice, limit) < lattice.origins.size(); });
    parts.in_place += share_of_all(held, chosen.size());
    const std::vector<Index> fewer = choose(sites, lattice.patch, most_asked_around);
    parts.undisturbed += share_of_all(count_undisturbed(points, sites, table, fewer, lattice, limit), fewer.size());
    parts.parts += lattice.origins.size();
    parts.lattices.push_back(std::move(lattice));
  }
  return parts;
}

void split_into_rigid_parts(std::span<const Vec3> points, const RigidParts& parts, LatticeSites& sites) {
  const std::size_t before = sites.patches.size();
  struct Change {
    const RigidLattice* lattice = nullptr;
    std::size_t first_piece = 0;  // after the main one
    Mat3 turn{1.0};
    std::vector<Vec3> shift;
    bool renumbered = false;
  };
  std::vector<Change> changes(before);
  for (const RigidLattice& lattice : parts.lattices) {
    LatticePatch patch = sites.patches[lattice.patch];
    Refined refined = refine(sites.patterns[patch.pattern], lattice);
    const Vec3 first = lattice.matrix * sites.fractional(patch.pattern)[0];
    patch.pattern = static_cast<std::uint16_t>(sites.patterns.size());
    patch.matrix = refined.pattern.cell.matrix();
    const bool renumbered = refined.turn != Mat3(1.0) || std::any_of(refined.shift.begin(), refined.shift.end(),
                                                                     [](const Vec3& s) { return s != Vec3(0.0); });
    changes[lattice.patch] = {&lattice, sites.patches.size(), refined.turn, std::move(refined.shift), renumbered};
    sites.patterns.push_back(std::move(refined.pattern));
    for (std::size_t n = 0; n < lattice.origins.size(); ++n) {
      patch.origin = lattice.origins[n] + lattice.offsets[0] - first;
      if (n == 0) {
        sites.patches[lattice.patch] = patch;
      } else {
        sites.patches.push_back(patch);
      }
    }
  }
  parallel_for(points.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      LatticeSite& site = sites.of[i];
      if (site.patch == no_patch || changes[site.patch].lattice == nullptr) continue;
      const Change& change = changes[site.patch];
      const RigidLattice& lattice = *change.lattice;
      if (lattice.origins.size() > 1) {
        const std::size_t piece = nearest_piece(origin_of(points[i], site, lattice), lattice.origins).second;
        if (piece > 0) site.patch = static_cast<std::uint16_t>(change.first_piece + piece - 1);
      }
      if (!change.renumbered) continue;
      const Vec3 cell = change.turn * cell_of(site) + change.shift[site.basis];
      for (int k = 0; k < 3; ++k) site.cell[k] = static_cast<std::int32_t>(std::lround(cell[k]));
    }
  });
  // Patterns that no patch lies by any more go.
  std::vector<std::uint16_t> renamed(sites.patterns.size(), no_patch);
  std::vector<LatticeTemplate> used;
  for (LatticePatch& patch : sites.patches) {
    patch.atoms = 0;
    patch.min.fill(std::numeric_limits<std::int32_t>::max());
    patch.max.fill(std::numeric_limits<std::int32_t>::min());
    std::uint16_t& name = renamed[patch.pattern];
    if (name == no_patch) {
      name = static_cast<std::uint16_t>(used.size());
      used.push_back(std::move(sites.patterns[patch.pattern]));
    }
    patch.pattern = name;
  }
  sites.patterns = std::move(used);
  for (const LatticeSite& site : sites.of) {
    if (site.patch == no_patch) continue;
    LatticePatch& patch = sites.patches[site.patch];
    ++patch.atoms;
    for (int k = 0; k < 3; ++k) {
      patch.min[k] = std::min(patch.min[k], site.cell[k]);
      patch.max[k] = std::max(patch.max[k], site.cell[k]);
    }
  }
}

}  // namespace atomesh
