#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/lattice_sites.h"
#include "preprocess/pattern_radius.h"
#include "preprocess/rigid_parts.h"
#include "preprocess/tetrahedralize.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

// A sample that knows where on the perfect crystal each of its atoms belongs.
struct Known {
  Atoms atoms;
  std::vector<Vec3> ideal;

  explicit Known(Atoms perfect) : atoms(std::move(perfect)), ideal(atoms.positions) {}

  void move(const std::function<Vec3(const Vec3&)>& displacement) {
    for (std::size_t i = 0; i < ideal.size(); ++i) atoms.positions[i] += displacement(ideal[i]);
  }
  void keep(const std::function<bool(std::size_t)>& wanted) {
    std::vector<Index> kept;
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < ideal.size(); ++i) {
      if (!wanted(i)) continue;
      kept.push_back(static_cast<Index>(i));
      places.push_back(ideal[i]);
    }
    atoms = atoms.subset(kept);
    ideal = places;
  }
  void shuffle(std::uint64_t seed) {
    std::vector<Index> order(ideal.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::mt19937_64 generator(seed);
    std::shuffle(order.begin(), order.end(), generator);
    const std::vector<Vec3> places = ideal;
    for (std::size_t i = 0; i < order.size(); ++i) ideal[i] = places[order[i]];
    atoms = atoms.subset(order);
  }
};

UnitCell turned(UnitCell cell, const Mat3& rotation) {
  for (Vec3& v : cell.primitive) v = rotation * v;
  for (BasisAtom& atom : cell.basis) atom.position = rotation * atom.position;
  return cell;
}

// A turn by `angle` about an axis of no lattice.
Mat3 turn(double angle) {
  const Vec3 n = glm::normalize(Vec3(0.31, -0.74, 0.52));
  Mat3 result(1.0);
  for (int k = 0; k < 3; ++k) {
    Vec3 e(0.0);
    e[k] = 1.0;
    result[k] = std::cos(angle) * e + std::sin(angle) * glm::cross(n, e) + (1 - std::cos(angle)) * glm::dot(n, e) * n;
  }
  return result;
}

// The lattice translation (an ideal place less that of the label) that most atoms of patch p agree on, and how many.
std::size_t agreeing(const Known& known, const LatticeSites& sites, std::uint16_t p) {
  const UnitCell& cell = sites.patterns[sites.patches[p].pattern].cell;
  std::map<std::array<long, 3>, std::size_t> votes;
  std::size_t best = 0;
  for (std::size_t i = 0; i < known.ideal.size(); ++i) {
    const LatticeSite& site = sites.of[i];
    if (site.patch != p) continue;
    const Vec3 d = known.ideal[i] -
                   (cell.matrix() * Vec3(site.cell[0], site.cell[1], site.cell[2]) + cell.basis[site.basis].position);
    best = std::max(
        best, ++votes[{std::lround(d.x * 10 + 0.137), std::lround(d.y * 10 + 0.137), std::lround(d.z * 10 + 0.137)}]);
  }
  return best;
}

std::size_t labelled(const LatticeSites& sites) {
  return static_cast<std::size_t>(
      std::count_if(sites.of.begin(), sites.of.end(), [](const LatticeSite& s) { return s.patch != no_patch; }));
}

// Every atom has the right number, in one patch.
void expect_all(const Known& known, const UnitCell& cell, const std::string& what) {
  const LatticeSites sites = assign_lattice_sites(known.atoms, {{cell}, {}}, {});
  ASSERT_EQ(sites.patches.size(), 1U) << what;
  EXPECT_EQ(agreeing(known, sites, 0), known.ideal.size()) << what;
  EXPECT_EQ(sites.patches[0].atoms, known.ideal.size()) << what;
  EXPECT_EQ(sites.patches[0].seams, 0U) << what;
}

Vec3 random_vector(std::mt19937_64& generator, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(generator);
  const double y = normal(generator);
  return {x, y, normal(generator)};
}

TEST(LatticeSites, PerfectCrystalsInAnyOrderAndOrientation) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const double angle : {0.0, 0.7}) {
      Known known(test::cut_sphere(lattice.cell, 9.0 * lattice.nearest_neighbour));
      known.move([&](const Vec3& p) { return turn(angle) * p - p + Vec3(1e3, -2e3, 5e3); });
      known.shuffle(3);
      // Labels name ideal places in the crystal's own orientation.
      for (Vec3& p : known.ideal) p = turn(angle) * p;
      expect_all(known, turned(lattice.cell, turn(angle)), lattice.name);
    }
  }
}

