#include "app/gui/pick_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace atomesh::gui {

namespace {

std::string number(double value) {
  // No "-0.000".
  std::string text = fmt::format("{:.3f}", value);
  return text == "-0.000" ? "0.000" : text;
}

const char* unit(const Material& material) {
  return material.atoms.size() > 0 ? " Å" : "";
}

}  // namespace

PickDistance distance_between(const Pick& first, const Pick& second, const Material& material) {
  PickDistance distance;
  const Vec3 straight = second.position - first.position;
  distance.way = shortest_way(material.atoms.box, first.position, second.position);
  distance.length = glm::length(distance.way);
  distance.straight = glm::length(straight);
  distance.through_boundary = distance.way != straight;
  return distance;
}

std::vector<PickRow> pick_rows(const std::vector<Pick>& picks, const Material& material) {
  std::vector<PickRow> rows;
  for (std::size_t p = 0; p < picks.size(); ++p) {
    for (auto& [label, value] : describe(picks[p], material)) {
      // Of labels that occur twice (columns of a file) the first that has no value of this pick yet.
      const auto same = std::find_if(rows.begin(), rows.end(), [&, &name = label](const PickRow& row) {
        return row.label == name && row.values[p].empty();
      });
      if (same != rows.end()) {
        same->values[p] = value;
        continue;
      }
      rows.push_back({label, std::vector<std::string>(picks.size())});
      rows.back().values[p] = value;
    }
  }
  return rows;
}

std::string length_text(double length, const Material& material) {
  return number(length) + unit(material);
}

std::string distance_text(const PickDistance& distance, const Material& material) {
  const Vec3& way = distance.way;
  std::string text = fmt::format("Distance {}, way ({}, {}, {}){}", length_text(distance.length, material),
                                 number(way.x), number(way.y), number(way.z), unit(material));
  if (distance.through_boundary) {
    text += fmt::format(", through a periodic boundary (within the box {})", length_text(distance.straight, material));
  }
  return text;
}

std::string pick_text(const std::vector<Pick>& picks, const Material& material) {
  if (picks.empty()) return "";
  std::string text;
  for (const PickRow& row : pick_rows(picks, material)) {
    text += row.label;
    for (const std::string& value : row.values) text += '\t' + value;
    text += '\n';
  }
  for (const Neighbour& neighbour : picks.back().neighbours) {
    text += fmt::format("Neighbor\t{}\t{}\t{}\n", material.atoms.species_name(neighbour.atom), neighbour.atom,
                        length_text(neighbour.distance, material));
  }
  if (picks.size() > 1) text += distance_text(distance_between(picks[0], picks[1], material), material) + '\n';
  return text;
}

}  // namespace atomesh::gui
