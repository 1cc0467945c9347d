// Clusters of defects and their sites as tables, the same for `atomesh defects` and for the window.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "app/cli/text_table.h"
#include "preprocess/cluster_defects.h"

namespace atomesh::cli {

// kind, x, y, z, radius, atoms, vacancies, extras, substitutions, peak; lengths in Å. One row each, in their order.
TextTable cluster_table(const std::vector<DefectCluster>& clusters);

// The vacant sites, then the extra atoms, then the substitutions, whose site and atom are among the former; one of the
// three with `kind`, the first `top` where that is not 0. Column expected: the species that the crystal has where an
// atom is a substitution.
TextTable site_table(const Material& material, std::optional<DefectKind> kind, std::size_t top);

}  // namespace atomesh::cli