TEST(LatticeSites, FrameFitsThePerfectCrystal) {
  for (const test::Lattice& lattice : test::lattices()) {
    const Atoms atoms = test::shuffled(test::cut_block(lattice.cell, 7, 7, 7), 5);
    // The cell given is a thousandth too large.
    UnitCell given = lattice.cell;
    for (Vec3& v : given.primitive) v *= 1.001;
    for (BasisAtom& atom : given.basis) atom.position *= 1.001;
    const LatticeSites sites = assign_lattice_sites(atoms, {{given}, {}}, {});
    ASSERT_EQ(sites.patches.size(), 1U) << lattice.name;
    EXPECT_EQ(sites.patches[0].atoms, atoms.size()) << lattice.name;
    EXPECT_LT(sites.patches[0].rms, 1e-9) << lattice.name;
    EXPECT_LT(sites.patches[0].largest, 1e-9) << lattice.name;
    const Mat3 right = (1.0 / 1.001) * sites.patterns[0].cell.matrix();
    for (int k = 0; k < 3; ++k) EXPECT_LT(glm::length(sites.patches[0].matrix[k] - right[k]), 1e-9) << lattice.name;
  }
}

TEST(LatticeSites, ThermalNoise) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const double percent : {1.0, 3.0, 5.0}) {
      Known known(test::cut_sphere(lattice.cell, 9.0 * lattice.nearest_neighbour));
      std::mt19937_64 generator(7);
      known.move([&](const Vec3&) { return random_vector(generator, 0.01 * percent * lattice.nearest_neighbour); });
      known.shuffle(4);
      expect_all(known, lattice.cell, lattice.name + ", noise of " + std::to_string(percent) + " %");
    }
  }
}

TEST(LatticeSites, VacanciesForeignAtomsAndCavities) {
  for (const test::Lattice& lattice : test::lattices()) {
    const double nearest = lattice.nearest_neighbour;
    Known known(test::cut_sphere(lattice.cell, 11.0 * nearest));
    std::mt19937_64 generator(8);
    std::uniform_real_distribution<double> uniform;
    known.keep([&](std::size_t i) {
      return uniform(generator) > 0.05 && glm::length(known.ideal[i] - Vec3(2.0 * nearest)) > 3.5 * nearest;
    });
    const std::uint16_t foreign = known.atoms.add_species("Xe");
    for (std::uint16_t& species : known.atoms.species) species = uniform(generator) < 0.1 ? foreign : species;
    known.move([&](const Vec3&) { return random_vector(generator, 0.02 * nearest); });
    known.shuffle(9);
    expect_all(known, lattice.cell, lattice.name);
  }
}

TEST(LatticeSites, GapsAreSteppedOver) {
  // Two halves with more than a block of nothing between.
  for (const char* name : {"fcc", "nacl", "diamond"}) {
    const test::Lattice& lattice = test::lattice(name);
    Known known(test::cut_where(lattice.cell, Vec3(40, 12, 12), [](const Vec3& p) { return std::abs(p.x) > 10.0; }));
    known.shuffle(2);
    expect_all(known, lattice.cell, name);
  }
}

TEST(LatticeSites, StrainAddsUp) {
  for (const test::Lattice& lattice : test::lattices()) {
    Known known(test::cut_where(lattice.cell, Vec3(60, 10, 10), [](const Vec3&) { return true; }));
    // Bent to a radius of 400 Å: the ends are 4.5 Å off; and stretched by 2 %: 1.2 Å more.
    std::mt19937_64 generator(8);
    known.move([&](const Vec3& p) {
      const double angle = 1.02 * p.x / 400.0;
      const double r = 400.0 + p.y;
      return Vec3(r * std::sin(angle), r * std::cos(angle) - 400.0, p.z) - p +
             random_vector(generator, 0.01 * lattice.nearest_neighbour);
    });
    known.shuffle(6);
    expect_all(known, lattice.cell, lattice.name + ", bent");
    const LatticeSites sites = assign_lattice_sites(known.atoms, {{lattice.cell}, {}}, {});
    EXPECT_GT(sites.patches[0].largest, 2.0) << lattice.name;
  }
}

