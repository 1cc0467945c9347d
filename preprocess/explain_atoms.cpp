#include "preprocess/explain_atoms.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t blocks_a_range = 64;
constexpr std::size_t asked_for_origin = 32;  // atoms that judge an origin
constexpr std::size_t proposing = 8;          // atoms that propose one
constexpr std::size_t most_borrowed = 3;      // origins a block takes from those beside it
// Share of a block's atoms that an origin must suit: a twin's layers suit an origin by two of four, so half is not
// enough. And of what is left for an origin from beside.
constexpr double own_share = 0.75;
constexpr double borrowed_share = 0.2;
constexpr double filled_share = 0.9;
// Atoms a block must have to find an origin of its own: fewer fit anything.
constexpr std::size_t least_atoms = 12;

struct Member {
  Vec3 position;  // Å, from the cell's origin
  std::uint16_t species;
  Index atom;
};

struct Trial {
  std::size_t hits = 0;
  Vec3 mean{0.0};
};

class BlockFitter {
 public:
  BlockFitter(const FittedCell& cell)
      : cell_(cell), limit_(0.25 * cell.nearest), lookup_(cell.vectors, cell.sites, limit_) {}

  double limit() const { return limit_; }
  SiteHit hit(const Vec3& p) const { return lookup_.find(p); }

  Trial ask(std::span<const Member> members, const Vec3& shift, std::size_t count) const {
    Trial trial;
    // Evenly chosen: the members are sorted along x.
    count = std::min(count, members.size());
    for (std::size_t n = 0; n < count; ++n) {
      const SiteHit hit = lookup_.find(members[n * members.size() / count].position - shift);
      if (hit.site < 0) continue;
      ++trial.hits;
      trial.mean += hit.offset;
    }
    if (trial.hits > 0) trial.mean /= static_cast<double>(trial.hits);
    return trial;
  }

  // Moves the origin to where its atoms say.
  Trial settle(std::span<const Member> members, Vec3& shift) const {
    Trial trial = ask(members, shift, members.size());
    for (int round = 0; round < 3 && glm::length(trial.mean) > 0.02 * limit_; ++round) {
      const Vec3 next = shift + trial.mean;
      const Trial better = ask(members, next, members.size());
      if (better.hits < trial.hits) break;
      shift = next;
      trial = better;
    }
    return trial;
  }

  // The origin most of the members agree on.
  Trial vote(std::span<const Member> members, Vec3& shift) const {
    std::size_t best = 0;
    const std::size_t count = std::min(proposing, members.size());
    for (std::size_t n = 0; n < count; ++n) {
      const Member& m = members[(2 * n + 1) * members.size() / (2 * count)];
      const bool known = std::find(cell_.species.begin(), cell_.species.end(), m.species) != cell_.species.end();
      for (std::size_t j = 0; j < cell_.sites.size(); ++j) {
        if (known && cell_.species[j] != m.species) continue;
        const Vec3 proposed = m.position - cell_.sites[j];
        const Trial trial = ask(members, proposed, asked_for_origin);
        if (trial.hits <= best) continue;
        best = trial.hits;
        shift = proposed + trial.mean;
      }
    }
    return settle(members, shift);
  }

 private:
  const FittedCell& cell_;
  double limit_;
  SiteLookup lookup_;
};

// Atoms of one block against one cell.
class BlockWork {
 public:
  BlockWork(const Atoms& atoms, const FittedCell& cell, const BlockFitter& fitter, std::vector<std::uint8_t>& on_site)
      : atoms_(atoms), cell_(cell), fitter_(fitter), on_site_(on_site), known_(atoms.species_table.size(), 0) {
    for (const std::uint16_t species : cell.species) known_[species] = 1;
  }

  template <class Keep>
  void gather(std::span<const Index> block, Keep&& keep) {
    members_.clear();
    judges_.clear();
    for (const Index i : block) {
      if (!keep(i)) continue;
      members_.push_back({atoms_.positions[i] - cell_.origin, atoms_.species[i], i});
      if (known_[atoms_.species[i]] != 0) judges_.push_back(members_.back());
    }
    if (judges_.size() < least_atoms) judges_ = members_;
  }
  std::size_t left() const { return members_.size(); }

