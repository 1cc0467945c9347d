// From what single atoms miss and find too much to sites: where a vacancy is, and which atoms are extra.
#pragma once

#include <span>
#include <vector>

#include "core/defects.h"
#include "core/progress.h"
#include "preprocess/sample_view.h"

namespace atomesh {

// One atom whose surroundings are not the perfect crystal's. `missing` are entries of its kind where nobody is,
// `strays` slots of neighbours that fit no entry and are nobody's displaced occupant.
struct Misfit {
  Index slot;
  std::uint16_t kind;  // no_kind for an atom on no site: it misses nothing and has no strays
  Vec3 site;           // Å, where its surroundings say it should be
  std::size_t first_missing, missing;
  std::size_t first_stray, strays;
};

// In the order of the grid's home slots.
struct Misfits {
  std::vector<Misfit> atoms;
  std::vector<std::uint32_t> missing;
  std::vector<Index> strays;

  std::span<const std::uint32_t> missing_of(const Misfit& m) const {
    return {missing.data() + m.first_missing, m.missing};
  }
  std::span<const Index> strays_of(const Misfit& m) const { return {strays.data() + m.first_stray, m.strays}; }
};

// What the search for sites goes by.
struct SiteSearch {
  const SampleView& sample;
  // Of each atom: the grain that most of its near neighbours are in place of (its word can be relied on), or no_grain.
  const std::vector<std::uint16_t>& standing;
  const Misfits& misfits;

  bool reliable(Index slot) const { return standing[sample.grid.point(slot)] != no_grain; }
};

// Reliable atoms vote for the near entries they miss; votes for one place make a candidate. Candidates are judged by
// the void they belong to: empty sites linked to their neighbours. A vacancy lies in a closed void of at most 64
// sites, one of which at least is enclosed (SiteKind::enclosed of its near sites hold an atom); most of the reliable
// atoms next to it vote for it and no atom of its species is within the pair distance. A void that goes on is the
// outside of the sample, however its surface is shaped, so an atom missing from the outermost layer is no vacancy. A
// place that an atom of another species took needs no closed void. Sorted by position (z, then y, then x). `votes`
// is left for the caller to refine: here it counts the near atoms.
//
// Where there are several grains, what is missing or too much across a boundary is the boundary. Sites are listed only
// inside a grain: all reliable atoms in the first shells around belong to it, and hardly anybody there (a sixth of
// them) fits none of its sites. Within the first shells of a boundary only the atoms' values tell.
std::vector<VacancySite> find_vacancies(const SiteSearch& search, Progress& progress);

// Atoms of a species that the unit cell lacks, and atoms that most of the reliable atoms near them cannot place; with
// several grains only where three quarters of the atoms near them are reliable and of one grain. Ascending; an
// interstitial, a substituted atom, the second atom on one site.
std::vector<ExtraAtom> find_extras(const SiteSearch& search, Progress& progress);

// Extra atoms that took a vacant site: within the pair distance of it, of another species, nearest first, each once.
std::vector<Substitution> find_substitutions(const SiteSearch& search, const std::vector<VacancySite>& vacancies,
                                             const std::vector<ExtraAtom>& extras);

}  // namespace atomesh
