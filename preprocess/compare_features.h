// One atom's neighbourhood matched with the feature vectors of its species (compareFeatures of the seed's A.3).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "preprocess/feature_vectors.h"

namespace atomesh {

struct Neighbour {
  Vec3 d;  // Å, from the centre
  std::uint16_t species;
};

inline constexpr std::uint16_t no_kind = 0xFFFF;

// How a neighbourhood was matched. Entries are those of features.kinds[kind].
struct Match {
  std::uint16_t kind = no_kind;  // no_kind: the centre sits on no site of its species
  Vec3 shift{0.0};               // Å, from the centre to its site, as the matched neighbours tell; 0 for a clean match
  std::vector<int> entry;        // of each neighbour, -1: fits none
  std::vector<int> neighbour;    // of each entry, -1: nobody is there
  std::size_t near_matched = 0;
  std::size_t near_stray = 0;  // near neighbours of the cell's species that fit no entry
  std::size_t matched = 0;
  double squares = 0.0;  // Å², Σ over the matched of |d + shift - offset|²

  // At least half of what is near the centre fits nowhere: the centre is no atom of this crystal.
  bool lost() const { return kind == no_kind || (near_stray > 0 && near_stray >= near_matched); }
  // Most of what is near the centre is where the crystal has it: the match can be believed.
  bool reliable() const { return kind != no_kind && near_matched >= 2 && near_matched >= 2 * near_stray; }
};

// Keeps its memory from one atom to the next. One per thread.
class FeatureComparer {
 public:
  explicit FeatureComparer(const FeatureSet& features) : features_(features) {}

  // Matches all neighbours within features.search_radius of an atom that may be of any of `kinds`; it belongs to the
  // one that matches best: most near neighbours, then most of all, then least squares. The result stays valid until the
  // next call.
  const Match& match(std::span<const std::uint16_t> kinds, const std::vector<Neighbour>& neighbours);
  // For an atom that match() finds displaced or lost: takes the neighbours within search_radius + pair_distance and
  // looks for the shift that puts the atom onto its site. A shift onto a site that holds an atom already is none.
  const Match& match_shifted(std::span<const std::uint16_t> kinds, const std::vector<Neighbour>& neighbours);
  // Matches one kind at a given shift; any species fits any entry when `any_species`.
  const Match& match_kind(std::uint16_t kind, const Vec3& shift, const std::vector<Neighbour>& neighbours,
                          bool any_species = false);

 private:
  void fill(Match& match, std::uint16_t kind, const Vec3& shift, const std::vector<Neighbour>& neighbours,
            bool any_species) const;
  void rank(std::span<const std::uint16_t> kinds, const std::vector<Neighbour>& neighbours);
  void refine(const std::vector<Neighbour>& neighbours);
  bool site_taken(std::uint16_t species, const Vec3& shift, const std::vector<Neighbour>& neighbours) const;

  struct Ranked {
    std::size_t most;
    std::uint16_t kind;
  };

  const FeatureSet& features_;
  std::vector<Ranked> ranked_;
  Match best_;
  Match trial_;
};

}  // namespace atomesh