  // 0: the block has no origin; otherwise the share of its atoms that suit it.
  double find_origin(Vec3& origin, Explained& sum) {
    if (judges_.size() < least_atoms) return 0.0;
    // Unstrained, the origin is the same everywhere.
    origin = Vec3(0.0);
    Trial trial = fitter_.settle(judges_, origin);
    if (10 * trial.hits < 9 * judges_.size()) {
      Vec3 voted(0.0);
      const Trial vote = fitter_.vote(judges_, voted);
      if (vote.hits > trial.hits) {
        trial = vote;
        origin = voted;
      }
    }
    const double share = static_cast<double>(trial.hits) / static_cast<double>(judges_.size());
    if (share < own_share) return 0.0;
    take(origin, sum);
    return share;
  }

  // The origin that suits most of what is left, of those given.
  bool borrow(const std::vector<Vec3>& origins, Explained& sum) {
    const Vec3* best = nullptr;
    double hits = borrowed_share * static_cast<double>(members_.size());
    for (const Vec3& origin : origins) {
      const double suit = static_cast<double>(fitter_.ask(members_, origin, members_.size()).hits);
      if (suit <= hits || !suits_species(origin)) continue;
      hits = suit;
      best = &origin;
    }
    if (best == nullptr) return false;
    take(*best, sum);
    return true;
  }

 private:
  // What is left may be a sublattice between the sites (interstitials), which an origin suits by position alone: at
  // least half of the atoms of the cell's species must be where their species belongs.
  bool suits_species(const Vec3& shift) const {
    std::size_t asked = 0;
    std::size_t right = 0;
    for (const Member& m : members_) {
      if (known_[m.species] == 0) continue;
      const SiteHit hit = fitter_.hit(m.position - shift);
      if (hit.site < 0) continue;
      ++asked;
      right += cell_.species[static_cast<std::size_t>(hit.site)] == m.species ? 1 : 0;
    }
    return 2 * right >= asked;
  }

  void take(const Vec3& shift, Explained& sum) {
    sum.at_site.resize(cell_.sites.size());
    std::erase_if(members_, [&](const Member& m) {
      const SiteHit hit = fitter_.hit(m.position - shift);
      if (hit.site < 0) return false;
      const auto site = static_cast<std::size_t>(hit.site);
      const double square = glm::dot(hit.offset, hit.offset);
      ++sum.atoms;
      if (cell_.species[site] != m.species) ++sum.foreign;
      sum.squares += square;
      sum.closeness += 1.0 - square / (fitter_.limit() * fitter_.limit());
      ++sum.at_site[site][m.species];
      on_site_[m.atom] = 1;
      return true;
    });
  }

  const Atoms& atoms_;
  const FittedCell& cell_;
  const BlockFitter& fitter_;
  std::vector<std::uint8_t>& on_site_;
  std::vector<std::uint8_t> known_;  // of each species: the cell has it
  std::vector<Member> members_, judges_;
};

}  // namespace

std::uint64_t StrainBlocks::key_of(const Place& place) {
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) key = key << 21 | (static_cast<std::uint64_t>(place[k] + 1) & 0x1FFFFF);
  return key;
}

StrainBlocks::StrainBlocks(const Atoms& atoms, double edge) {
  const Bounds bounds = bounds_of(atoms.positions);
  // A whole number of blocks along each axis, so that none at the borders is a sliver. Keys have 21 bits an axis; a
  // sample with a stray atom far away gets wider blocks rather than none.
  const Vec3 extent = bounds.extent();
  Vec3 edges(edge);
  for (int k = 0; k < 3; ++k) {
    edges[k] = std::max(1.0 + 1e-9, extent[k] * (1.0 + 1e-9)) / std::clamp(std::round(extent[k] / edge), 1.0, 1e6);
  }
  const auto place_of = [&](const Vec3& p) {
    const Vec3 f = glm::floor((p - bounds.min) / edges);
    return Place{static_cast<std::int32_t>(f.x), static_cast<std::int32_t>(f.y), static_cast<std::int32_t>(f.z)};
  };
  // Numbers the occupied blocks, then sorts the atoms by counting.
  std::vector<Index> block_of(atoms.size());
  std::vector<std::size_t> count;
  std::uint64_t last_key = ~std::uint64_t{0};
  std::size_t last = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const Place p = place_of(atoms.positions[i]);
    const std::uint64_t key = key_of(p);
    if (key != last_key) {
      const auto [entry, fresh] = block_at_.try_emplace(key, places_.size());
      if (fresh) {
        places_.push_back(p);
        count.push_back(0);
      }
      last_key = key;
      last = entry->second;
    }
    block_of[i] = static_cast<Index>(last);
    ++count[last];
  }
  // Numbered by place, so that the atoms' order is nothing.
  std::vector<std::size_t> by_place(places_.size());
  std::iota(by_place.begin(), by_place.end(), std::size_t{0});
  std::sort(by_place.begin(), by_place.end(), [this](std::size_t a, std::size_t b) { return places_[a] < places_[b]; });
  std::vector<std::size_t> number(places_.size());
  std::vector<Place> sorted;
  start_.assign(1, 0);
  for (std::size_t n = 0; n < by_place.size(); ++n) {
    number[by_place[n]] = n;
    sorted.push_back(places_[by_place[n]]);
    block_at_[key_of(sorted.back())] = n;
    start_.push_back(start_.back() + count[by_place[n]]);
  }
  places_ = std::move(sorted);
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  order_.resize(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) order_[next[number[block_of[i]]]++] = static_cast<Index>(i);
  parallel_for(size(), 4 * blocks_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      std::sort(order_.begin() + static_cast<std::ptrdiff_t>(start_[b]),
                order_.begin() + static_cast<std::ptrdiff_t>(start_[b + 1]), [&](Index i, Index j) {
                  const Vec3& p = atoms.positions[i];
                  const Vec3& q = atoms.positions[j];
                  return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
                });
    }
  });
}

