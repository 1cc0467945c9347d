// Thermal noise hides no planted defect and makes none: recall and precision per structure, what the estimate says of
// samples that are strained and not warm, cells that are a little off, and the controls.
#include <cmath>
#include <set>

#include "core/error.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

struct Score {
  std::size_t planted = 0, found = 0, invented = 0;
  void add(std::size_t truth, std::size_t hits, std::size_t all) {
    planted += truth;
    found += hits;
    invented += all - hits;
  }
};

Score score(const Sample& sample, const Defects& defects, double near_enough) {
  Score score;
  std::size_t hits = 0;
  std::vector<bool> used(defects.vacancies.size(), false);
  for (const SampleTruth::Site& site : sample.truth.vacancies) {
    for (std::size_t v = 0; v < used.size(); ++v) {
      const VacancySite& found = defects.vacancies[v];
      if (used[v] || sample.atoms.species_table[found.species].name != site.species ||
          box_distance(found.position, site.position, sample.atoms.box) > near_enough) {
        continue;
      }
      used[v] = true;
      ++hits;
      break;
    }
  }
  score.add(sample.truth.vacancies.size(), hits, defects.vacancies.size());
  const std::set<Index> extras(sample.truth.extras.begin(), sample.truth.extras.end());
  hits = static_cast<std::size_t>(std::count_if(defects.extras.begin(), defects.extras.end(),
                                                [&](const ExtraAtom& e) { return extras.count(e.atom) == 1; }));
  score.add(extras.size(), hits, defects.extras.size());
  hits = 0;
  for (const SampleTruth::Substitution& truth : sample.truth.substitutions) {
    hits += static_cast<std::size_t>(
        std::count_if(defects.substitutions.begin(), defects.substitutions.end(), [&](const Substitution& s) {
          return s.atom == truth.atom &&
                 sample.atoms.species_table[s.expected].name == sample.truth.vacancies[truth.site].species;
        }));
  }
  score.add(sample.truth.substitutions.size(), hits, defects.substitutions.size());
  return score;
}

Sample planted(const std::string& structure, double noise, std::uint64_t seed, std::size_t each = 3) {
  PlantedCrystalOptions options;
  options.structure = structure;
  options.atoms = structure == "graphite" ? 12000 : 8000;
  options.shape = seed % 2 == 0 ? PlantedShape::periodic_block : PlantedShape::sphere;
  options.vacancies = options.interstitials = options.substitutions = structure == "graphite" ? 1 : each;
  options.noise = noise;
  options.rotation = seed;
  options.seed = seed;
  return make_planted_crystal(options);
}

const std::vector<std::string> structures{"fcc", "bcc", "diamond", "rock-salt", "graphite"};

// Every defect is found and none invented up to 3 % of the nearest-neighbour distance; atoms that touch none of them
// have no value at all, so that what is simplified losslessly stays simple at room temperature.
TEST(ThermalDefects, PlantedDefectsAreFoundAndNothingElse) {
  for (const std::string& structure : structures) {
    const double nearest = find_structure_type(structure).nearest_neighbour;
    for (const std::uint64_t seed : {4u, 5u}) {
      if (seed == 5 && (structure == "graphite" || structure == "bcc")) continue;
      const Sample cold = planted(structure, 0.0, seed);
      const Quantified reference = quantify(cold.atoms, *cold.unit_cell);
      EXPECT_EQ(reference.report.noise, 0.0) << structure;
      for (const double noise : {0.0, 0.01, 0.03}) {
        const Sample sample = planted(structure, noise, seed);
        const Quantified q = quantify(sample.atoms, *sample.unit_cell);
        const std::string what = structure + " at " + std::to_string(noise);
        const Score result = score(sample, q.defects, 0.3 * nearest);
        EXPECT_EQ(result.found, result.planted) << what;
        EXPECT_EQ(result.invented, 0u) << what;
        EXPECT_NEAR(q.report.noise, noise * nearest, 0.12 * noise * nearest + 1e-12) << what;
        EXPECT_EQ(q.report.positional_atoms, 0u) << what;
        EXPECT_EQ(q.report.vacancy_atoms, reference.report.vacancy_atoms) << what;
        // Atoms near the limit of the neighbourhood of an interstitial may swing in or out.
        EXPECT_NEAR(static_cast<double>(q.report.extra_atoms), static_cast<double>(reference.report.extra_atoms),
                    0.02 * static_cast<double>(reference.report.extra_atoms) + 1.0)
            << what;
      }
    }
  }
}

