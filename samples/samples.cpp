#include "samples/samples.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "samples/generators.h"

namespace atomesh {

namespace {

using Generator = Sample (*)(std::size_t atoms, std::uint64_t seed, Progress& progress);

struct Entry {
  SampleInfo info;
  std::size_t smallest;  // atoms; below it what the sample shows does not fit
  Generator grow;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> table{
      {{"nacl-cracked",
        "NaCl cracked",
        25725,
        "Rock salt (a = 5.64 Å) with a half-elliptical crack on a {100} plane, open by up to 1.4 Å at its mouth on the "
        "face x = 0; no atom is missing",
        {9254, 707, 66, 11, 275, 28}},
       1000,
       grow_nacl_cracked},
      {{"cu-line-defect",
        "Cu line defect",
        173677,
        "Copper (a = 3.615 Å) with a screw dislocation a/2 [110] along z, the field of isotropic elasticity; no atom "
        "is missing",
        {171559, 1329, 269, 15, 302, 187}},
       2000,
       grow_cu_line_defect},
      {{"diamond-vacancy",
        "Diamond vacancy defect",
        44982,
        "Diamond (a = 3.567 Å) with single vacancies, pairs of neighbouring vacancies and clusters of four",
        {17824, 891, 109, 14, 266, 49}},
       3000,
       grow_diamond_vacancy},
      {{"diamond-a-centers",
        "A centers in diamond",
        45005,
        "Diamond with pairs of neighbouring nitrogen atoms on carbon sites, each pushed 0.05 Å away from the other",
        {18072, 879, 112, 15, 265, 49}},
       3000,
       grow_diamond_a_centers},
      {{"graphite-slided",
        "Graphite slided",
        66576,
        "AB graphite (a = 2.461 Å, c = 6.708 Å) in which two stacks of layers have slid by 0.40 and 0.33 Å",
        {140563, 1405, 138, 13, 284, 72}},
       4000,
       grow_graphite_slided},
      {{"palladium-hydrogen",
        "Palladium with hydrogen",
        137549,
        "Palladium (a = 3.89 Å) with hydrogen on octahedral sites, taken up through the face x = 0 (a diffusion "
        "profile)",
        {103399, 1471, 254, 14, 298, 148}},
       2000,
       grow_palladium_hydrogen},
      {{"cacuo2-spiral",
        "CaCuO2 spiral",
        199764,
        "A cylinder of infinite-layer CaCuO2 (a = 3.86 Å, c = 3.20 Å) with a helical channel bored from end to end",
        {114221, 1484, 305, 16, 337, 216}},
       8000,
       grow_cacuo2_spiral},
      {{"sponge",
        "Sponge",
        534841,
        "Silicon of a sponge of silicon (30 vol. %) and oxide (the empty space): spinodal decomposition by a "
        "Cahn-Hilliard phase-field run, filled with diamond sites moved at random by up to 0.12 Å along each axis; no "
        "unit cell",
        {602869, 2748, 1015, 22, 471, 578}},
       20000,
       grow_sponge},
      {{"quantum-dot",
        "Quantum dot",
        86338,
        "An InAs lens on a wetting layer of one monolayer, buried in GaAs and relaxed by Keating's force field; column "
        "indium is 1 on indium, else 0 (each indium is an extra atom on a vacant gallium site)",
        {84376, 611, 145, 16, 175, 114}},
       6000,
       grow_quantum_dot},
      {{"quantum-dot-alloyed",
        "Quantum dot, alloyed",
        125595,
        "The quantum dot with a random 20 % of the cations of lens and wetting layer indium, the others gallium",
        {1161757, 730, 196, 16, 182, 181}},
       6000,
       grow_quantum_dot_alloyed},
  };
  return table;
}

}  // namespace

const std::vector<SampleInfo>& sample_table() {
  static const std::vector<SampleInfo> table = [] {
    std::vector<SampleInfo> infos;
    for (const Entry& entry : entries()) infos.push_back(entry.info);
    return infos;
  }();
  return table;
}

Sample make_sample(std::string_view name, const SampleOptions& options, Progress& progress) {
  const auto& table = entries();
  const auto entry =
      std::find_if(table.begin(), table.end(), [name](const Entry& candidate) { return candidate.info.name == name; });
  if (entry == table.end()) {
    std::vector<std::string_view> names;
    std::string all;
    for (const Entry& candidate : table) {
      names.push_back(candidate.info.name);
      all.append(all.empty() ? "" : ", ").append(candidate.info.name);
    }
    const std::string nearest = nearest_name(name, names);
    throw UsageError("no sample is called \"" + std::string(name) + "\"" +
                     (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?") + " (there are " + all + ")");
  }
  const std::size_t atoms = options.atoms == 0 ? entry->info.seed_atoms : options.atoms;
  if (atoms < entry->smallest) {
    throw UsageError("sample " + std::string(name) + " needs at least " + std::to_string(entry->smallest) +
                     " atoms to hold what it shows; " + std::to_string(atoms) + " were asked for");
  }
  // A block may turn out a little larger than asked for, and indices are 32-bit.
  constexpr std::size_t largest = std::numeric_limits<Index>::max() / 2;
  if (atoms > largest) {
    throw UsageError("a sample may have at most " + std::to_string(largest) + " atoms; " + std::to_string(atoms) +
                     " were asked for");
  }
  progress.stage("grow");
  return entry->grow(atoms, options.seed, progress);
}

}  // namespace atomesh