void StrainBlocks::neighbours(std::size_t block, std::vector<std::size_t>& around) const {
  around.clear();
  for (int n = 0; n < 27; ++n) {
    if (n == 13) continue;
    Place place = places_[block];
    place[0] += n % 3 - 1;
    place[1] += n / 3 % 3 - 1;
    place[2] += n / 9 - 1;
    const auto found = block_at_.find(key_of(place));
    if (found != block_at_.end()) around.push_back(found->second);
  }
}

void Explained::add(const Explained& other) {
  atoms += other.atoms;
  foreign += other.foreign;
  squares += other.squares;
  closeness += other.closeness;
  if (at_site.size() < other.at_site.size()) at_site.resize(other.at_site.size());
  for (std::size_t j = 0; j < other.at_site.size(); ++j) {
    for (const auto& [species, count] : other.at_site[j]) at_site[j][species] += count;
  }
}

Claims explain_atoms(const Atoms& atoms, const StrainBlocks& blocks, const FittedCell& cell,
                     const std::vector<std::uint8_t>& other, const std::vector<std::uint16_t>& grain_of,
                     Progress& progress) {
  Claims claims;
  claims.on_site.assign(atoms.size(), 0);
  claims.filled.assign(blocks.size(), 0);
  claims.sum.at_site.resize(cell.sites.size());
  const BlockFitter fitter(cell);
  std::vector<Explained> parts((blocks.size() + blocks_a_range - 1) / blocks_a_range);
  claims.origin.assign(blocks.size(), Vec3(0.0));
  claims.has_origin.assign(blocks.size(), 0);
  std::vector<std::uint8_t> left(blocks.size(), 0);  // atoms are left that may go with a block beside
  const auto mine = [&](std::size_t b) { return other.empty() || other[b] == 0; };
  parallel_for(blocks.size(), blocks_a_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    BlockWork work(atoms, cell, fitter, claims.on_site);
    for (std::size_t b = begin; b < end; ++b) {
      left[b] = 1;
      if (!mine(b)) continue;
      work.gather(blocks.atoms(b), [](Index) { return true; });
      const double share = work.find_origin(claims.origin[b], parts[begin / blocks_a_range]);
      claims.has_origin[b] = share > 0.0 ? 1 : 0;
      claims.filled[b] = share >= filled_share ? 1 : 0;
      // One or two atoms are defects.
      left[b] = work.left() > 2 || share == 0.0 ? 1 : 0;
    }
  });
  parallel_for(blocks.size(), blocks_a_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    BlockWork work(atoms, cell, fitter, claims.on_site);
    std::vector<std::size_t> around;
    std::vector<Vec3> origins;
    for (std::size_t b = begin; b < end; ++b) {
      if (left[b] == 0) continue;
      blocks.neighbours(b, around);
      origins.clear();
      for (const std::size_t n : around) {
        if (claims.has_origin[n] != 0) origins.push_back(claims.origin[n]);
      }
      if (origins.empty()) continue;
      work.gather(blocks.atoms(b),
                  [&](Index i) { return claims.on_site[i] == 0 && (mine(b) || grain_of[i] == no_grain); });
      for (std::size_t n = 0; n < most_borrowed && work.left() > 0; ++n) {
        if (!work.borrow(origins, parts[begin / blocks_a_range])) break;
      }
    }
  });
  for (const Explained& part : parts) claims.sum.add(part);
  return claims;
}

}  // namespace atomesh