TEST(LatticeSites, GradientOfTemperature) {
  for (const char* name : {"fcc", "nacl", "graphite"}) {
    const test::Lattice& lattice = test::lattice(name);
    Known known(test::cut_where(lattice.cell, Vec3(90, 12, 12), [](const Vec3&) { return true; }));
    // Expansion that grows from nothing to 4 % along x: 3.6 Å at the far end.
    known.move([](const Vec3& p) {
      const double x = p.x + 90.0;
      const double expansion = 0.04 * x / 180.0;
      return Vec3(0.5 * expansion * x, expansion * p.y, expansion * p.z);
    });
    known.shuffle(6);
    expect_all(known, lattice.cell, name);
  }
}

TEST(LatticeSites, TwoGrains) {
  for (const char* name : {"fcc", "bcc", "nacl", "diamond"}) {
    const test::Lattice& lattice = test::lattice(name);
    const Mat3 rotation = turn(0.5);
    const auto all = [](const Vec3&) { return true; };
    const Atoms left = test::cut_where(lattice.cell, Vec3(30), [](const Vec3& p) { return p.x < -0.6; });
    const UnitCell other = turned(lattice.cell, rotation);
    Atoms right = test::cut_where(other, Vec3(30), [](const Vec3& p) { return p.x > 0.6; });
    Known known(test::cut_where(lattice.cell, Vec3(0.1), all));
    known.atoms = left;
    known.atoms.positions.insert(known.atoms.positions.end(), right.positions.begin(), right.positions.end());
    for (std::size_t i = 0; i < right.size(); ++i) {
      known.atoms.species.push_back(known.atoms.add_species(right.species_name(i)));
    }
    known.ideal = known.atoms.positions;
    known.shuffle(1);
    const LatticeSites sites = assign_lattice_sites(known.atoms, {{lattice.cell, other}, {}}, {});
    ASSERT_GE(sites.patches.size(), 2U) << name;
    std::size_t right_place = 0;
    for (std::size_t i = 0; i < known.ideal.size(); ++i) {
      const LatticeSite& site = sites.of[i];
      right_place += site.patch <= 1 && (sites.patches[site.patch].pattern == 1) == (known.ideal[i].x > 0.0) ? 1 : 0;
    }
    EXPECT_EQ(right_place, known.ideal.size()) << name;
    EXPECT_EQ(agreeing(known, sites, 0) + agreeing(known, sites, 1), known.ideal.size()) << name;
  }
}

TEST(LatticeSites, SlidHalf) {
  // By 0.45 nearest-neighbour distances along and apart: no numbering serves both halves.
  for (const char* name : {"sc", "fcc", "nacl"}) {
    const test::Lattice& lattice = test::lattice(name);
    const double slid = 0.45 * lattice.nearest_neighbour;
    Known known(test::cut_where(lattice.cell, Vec3(25), [](const Vec3&) { return true; }));
    known.move([&](const Vec3& p) { return p.z > 0.1 ? Vec3(slid, 0.3 * slid, 0.4 * slid) : Vec3(0.0); });
    known.shuffle(1);
    const LatticeSites sites = assign_lattice_sites(known.atoms, {{lattice.cell}, {}}, {});
    ASSERT_EQ(sites.patches.size(), 2U) << name;
    EXPECT_EQ(agreeing(known, sites, 0) + agreeing(known, sites, 1), known.ideal.size()) << name;
    for (std::size_t i = 0; i < known.ideal.size(); ++i) {
      EXPECT_EQ(sites.of[i].patch == sites.of[0].patch, (known.ideal[i].z > 0.1) == (known.ideal[0].z > 0.1));
    }
  }
}

TEST(LatticeSites, DislocationHasSeams) {
  const test::Lattice& fcc = test::lattice("fcc");
  Known known(test::cut_where(fcc.cell, Vec3(40, 40, 20), [](const Vec3&) { return true; }));
  const double burgers = 3.615;
  known.move(
      [&](const Vec3& p) { return Vec3(0, 0, burgers * std::atan2(p.y - 0.7, p.x - 0.5) / (2 * std::numbers::pi)); });
  known.shuffle(1);
  const LatticeSites sites = assign_lattice_sites(known.atoms, {{fcc.cell}, {}}, {});
  ASSERT_GE(sites.patches.size(), 1U);
  EXPECT_GT(sites.patches[0].atoms, 0.98 * static_cast<double>(known.ideal.size()));
  EXPECT_GT(sites.patches[0].seams, 0U);
}