TEST(ThermalDefects, NoiseAtTheToleranceMovesNoVerdictFarFromIt) {
  // 5 % rms: neighbours are displaced against each other by more than the default tolerance now and then.
  for (const char* structure : {"fcc", "bcc", "rock-salt"}) {
    const Sample sample = planted(structure, 0.05, 4);
    const Quantified q = quantify(sample.atoms, *sample.unit_cell);
    const double nearest = find_structure_type(structure).nearest_neighbour;
    EXPECT_GT(q.report.tolerance, 0.4 * nearest);
    const Score result = score(sample, q.defects, 0.4 * nearest);
    EXPECT_EQ(result.found, result.planted) << structure;
    EXPECT_EQ(result.invented, 0u) << structure;
  }
}

TEST(ThermalDefects, FactorAndAmplitudeDecideWhatIsNoise) {
  const Sample sample = planted("fcc", 0.02, 4, 0);
  const double nearest = find_structure_type("fcc").nearest_neighbour;
  const std::size_t count = sample.atoms.size();
  DefectOptions options;
  options.noise_factor = 0.0;
  EXPECT_EQ(quantify(sample.atoms, *sample.unit_cell, options).report.positional_atoms, count);
  options.noise_factor = 3.0;  // 2.1 standard deviations of a pair: nearly every atom has some such
  EXPECT_GT(quantify(sample.atoms, *sample.unit_cell, options).report.positional_atoms, count / 2);
  options = {};
  options.noise = 0.0;
  EXPECT_EQ(quantify(sample.atoms, *sample.unit_cell, options).report.positional_atoms, count);
  options.noise = 0.02 * nearest;
  const Quantified given = quantify(sample.atoms, *sample.unit_cell, options);
  EXPECT_EQ(given.report.noise, 0.02 * nearest);
  EXPECT_NEAR(given.report.noise_limit, 9.0 * 0.02 * nearest, 1e-12);
  EXPECT_EQ(given.report.positional_atoms, 0u);
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    options.noise = bad;
    EXPECT_THROW(quantify(sample.atoms, *sample.unit_cell, options), UsageError);
    options = {};
    options.noise_factor = bad;
    EXPECT_THROW(quantify(sample.atoms, *sample.unit_cell, options), UsageError);
    options = {};
  }
  options.smoothing = 11;
  EXPECT_THROW(quantify(sample.atoms, *sample.unit_cell, options), UsageError);
}

// Softer along one axis: the amplitude is that axis's.
TEST(ThermalDefects, TheSoftestDirectionCounts) {
  Sample sample = planted("rock-salt", 0.0, 4, 0);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Vec3 soft = glm::normalize(Vec3(1, 2, -1));
  for (Vec3& p : sample.atoms.positions) {
    const double x = normal(random);
    const double y = normal(random);
    p += 0.02 * Vec3(x, y, normal(random)) + 0.07 * normal(random) * soft;
  }
  const Quantified q = quantify(sample.atoms, *sample.unit_cell);
  EXPECT_NEAR(q.report.noise, std::hypot(0.02, 0.07), 0.006);
  EXPECT_EQ(q.report.positional_atoms, 0u);
}

// Strain is no noise, however much of it there is and wherever.
TEST(ThermalDefects, StrainedSamplesKeepTheirValues) {
  DefectOptions none;
  none.noise = 0.0;
  for (const char* name : {"nacl-cracked", "quantum-dot", "graphite-slided", "cu-line-defect"}) {
    SampleOptions options;
    options.atoms = 8000;
    const Sample sample = make_sample(name, options);
    const Quantified estimated = quantify(sample.atoms, *sample.unit_cell);
    const Quantified told = quantify(sample.atoms, *sample.unit_cell, none);
    EXPECT_EQ(estimated.defects.positional, told.defects.positional) << name << ", " << estimated.report.noise;
    EXPECT_GT(told.report.positional_atoms, 0u) << name;
  }
}

// Bent crystals, waves: smooth fields of every wavelength that is long beside the cell.
TEST(ThermalDefects, SmoothFieldsAreNotTakenForNoise) {
  const Lattice& fcc = lattice("fcc");
  for (const double wavelength : {60.0, 120.0}) {
    Atoms atoms = cut_block(fcc.cell, 12, 12, 12);
    const double k = 2.0 * std::numbers::pi / wavelength;
    for (Vec3& p : atoms.positions) p += 0.4 * Vec3(std::sin(k * p.y), std::sin(k * p.z), std::cos(k * p.x));
    const Quantified q = quantify(atoms, fcc.cell);
    EXPECT_LT(q.report.noise_limit, 0.006) << wavelength;
    EXPECT_GT(q.report.positional_atoms, atoms.size() * 9 / 10) << wavelength;
  }
}

