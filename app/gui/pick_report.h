// What is said of what is picked: one row for each thing known, the way from the first to the second, all as text.
#pragma once

#include <string>
#include <vector>

#include "app/gui/pick.h"
#include "core/material.h"

namespace atomesh::gui {

struct PickDistance {
  Vec3 way{0.0};          // from the first to the second, the shortest through periodic boundaries; Å
  double length = 0.0;    // of it
  double straight = 0.0;  // not through any boundary
  bool through_boundary = false;
};
PickDistance distance_between(const Pick& first, const Pick& second, const Material& material);

// A row of describe() with what each pick has there; "" for one that has it not. Rows in the order of the first pick,
// then those that only the second has.
struct PickRow {
  std::string label;
  std::vector<std::string> values;  // one for each pick
};
std::vector<PickRow> pick_rows(const std::vector<Pick>& picks, const Material& material);

// "2.820 Å"; without unit where the file does not say one.
std::string length_text(double length, const Material& material);
// "Distance 5.640 Å, way (0.000, 5.640, 0.000) Å", and that it goes through a periodic boundary.
std::string distance_text(const PickDistance& distance, const Material& material);

// Everything, for the clipboard: "Label<tab>value[<tab>value]" lines, neighbours of the last pick one a line, distance.
std::string pick_text(const std::vector<Pick>& picks, const Material& material);

}  // namespace atomesh::gui