TEST(LatticeSites, InterstitialsSitOnNoSite) {
  const test::Lattice& fcc = test::lattice("fcc");
  Known known(test::cut_where(fcc.cell, Vec3(20), [](const Vec3&) { return true; }));
  const std::size_t atoms = known.ideal.size();
  for (const Vec3& p : {Vec3(0.5, 0, 0), Vec3(1.5, 1, 0), Vec3(0.25, 2.25, -1.75)}) {
    known.atoms.positions.push_back(3.615 * p);  // two octahedral sites and a tetrahedral one
    known.atoms.species.push_back(0);
  }
  // A dumbbell: the site's own atom and another share it.
  known.atoms.positions.push_back(known.ideal[100] + Vec3(0.3, 0, 0));
  known.atoms.species.push_back(0);
  const LatticeSites sites = assign_lattice_sites(known.atoms, {{fcc.cell}, {}}, {});
  ASSERT_EQ(sites.patches.size(), 1U);
  EXPECT_EQ(sites.patches[0].atoms, atoms);
  for (std::size_t i = 0; i < sites.of.size(); ++i) EXPECT_EQ(sites.of[i].patch == 0, i < atoms) << i;
}

TEST(LatticeSites, AmorphousHasNoSites) {
  const LatticeSites sites =
      assign_lattice_sites(test::random_atoms(20000, 62.0, 3), {{test::lattice("fcc").cell}, {}}, {});
  EXPECT_EQ(labelled(sites), 0U);
  EXPECT_TRUE(sites.patches.empty());
}

// Numerical hard cases.

TEST(LatticeSites, HardCaseSkewPrimitiveCells) {
  for (const char* name : {"fcc", "bcc", "sc"}) {
    const double a = test::lattice(name).cell.primitive[0].x;
    UnitCell skew;
    skew.basis = {test::lattice(name).cell.basis[0]};
    if (std::string(name) == "fcc")
      skew.primitive = {Vec3(0, a / 2, a / 2), Vec3(a / 2, 0, a / 2), Vec3(a / 2, a / 2, 0)};
    if (std::string(name) == "bcc")
      skew.primitive = {Vec3(-a / 2, a / 2, a / 2), Vec3(a / 2, -a / 2, a / 2), Vec3(a / 2, a / 2, -a / 2)};
    if (std::string(name) == "sc") skew.primitive = {Vec3(a, 0, 0), Vec3(0, a, 0), Vec3(0, 0, a)};
    skew.primitive[1] += 7.0 * skew.primitive[0];
    skew.primitive[2] -= 5.0 * skew.primitive[1] + 3.0 * skew.primitive[0];
    Known known(test::cut_sphere(test::lattice(name).cell, 30.0));
    known.shuffle(1);
    expect_all(known, skew, name);
  }
}

TEST(LatticeSites, HardCaseVeryUnequalEdges) {
  UnitCell cell;
  cell.primitive = {Vec3(2.5, 0, 0), Vec3(0, 3.1, 0), Vec3(1.1, 0.4, 61.0)};
  std::mt19937_64 generator(12);
  std::uniform_real_distribution<double> uniform;
  for (int n = 0; n < 20; ++n) {
    const double x = uniform(generator);
    cell.basis.push_back({n % 3 == 0 ? "Sr" : "O", x * cell.primitive[0] + uniform(generator) * cell.primitive[1] +
                                                       n / 20.0 * cell.primitive[2]});
  }
  Known known(test::cut_block(cell, 14, 11, 3));
  known.move([&](const Vec3&) { return random_vector(generator, 0.03); });
  known.shuffle(1);
  expect_all(known, cell, "61 Å long");
}

TEST(LatticeSites, HardCaseTinyRotations) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const double angle : {1e-6, 1e-5, 1e-4, 1e-3}) {
      Known known(test::cut_where(lattice.cell, Vec3(50, 9, 9), [](const Vec3&) { return true; }));
      known.move([&](const Vec3& p) { return turn(angle) * (p + Vec3(2000, 0, 0)) - p; });
      known.shuffle(1);
      expect_all(known, lattice.cell, lattice.name + " turned by " + std::to_string(angle));
    }
  }
}

