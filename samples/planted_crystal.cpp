#include "samples/planted_crystal.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "samples/crystal.h"
#include "samples/generators.h"
#include "samples/random.h"
#include "samples/structure_types.h"

namespace atomesh {

namespace {

double longest_vector(const UnitCell& cell) {
  return std::max({glm::length(cell.primitive[0]), glm::length(cell.primitive[1]), glm::length(cell.primitive[2])});
}

// The crystal before anything is planted, and where its surface is.
struct Host {
  Atoms atoms;
  UnitCell cell;
  std::vector<Index> basis;     // of each atom
  std::array<Vec3, 3> edges{};  // of the block
  std::array<bool, 3> periodic{false, false, false};
  Vec3 centre{0.0};     // of the sphere
  double radius = 0.0;  // 0: a block

  // How far inside p lies, Å; negative outside.
  double depth(const Vec3& p) const {
    if (radius > 0.0) return radius - glm::distance(p, centre);
    const Mat3 edge_matrix(edges[0], edges[1], edges[2]);
    const Mat3 inverse = glm::inverse(edge_matrix);
    const Vec3 f = inverse * p;
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (periodic[axis]) continue;
      const double across = 1.0 / glm::length(Vec3(inverse[0][axis], inverse[1][axis], inverse[2][axis]));
      least = std::min(least, std::min(f[axis], 1.0 - f[axis]) * across);
    }
    return least;
  }

  // Through the periodic sides if that is shorter (exact for the nearly orthogonal blocks of conventional cells).
  double distance(const Vec3& a, const Vec3& b) const {
    const Vec3 step = b - a;
    if (!periodic[0]) return glm::length(step);
    double least = std::numeric_limits<double>::infinity();
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const Vec3 image = step + static_cast<double>(i) * edges[0] + static_cast<double>(j) * edges[1] +
                             static_cast<double>(k) * edges[2];
          least = std::min(least, glm::length(image));
        }
      }
    }
    return least;
  }
};

Host make_host(const UnitCell& cell, std::size_t atoms, PlantedShape shape) {
  Host host;
  host.cell = cell;
  const Vec3 extent(glm::length(cell.primitive[0]), glm::length(cell.primitive[1]), glm::length(cell.primitive[2]));
  const double cells = static_cast<double>(atoms) / static_cast<double>(cell.basis.size());
  BlockShape block;
  if (shape == PlantedShape::sphere) {
    host.radius = std::cbrt(cells * cell.volume() * 3.0 / (4.0 * std::numbers::pi));
    const Mat3 inverse = glm::inverse(cell.matrix());
    for (int axis = 0; axis < 3; ++axis) {
      const double rows = glm::length(Vec3(inverse[0][axis], inverse[1][axis], inverse[2][axis]));
      block.cells[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(std::ceil(2.0 * host.radius * rows)) + 2;
    }
  } else {
    block = choose_block(cells, extent, Vec3(1.0));
  }
  host.atoms = build_block(cell, block);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    host.edges[axis] = static_cast<double>(block.cells[axis]) * cell.primitive[axis];
  }
  const auto sites = static_cast<Index>(cell.basis.size());
  host.basis.resize(host.atoms.size());
  for (std::size_t i = 0; i < host.basis.size(); ++i) host.basis[i] = static_cast<Index>(i) % sites;

  if (shape == PlantedShape::periodic_block) {
    host.periodic = {true, true, true};
    host.atoms.box.vectors = host.edges;
    host.atoms.box.periodic = host.periodic;
  }
  if (shape == PlantedShape::sphere) {
    // Off every symmetric point, so that no two shells of sites lie at the rim together.
    host.centre = 0.5 * (host.edges[0] + host.edges[1] + host.edges[2]) + cell.matrix() * Vec3(0.137, 0.219, 0.353);
    std::vector<Index> kept;
    std::vector<Index> kept_basis;
    for (std::size_t i = 0; i < host.atoms.size(); ++i) {
      if (glm::distance(host.atoms.positions[i], host.centre) > host.radius) continue;
      kept.push_back(static_cast<Index>(i));
      kept_basis.push_back(host.basis[i]);
    }
    host.atoms = host.atoms.subset(kept);
    host.basis = std::move(kept_basis);
  }
  return host;
}

enum class Kind { vacancy, interstitial, substitution };

struct Planted {
  Kind kind;
  Index atom;  // the site's; of an interstitial, an atom of its cell
  Vec3 position;
};

