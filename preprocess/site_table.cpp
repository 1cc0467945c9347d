#include <bit>

#include "preprocess/lattice_sites.h"

namespace atomesh {

namespace {

// Dense where that costs no more than the hash table would: 4 bytes a site against 12 bytes for one slot in two.
constexpr std::uint64_t dense_sites_per_atom = 8, always_dense = 4096;

}  // namespace

SiteTable::SiteTable(const std::array<std::int32_t, 3>& min, const std::array<std::int32_t, 3>& max, std::size_t basis,
                     std::size_t atoms)
    : basis_(basis) {
  double sites = static_cast<double>(basis);
  for (int k = 0; k < 3; ++k) {
    min_[k] = min[k];
    size_[k] = std::int64_t{max[k]} - min[k] + 1;
    sites *= static_cast<double>(size_[k]);
  }
  if (sites <= static_cast<double>(dense_sites_per_atom * atoms + always_dense)) {
    dense_.assign(static_cast<std::size_t>(sites), no_index);
  } else {
    const std::size_t slots = std::bit_ceil(2 * atoms + 16);
    keys_.assign(slots, no_key);
    values_.assign(slots, no_index);
  }
}

SiteTable::SiteTable(const LatticeSites& sites, std::uint16_t patch)
    : SiteTable(sites.patches[patch].min, sites.patches[patch].max,
                sites.patterns[sites.patches[patch].pattern].cell.basis.size(), sites.patches[patch].atoms) {
  for (std::size_t i = 0; i < sites.of.size(); ++i) {
    if (sites.of[i].patch == patch) put(sites.of[i].cell, sites.of[i].basis, static_cast<Index>(i));
  }
}

std::size_t SiteTable::slot(std::uint64_t key) const {
  const std::size_t mask = keys_.size() - 1;
  std::uint64_t mixed = key * 0x9E3779B97F4A7C15ULL;
  mixed ^= mixed >> 29;
  std::size_t place = mixed & mask;
  while (keys_[place] != no_key && keys_[place] != key) place = (place + 1) & mask;
  return place;
}

void SiteTable::put(const std::array<std::int32_t, 3>& cell, std::uint16_t basis, Index atom) {
  const std::uint64_t key = key_of(cell, basis);
  if (key == no_key) return;
  if (!dense_.empty()) {
    dense_[key] = atom;
    return;
  }
  const std::size_t place = slot(key);
  if (keys_[place] == no_key && 2 * ++taken_ > keys_.size()) {
    std::vector<std::uint64_t> keys(2 * keys_.size(), no_key);
    std::vector<Index> values(keys.size(), no_index);
    keys.swap(keys_);
    values.swap(values_);
    for (std::size_t n = 0; n < keys.size(); ++n) {
      if (keys[n] == no_key) continue;
      const std::size_t moved = slot(keys[n]);
      keys_[moved] = keys[n];
      values_[moved] = values[n];
    }
    put(cell, basis, atom);
    return;
  }
  keys_[place] = key;
  values_[place] = atom;
}

}  // namespace atomesh