TEST(LatticeSites, HardCaseNoiseAtTheTolerance) {
  // Each atom exactly the tolerance from its site, in a random direction; half of them a hair more.
  const test::Lattice& fcc = test::lattice("fcc");
  const double tolerance = 0.1 * fcc.nearest_neighbour;
  for (const double share : {0.999, 1.001}) {
    Known known(test::cut_where(fcc.cell, Vec3(25), [](const Vec3&) { return true; }));
    std::mt19937_64 generator(8);
    known.move([&](const Vec3&) { return share * tolerance * glm::normalize(random_vector(generator, 1.0)); });
    const LatticeSites sites = assign_lattice_sites(known.atoms, {{fcc.cell}, {}}, {tolerance, 64});
    // The frame fitted to noisy atoms is itself off by a little, so a share of them falls to either side; whoever has
    // a number has the right one.
    for (std::size_t p = 0; p < sites.patches.size(); ++p) {
      EXPECT_EQ(agreeing(known, sites, static_cast<std::uint16_t>(p)), sites.patches[p].atoms) << share;
    }
    EXPECT_LE(sites.patches.size(), 1U) << share;
  }
}

TEST(LatticeSites, HardCaseVacancyOnTheSurface) {
  for (const test::Lattice& lattice : test::lattices()) {
    Known known(test::cut_block(lattice.cell, 6, 6, 6));
    known.keep([](std::size_t i) { return i != 0 && i != 40; });
    known.shuffle(1);
    expect_all(known, lattice.cell, lattice.name);
  }
}

TEST(LatticeSites, HardCaseTwinBoundary) {
  // fcc mirrored at a (111) plane, whose atoms belong to both twins.
  const test::Lattice& fcc = test::lattice("fcc");
  const Vec3 normal = glm::normalize(Vec3(1, 1, 1));
  Known known(test::cut_where(fcc.cell, Vec3(26), [](const Vec3&) { return true; }));
  const auto mirrored = [&](const Vec3& p) { return p - 2.0 * glm::dot(p, normal) * normal; };
  known.keep([&](std::size_t i) { return glm::dot(known.ideal[i], normal) < 0.01; });
  const std::size_t half = known.ideal.size();
  for (std::size_t i = 0; i < half; ++i) {
    if (glm::dot(known.ideal[i], normal) > -0.01) continue;
    known.atoms.positions.push_back(mirrored(known.ideal[i]));
    known.atoms.species.push_back(0);
    known.ideal.push_back(known.atoms.positions.back());
  }
  UnitCell twin = fcc.cell;
  for (Vec3& v : twin.primitive) v = mirrored(v);
  for (BasisAtom& atom : twin.basis) atom.position = mirrored(atom.position);
  known.shuffle(2);
  const LatticeSites sites = assign_lattice_sites(known.atoms, {{fcc.cell, twin}, {}}, {});
  ASSERT_EQ(sites.patches.size(), 2U);
  EXPECT_EQ(labelled(sites), known.ideal.size());
  EXPECT_EQ(agreeing(known, sites, 0) + agreeing(known, sites, 1), known.ideal.size());
}

TEST(LatticeSites, DoesNotDependOnThreads) {
  Known known(test::cut_where(test::lattice("nacl").cell, Vec3(35), [](const Vec3&) { return true; }));
  std::mt19937_64 generator(8);
  known.move([&](const Vec3&) { return random_vector(generator, 0.2); });
  known.shuffle(1);
  const Crystal crystal{{test::lattice("nacl").cell}, {}};
  set_threads(1);
  const LatticeSites one = assign_lattice_sites(known.atoms, crystal, {});
  set_threads(3);
  const LatticeSites three = assign_lattice_sites(known.atoms, crystal, {});
  set_threads(0);
  EXPECT_EQ(one.of, three.of);
  EXPECT_EQ(one.patches[0].matrix, three.patches[0].matrix);
  EXPECT_EQ(one.patches[0].rms, three.patches[0].rms);
}

TEST(LatticeSites, TheFirstPositionThatIsNotFiniteIsNamed) {
  Atoms atoms = test::cut_where(test::lattice("nacl").cell, Vec3(55), [](const Vec3&) { return true; });
  ASSERT_GT(atoms.size(), 40000U);
  atoms.positions[40000].y = std::numeric_limits<double>::quiet_NaN();
  atoms.positions[33332].z = std::numeric_limits<double>::infinity();
  try {
    assign_lattice_sites(atoms, {{test::lattice("nacl").cell}, {}}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("atom 33333 "), std::string::npos) << error.what();
  }
}

