#include "preprocess/cluster_defects.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/error.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

namespace {

constexpr std::array<std::string_view, 5> kind_names{"vacancy", "extra", "positional", "mixed", "substitution"};
// Joins first neighbours and not second ones: fcc's are 1.41, bcc's (which belong together) 1.15 apart.
constexpr double joining = 1.3;

// Disjoint sets; the root of a set is its smallest member.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index root(Index i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

// What is joined: atoms with a value that is not zero and extra atoms, then vacancy sites.
struct Members {
  std::vector<Index> atom;  // of the first ones
  std::vector<Vec3> positions;
};

Members collect(const Material& material) {
  const Defects& defects = material.defects;
  std::vector<std::uint8_t> taken(material.atoms.size(), 0);
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = defects.defective(i) ? 1 : 0;
  for (const ExtraAtom& extra : defects.extras) taken[extra.atom] = 1;
  Members members;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (!taken[i]) continue;
    members.atom.push_back(static_cast<Index>(i));
    members.positions.push_back(material.atoms.positions[i]);
  }
  for (const VacancySite& site : defects.vacancies) members.positions.push_back(site.position);
  return members;
}

// Sites decide; where a cluster has none, what its atoms' values are mostly made of. An atom displaced beyond the
// tolerance is missing at one place and extra at another, so equal sums mean displacement.
DefectKind kind_of(const DefectCluster& cluster, const Defects& defects) {
  const bool vacancies = !cluster.vacancies.empty();
  const bool extras = !cluster.extras.empty();
  const std::size_t pairs = cluster.substitutions.size();
  if (pairs > 0 && pairs == cluster.vacancies.size() && pairs == cluster.extras.size()) {
    return DefectKind::substitution;
  }
  if (vacancies && extras) return DefectKind::mixed;
  if (vacancies) return DefectKind::vacancy;
  if (extras) return DefectKind::extra;
  double missing = 0.0;
  double surplus = 0.0;
  for (const Index atom : cluster.atoms) {
    missing += static_cast<double>(defects.vacancy[atom]);
    surplus += static_cast<double>(defects.extra[atom]);
  }
  if (missing > 2.0 * surplus) return DefectKind::vacancy;
  if (surplus > 2.0 * missing) return DefectKind::extra;
  return DefectKind::positional;
}

}  // namespace

std::string_view defect_kind_name(DefectKind kind) {
  return kind_names[static_cast<std::size_t>(kind)];
}

DefectKind defect_kind_from_name(std::string_view name) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), name);
  if (found != kind_names.end()) return static_cast<DefectKind>(found - kind_names.begin());
  std::string message = "no kind of defect is called \"" + std::string(name) + "\"";
  const std::string near = nearest_name(name, kind_names);
  if (!near.empty()) message += "; did you mean \"" + near + "\"?";
  throw UsageError(message + " Kinds: vacancy, extra, positional, mixed, substitution");
}

std::vector<DefectCluster> cluster_defects(const Material& material, double distance, Progress& progress) {
  if (!(distance >= 0.0)) {
    throw UsageError("distance of defect clusters: expected a length in Å, got " + std::to_string(distance));
  }
  const Members members = collect(material);
  if (members.positions.empty()) return {};
  if (distance == 0.0)
    distance = joining * median_nearest_distance(material.atoms.positions, material.atoms.box, progress);
  if (distance == 0.0) distance = 1.0;  // a single atom has no neighbour
  const NeighbourGrid grid(members.positions, material.atoms.box, distance, distance, progress);
  Sets sets(members.positions.size());
  std::vector<Index> slots;
  std::size_t looked = 0;
  for (const Index home : grid.home_slots()) {
    if (++looked % 4096 == 0) progress.check();
    grid.find(grid.position(home), distance, slots, home);
    for (const Index slot : slots) sets.join(grid.point(home), grid.point(slot));
  }

  std::vector<DefectCluster> clusters;
  std::vector<Index> number(members.positions.size(), no_index);  // cluster of each root
  std::vector<std::vector<Index>> parts;
  for (Index m = 0; m < members.positions.size(); ++m) {
    if (m % 65536 == 0) progress.check();
    Index& cluster = number[sets.root(m)];
    if (cluster == no_index) {
      cluster = static_cast<Index>(clusters.size());
      clusters.emplace_back();
      parts.emplace_back();
    }
    parts[cluster].push_back(m);
    if (m < members.atom.size()) {
      clusters[cluster].atoms.push_back(members.atom[m]);
    } else {
      clusters[cluster].vacancies.push_back(m - static_cast<Index>(members.atom.size()));
    }
  }
  const std::vector<ExtraAtom>& extras = material.defects.extras;
  const std::vector<Substitution>& substitutions = material.defects.substitutions;
  std::vector<Index> extra_of(material.atoms.size(), no_index);
  for (Index e = 0; e < extras.size(); ++e) extra_of[extras[e].atom] = e;
  std::vector<Index> substitution_of(extras.size(), no_index);
  for (Index s = 0; s < substitutions.size(); ++s) substitution_of[extra_of[substitutions[s].atom]] = s;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    progress.check();
    DefectCluster& cluster = clusters[c];
    // Members on the other side of a periodic face are taken next to the first one.
    const Vec3 first = members.positions[parts[c][0]];
    Bounds bounds;
    for (const Index m : parts[c]) bounds.add(first + grid.nearest_image(members.positions[m] - first));
    cluster.centre = grid.wrap(bounds.center());
    cluster.radius = 0.0;
    for (const Index m : parts[c]) {
      const Vec3 place = first + grid.nearest_image(members.positions[m] - first);
      cluster.radius = std::max(cluster.radius, glm::distance(place, bounds.center()));
    }
    cluster.peak = 0.0F;
    for (const Index atom : cluster.atoms) {
      if (extra_of[atom] != no_index) {
        cluster.extras.push_back(extra_of[atom]);
        const Index substitution = substitution_of[extra_of[atom]];
        if (substitution != no_index) cluster.substitutions.push_back(substitution);
      }
      const Defects& d = material.defects;
      cluster.peak = std::max({cluster.peak, d.positional[atom], d.vacancy[atom], d.extra[atom]});
    }
    cluster.kind = kind_of(cluster, material.defects);
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const DefectCluster& a, const DefectCluster& b) { return a.atoms.size() > b.atoms.size(); });
  return clusters;
}

}  // namespace atomesh
