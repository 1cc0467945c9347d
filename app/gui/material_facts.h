// What is open, at a glance: file, counts, species, box, unit cell, how it was made.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/gui/document.h"

namespace atomesh::gui {

// A heading with its rows of label and value.
struct MaterialFacts {
  std::string heading;
  std::vector<std::pair<std::string, std::string>> rows;
};
// In the order to be read; counts of what was not read yet are left out.
std::vector<MaterialFacts> material_facts(const Document& document);

}  // namespace atomesh::gui