TEST(RigidParts, DoNotDependOnThreads) {
  const UnitCell cell = test::lattice("diamond").cell;
  Known known(test::cut_where(cell, Vec3(30), [](const Vec3&) { return true; }));
  known.move([](const Vec3& p) { return p.z > 3.0 ? Vec3(0.4, 0.1, 0.0) : Vec3(0.0); });
  known.shuffle(5);
  const std::vector<Vec3>& points = known.atoms.positions;
  const LatticeSites sites = assign_lattice_sites(known.atoms, {{cell}, {}}, {});
  set_threads(1);
  const RigidParts one = find_rigid_parts(points, sites);
  set_threads(3);
  const RigidParts three = find_rigid_parts(points, sites);
  set_threads(0);
  EXPECT_GE(one.parts, 2U);
  EXPECT_EQ(one.parts, three.parts);
  EXPECT_EQ(one.in_place, three.in_place);
  EXPECT_EQ(one.undisturbed, three.undisturbed);
  ASSERT_EQ(one.lattices.size(), three.lattices.size());
  for (std::size_t n = 0; n < one.lattices.size(); ++n) {
    EXPECT_EQ(one.lattices[n].matrix, three.lattices[n].matrix);
    EXPECT_EQ(one.lattices[n].offsets, three.lattices[n].offsets);
    EXPECT_EQ(one.lattices[n].origins, three.lattices[n].origins);
  }
}

TEST(PatternRadius, EnclosureDoesNotDependOnThreads) {
  std::vector<Vec3> points = test::random_atoms(3000, 30.0, 4).positions;
  std::vector<Tetrahedron> tetrahedra = delaunay_cgal(points, no_progress());
  tetrahedra.resize(tetrahedra.size() / 2);  // so that some vertices have none and many are on the outside
  set_threads(1);
  const RadiusBounds one = enclose_radius(tetrahedra, points);
  set_threads(3);
  const RadiusBounds three = enclose_radius(tetrahedra, points);
  set_threads(0);
  EXPECT_GT(one.least, 0.0);
  EXPECT_EQ(one.least, three.least);
  EXPECT_EQ(one.largest, three.largest);
  EXPECT_EQ(one.between, three.between);
}

TEST(LatticeSites, CanBeCancelled) {
  const Atoms atoms = test::cut_block(test::lattice("nacl").cell, 8, 8, 8);
  Progress cancelled;
  cancelled.request_cancel();
  EXPECT_THROW(assign_lattice_sites(atoms, {{test::lattice("nacl").cell}, {}}, {}, cancelled), CancelledError);
}

TEST(SiteTable, FindsEveryAtomAndNothingElse) {
  // A solid block (dense) and atoms strewn over a huge one (hashed).
  for (const bool strewn : {false, true}) {
    LatticeSites sites;
    sites.patterns.resize(1);
    sites.patterns[0].cell = test::lattice("nacl").cell;
    LatticePatch& patch = sites.patches.emplace_back();
    const int step = strewn ? 1000 : 1;
    patch.min = {-5 * step, -5 * step, -5 * step};
    patch.max = {5 * step, 5 * step, 5 * step};
    std::map<std::array<std::int32_t, 4>, Index> truth;
    for (int n = 0; n < 1331; n += 2) {
      const std::array<std::int32_t, 3> cell{step * (n % 11 - 5), step * (n / 11 % 11 - 5), step * (n / 121 - 5)};
      truth[{cell[0], cell[1], cell[2], n % 8}] = static_cast<Index>(sites.of.size());
      sites.of.push_back({cell, static_cast<std::uint16_t>(n % 8), 0});
    }
    patch.atoms = sites.of.size();
    const SiteTable table(sites, 0);
    for (int n = 0; n < 1331; ++n) {
      const std::array<std::int32_t, 3> cell{step * (n % 11 - 5), step * (n / 11 % 11 - 5), step * (n / 121 - 5)};
      for (std::uint16_t b = 0; b < 8; ++b) {
        const auto known = truth.find({cell[0], cell[1], cell[2], b});
        EXPECT_EQ(table.atom(cell, b), known == truth.end() ? no_index : known->second);
      }
    }
    EXPECT_EQ(table.atom({6 * step, 0, 0}, 0), no_index);
    EXPECT_EQ(table.atom({0, -1000000, 0}, 0), no_index);
  }
}

}  // namespace
}  // namespace atomesh