// Chooses where defects go: deep enough, far enough apart, or beside the one before.
class Planter {
 public:
  Planter(const Host& host, const PlantedCrystalOptions& options)
      : host_(host),
        voids_(options.interstitials > 0 ? largest_voids(host.cell) : LargestVoids{}),
        depth_(options.depth > 0.0 ? options.depth : 2.0 * longest_vector(host.cell)),
        apart_(options.least_distance > 0.0 ? options.least_distance : 2.5 * longest_vector(host.cell)),
        pairs_(options.pairs),
        random_(options.seed) {}

  std::vector<Planted> plant(std::vector<Kind> kinds, Progress& progress) {
    // In random order, or the kinds would fill the crystal one after the other and pairs would be of one kind only.
    for (std::size_t i = kinds.size(); i > 1; --i) std::swap(kinds[i - 1], kinds[random_.below(i)]);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (i % 64 == 0) progress.check();
      if (pairs_ && i % 2 == 1) {
        beside(kinds[i]);
      } else {
        alone(kinds[i]);
      }
    }
    return std::move(planted_);
  }

 private:
  Vec3 place(Kind kind, Index atom) {
    const Vec3& p = host_.atoms.positions[atom];
    if (kind != Kind::interstitial) return p;
    const Vec3 corner = p - host_.cell.basis[host_.basis[atom]].position;
    return corner + voids_.positions[random_.below(voids_.positions.size())];
  }

  void alone(Kind kind) {
    for (int attempt = 0; attempt < 20000; ++attempt) {
      const auto atom = static_cast<Index>(random_.below(host_.atoms.size()));
      const Vec3 p = place(kind, atom);
      if (host_.depth(p) < depth_) continue;
      const bool crowded = std::any_of(planted_.begin(), planted_.end(), [&](const Planted& other) {
        return host_.distance(p, other.position) < apart_;
      });
      if (crowded) continue;
      planted_.push_back({kind, atom, p});
      return;
    }
    throw UsageError("the crystal has no room for more than " + std::to_string(planted_.size()) +
                     " defects: ask for fewer, for more atoms, or let them be nearer to each other or to the surface");
  }

  // The nearest free place to the last defect; two interstitials leave each other the room of two atoms.
  void beside(Kind kind) {
    const Vec3 last = planted_.back().position;
    const double reach = 2.0 * longest_vector(host_.cell);
    Planted best{kind, no_index, Vec3(0.0)};
    double nearest = reach;
    const bool both_added = kind == Kind::interstitial && planted_.back().kind == Kind::interstitial;
    const double least = both_added ? 0.99 * nearest_neighbour_distance(host_.cell) : 1e-3;
    const auto offer = [&](Index atom, const Vec3& p) {
      const double d = host_.distance(p, last);
      if (d < nearest - 1e-6 && d > least && host_.depth(p) > 0.0) {
        nearest = d;
        best = {kind, atom, p};
      }
    };
    for (std::size_t i = 0; i < host_.atoms.size(); ++i) {
      const Vec3& p = host_.atoms.positions[i];
      if (glm::any(glm::greaterThan(glm::abs(p - last), Vec3(reach)))) continue;
      const auto atom = static_cast<Index>(i);
      if (kind != Kind::interstitial) {
        offer(atom, p);
        continue;
      }
      const Vec3 corner = p - host_.cell.basis[host_.basis[i]].position;
      for (const Vec3& v : voids_.positions) offer(atom, corner + v);
    }
    if (best.atom == no_index) throw UsageError("there is no free place beside a defect: ask for more atoms");
    planted_.push_back(best);
  }

  const Host& host_;
  LargestVoids voids_;
  double depth_, apart_;
  bool pairs_;
  Random random_;
  std::vector<Planted> planted_;
};

// Three normal numbers that belong to item `index` of stream `seed` (Box and Muller 1958).
Vec3 normal_of(std::uint64_t seed, std::uint64_t index) {
  const auto uniform = [&](std::uint64_t which) { return Random::uniform_of(seed, 4 * index + which); };
  const double r1 = std::sqrt(-2.0 * std::log(1.0 - uniform(0)));
  const double r2 = std::sqrt(-2.0 * std::log(1.0 - uniform(2)));
  const double t1 = 2.0 * std::numbers::pi * uniform(1);
  const double t2 = 2.0 * std::numbers::pi * uniform(3);
  return {r1 * std::cos(t1), r1 * std::sin(t1), r2 * std::cos(t2)};
}

UnitCell turned(UnitCell cell, const Mat3& rotation) {
  for (Vec3& v : cell.primitive) v = rotation * v;
  for (BasisAtom& atom : cell.basis) atom.position = rotation * atom.position;
  return cell;
}

