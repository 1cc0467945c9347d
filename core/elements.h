// The chemical elements: symbol, number, colour and radius.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace atomesh {

struct Element {
  int number;                         // atomic number, 1 to 109
  std::string_view symbol;            // "Na"
  std::array<std::uint8_t, 3> color;  // sRGB, the Jmol table
  double radius;                      // Å, covalent (Cordero et al. 2008, doi 10.1039/b801115j); 1.5 where it has none
  double mass;                        // u, standard atomic weight; 0 where there is none
};

// Finds by symbol (case-sensitive, "Na"); nullptr when there is none.
const Element* find_element(std::string_view symbol);
// Finds by atomic number 1..109; nullptr outside.
const Element* find_element(int number);
// The element whose standard atomic weight is within 0.05 u of `mass`; nullptr when none or several fit. LAMMPS files
// name types by number only, and their masses tell the element.
const Element* find_element_by_mass(double mass);

// The colour a species is drawn with when the user has said nothing: its element's, else one of a fixed list of well
// distinguishable colours chosen by `ordinal` (types called "1", "2", …).
std::array<std::uint8_t, 3> default_species_color(std::string_view name, std::size_t ordinal);
// Å; the element's covalent radius, 1.0 for names that are no element.
double default_species_radius(std::string_view name);

}  // namespace atomesh