// The strain of a vortex 60 Å wide, at most 2 % from neighbour to neighbour, in noise of as much: lost in it pair by
// pair, plain once neighbours are averaged.
TEST(ThermalDefects, SmoothingBringsStrainOutOfTheNoise) {
  const Lattice& fcc = lattice("fcc");
  Atoms atoms = periodic_block(fcc.cell, 20, 20, 8);
  const double edge = fcc.cell.primitive[0].x;
  const Vec3 centre = 10.0 * Vec3(edge, edge, 0.0);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 0.02 * fcc.nearest_neighbour);
  std::vector<bool> strained;
  for (Vec3& p : atoms.positions) {
    const Vec3 r(p.x - centre.x, p.y - centre.y, 0.0);
    const double distance = glm::length(r);
    strained.push_back(distance > 6.0 && distance < 12.0);
    p += 3.0 * std::exp(-distance * distance / 150.0) * (distance > 0.0 ? Vec3(-r.y, r.x, 0.0) / 20.0 : Vec3(0.0));
    const double x = normal(random);
    const double y = normal(random);
    p += Vec3(x, y, normal(random));
  }
  const auto shown = [&](const Quantified& q, bool in) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < strained.size(); ++i) count += strained[i] == in && q.defects.positional[i] > 0.0F;
    return count;
  };
  const auto inside = static_cast<std::size_t>(std::count(strained.begin(), strained.end(), true));
  DefectOptions options;
  const Quantified raw = quantify(atoms, fcc.cell, options);
  options.smoothing = 2;
  const Quantified smooth = quantify(atoms, fcc.cell, options);
  EXPECT_NEAR(raw.report.noise, 0.02 * fcc.nearest_neighbour, 0.15 * 0.02 * fcc.nearest_neighbour);
  EXPECT_LT(shown(raw, true), inside / 2);
  EXPECT_GT(shown(smooth, true), inside * 8 / 10);
  // Averaging makes nothing where there is nothing.
  const Sample warm = planted("bcc", 0.03, 4, 0);
  for (const int rounds : {1, 2, 5}) {
    options.smoothing = rounds;
    EXPECT_EQ(quantify(warm.atoms, *warm.unit_cell, options).report.positional_atoms, 0u) << rounds;
  }
}

UnitCell changed(UnitCell cell, const Mat3& matrix) {
  return turned(cell, matrix);
}

// Lattice constants of another temperature, of one axis only, and crystals that lie a tiny angle off.
TEST(ThermalDefects, CellsALittleOffAreFittedToTheSample) {
  const auto rotation = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180.0;
    return Mat3(Vec3(std::cos(a), std::sin(a), 0), Vec3(-std::sin(a), std::cos(a), 0), Vec3(0, 0, 1));
  };
  for (const std::string& structure : structures) {
    for (const double noise : {0.0, 0.0005, 0.01}) {
      if (noise > 0.0 && structure != "fcc" && structure != "diamond") continue;
      const Sample sample = planted(structure, noise, 4);
      for (const Mat3& matrix :
           {Mat3(0.997), Mat3(Vec3(1, 0, 0), Vec3(0, 1.003, 0), Vec3(0, 0, 1)), rotation(0.1), rotation(1.0)}) {
        const UnitCell cell = changed(*sample.unit_cell, matrix);
        const Quantified q = quantify(sample.atoms, cell);
        const Score result = score(sample, q.defects, 0.3 * find_structure_type(structure).nearest_neighbour);
        EXPECT_EQ(result.found, result.planted) << structure << " " << noise;
        EXPECT_EQ(result.invented, 0u) << structure << " " << noise;
        EXPECT_EQ(q.report.positional_atoms, 0u) << structure << " " << noise;
      }
    }
  }
}

TEST(ThermalDefects, AFittedCellIsNoted) {
  const Sample sample = planted("fcc", 0.0, 4);
  const auto noted = [&](const UnitCell& cell) {
    const Quantified q = quantify(sample.atoms, cell);
    return std::any_of(q.report.notes.begin(), q.report.notes.end(), [](const std::string& note) {
      return note.find("fitted to the sample") != std::string::npos && note.find("-0.299 %") != std::string::npos;
    });
  };
  EXPECT_FALSE(noted(*sample.unit_cell));
  EXPECT_TRUE(noted(changed(*sample.unit_cell, Mat3(1.003))));
}

}  // namespace
}  // namespace atomesh::test