void check(const PlantedCrystalOptions& options) {
  const auto not_negative = [](const char* name, double value) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw UsageError(std::string("planted crystal: ") + name + " must be 0 or more");
    }
  };
  not_negative("least_distance", options.least_distance);
  not_negative("depth", options.depth);
  not_negative("noise", options.noise);
  if (options.noise > 0.2)
    throw UsageError("planted crystal: noise above 0.2 of the nearest-neighbour distance is a melt");
  if (options.atoms < 8 || options.atoms > no_index / 4) {
    throw UsageError("planted crystal: atoms must be 8 to " + std::to_string(no_index / 4));
  }
}

}  // namespace

Mat3 random_rotation(std::uint64_t seed) {
  if (seed == 0) return Mat3(1.0);
  Random random(seed);
  const double u = random.uniform();
  const double a = 2.0 * std::numbers::pi * random.uniform();
  const double b = 2.0 * std::numbers::pi * random.uniform();
  const double x = std::sqrt(1.0 - u) * std::sin(a);
  const double y = std::sqrt(1.0 - u) * std::cos(a);
  const double z = std::sqrt(u) * std::sin(b);
  const double w = std::sqrt(u) * std::cos(b);
  return Mat3(Vec3(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)),
              Vec3(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)),
              Vec3(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)));
}

Sample make_planted_crystal(const PlantedCrystalOptions& options, Progress& progress) {
  check(options);
  const StructureType& type = find_structure_type(options.structure);
  progress.stage("grow");
  Sample sample;
  sample.unit_cell = turned(type.cell, random_rotation(options.rotation));
  Host host = make_host(*sample.unit_cell, options.atoms, options.shape);
  progress.check();

  std::vector<Kind> kinds(options.vacancies, Kind::vacancy);
  kinds.insert(kinds.end(), options.interstitials, Kind::interstitial);
  kinds.insert(kinds.end(), options.substitutions, Kind::substitution);
  const std::vector<Planted> planted = Planter(host, options).plant(std::move(kinds), progress);

  // Foreign atoms take their sites, then missing atoms go, then the interstitials come: indices first, flags after.
  SampleTruth& truth = sample.truth;
  std::vector<bool> removed(host.atoms.size(), false);
  std::vector<bool> foreign(host.atoms.size(), false);
  for (const Planted& p : planted) {
    if (p.kind == Kind::interstitial) continue;
    truth.vacancies.push_back({p.position, host.atoms.species_name(p.atom)});
    if (p.kind == Kind::vacancy) removed[p.atom] = true;
    if (p.kind != Kind::substitution) continue;
    foreign[p.atom] = true;
    truth.substitutions.push_back({p.atom, static_cast<Index>(truth.vacancies.size() - 1)});
  }
  std::sort(truth.substitutions.begin(), truth.substitutions.end(),
            [](const auto& a, const auto& b) { return a.atom < b.atom; });
  if (options.substitutions > 0) {
    const std::uint16_t impurity = host.atoms.add_species(type.impurity);
    for (const auto& substitution : truth.substitutions) host.atoms.species[substitution.atom] = impurity;
  }
  sample.atoms = without(host.atoms, removed);
  std::size_t next = 0;
  Index index = 0;
  for (std::size_t i = 0; i < removed.size(); ++i) {
    if (removed[i]) continue;
    if (foreign[i]) {
      truth.substitutions[next++].atom = index;
      truth.extras.push_back(index);
    }
    ++index;
  }
  const std::uint16_t own = sample.atoms.add_species(type.cell.basis.front().species);
  for (const Planted& p : planted) {
    if (p.kind != Kind::interstitial) continue;
    truth.extras.push_back(static_cast<Index>(sample.atoms.size()));
    sample.atoms.positions.push_back(p.position);
    sample.atoms.species.push_back(own);
  }

  if (options.noise > 0.0) {
    const double sigma = options.noise * type.nearest_neighbour;
    std::vector<bool> is_extra(sample.atoms.size(), false);
    for (const Index i : truth.extras) is_extra[i] = true;
    for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
      if (i % 65536 == 0) progress.check();
      const Vec3 step = sigma * normal_of(options.seed, i);
      sample.atoms.positions[i] += step;
      if (!is_extra[i] && glm::length(step) > displaced_threshold) truth.displaced.push_back(static_cast<Index>(i));
    }
  }
  if (sample.atoms.box.any_periodic() && options.noise > 0.0) {  // without noise all stand inside as they were built
    const Mat3 inverse = glm::inverse(sample.atoms.box.matrix());
    for (Vec3& p : sample.atoms.positions) p -= sample.atoms.box.matrix() * glm::floor(inverse * p);
  }
  return sample;
}

}  // namespace atomesh
