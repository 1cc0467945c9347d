#include "core/elements.h"

#include <cmath>

namespace atomesh {

namespace {

// Colours: the element colours of Jmol (jmol.sourceforge.net/jscolors). Radii: Cordero et al. 2008, table 2; carbon is
// sp3, manganese, iron and cobalt are low-spin. Masses: IUPAC 2021, abridged to five digits (conventional values where
// the standard is an interval).
constexpr std::array<Element, 109> elements{{
    // clang-format off
    {1, "H", {0xFF, 0xFF, 0xFF}, 0.31, 1.008},
    {2, "He", {0xD9, 0xFF, 0xFF}, 0.28, 4.0026},
    {3, "Li", {0xCC, 0x80, 0xFF}, 1.28, 6.94},
    {4, "Be", {0xC2, 0xFF, 0x00}, 0.96, 9.0122},
    {5, "B", {0xFF, 0xB5, 0xB5}, 0.84, 10.81},
    {6, "C", {0x90, 0x90, 0x90}, 0.76, 12.011},
    {7, "N", {0x30, 0x50, 0xF8}, 0.71, 14.007},
    {8, "O", {0xFF, 0x0D, 0x0D}, 0.66, 15.999},
    {9, "F", {0x90, 0xE0, 0x50}, 0.57, 18.998},
    {10, "Ne", {0xB3, 0xE3, 0xF5}, 0.58, 20.180},
    {11, "Na", {0xAB, 0x5C, 0xF2}, 1.66, 22.990},
    {12, "Mg", {0x8A, 0xFF, 0x00}, 1.41, 24.305},
    {13, "Al", {0xBF, 0xA6, 0xA6}, 1.21, 26.982},
    {14, "Si", {0xF0, 0xC8, 0xA0}, 1.11, 28.085},
    {15, "P", {0xFF, 0x80, 0x00}, 1.07, 30.974},
    {16, "S", {0xFF, 0xFF, 0x30}, 1.05, 32.06},
    {17, "Cl", {0x1F, 0xF0, 0x1F}, 1.02, 35.45},
    {18, "Ar", {0x80, 0xD1, 0xE3}, 1.06, 39.95},
    {19, "K", {0x8F, 0x40, 0xD4}, 2.03, 39.098},
    {20, "Ca", {0x3D, 0xFF, 0x00}, 1.76, 40.078},
    {21, "Sc", {0xE6, 0xE6, 0xE6}, 1.7, 44.956},
    {22, "Ti", {0xBF, 0xC2, 0xC7}, 1.6, 47.867},
    {23, "V", {0xA6, 0xA6, 0xAB}, 1.53, 50.942},
    {24, "Cr", {0x8A, 0x99, 0xC7}, 1.39, 51.996},
    {25, "Mn", {0x9C, 0x7A, 0xC7}, 1.39, 54.938},
    {26, "Fe", {0xE0, 0x66, 0x33}, 1.32, 55.845},
    {27, "Co", {0xF0, 0x90, 0xA0}, 1.26, 58.933},
    {28, "Ni", {0x50, 0xD0, 0x50}, 1.24, 58.693},
    {29, "Cu", {0xC8, 0x80, 0x33}, 1.32, 63.546},
    {30, "Zn", {0x7D, 0x80, 0xB0}, 1.22, 65.38},
    {31, "Ga", {0xC2, 0x8F, 0x8F}, 1.22, 69.723},
    {32, "Ge", {0x66, 0x8F, 0x8F}, 1.2, 72.630},
    {33, "As", {0xBD, 0x80, 0xE3}, 1.19, 74.922},
    {34, "Se", {0xFF, 0xA1, 0x00}, 1.2, 78.971},
    {35, "Br", {0xA6, 0x29, 0x29}, 1.2, 79.904},
    {36, "Kr", {0x5C, 0xB8, 0xD1}, 1.16, 83.798},
    {37, "Rb", {0x70, 0x2E, 0xB0}, 2.2, 85.468},
    {38, "Sr", {0x00, 0xFF, 0x00}, 1.95, 87.62},
    {39, "Y", {0x94, 0xFF, 0xFF}, 1.9, 88.906},
    {40, "Zr", {0x94, 0xE0, 0xE0}, 1.75, 91.224},
    {41, "Nb", {0x73, 0xC2, 0xC9}, 1.64, 92.906},
    {42, "Mo", {0x54, 0xB5, 0xB5}, 1.54, 95.95},
    {43, "Tc", {0x3B, 0x9E, 0x9E}, 1.47, 0.0},
    {44, "Ru", {0x24, 0x8F, 0x8F}, 1.46, 101.07},
    {45, "Rh", {0x0A, 0x7D, 0x8C}, 1.42, 102.91},
    {46, "Pd", {0x00, 0x69, 0x85}, 1.39, 106.42},
    {47, "Ag", {0xC0, 0xC0, 0xC0}, 1.45, 107.87},
    {48, "Cd", {0xFF, 0xD9, 0x8F}, 1.44, 112.41},
    {49, "In", {0xA6, 0x75, 0x73}, 1.42, 114.82},
    {50, "Sn", {0x66, 0x80, 0x80}, 1.39, 118.71},
    {51, "Sb", {0x9E, 0x63, 0xB5}, 1.39, 121.76},
    {52, "Te", {0xD4, 0x7A, 0x00}, 1.38, 127.60},
    {53, "I", {0x94, 0x00, 0x94}, 1.39, 126.90},
    {54, "Xe", {0x42, 0x9E, 0xB0}, 1.4, 131.29},
    {55, "Cs", {0x57, 0x17, 0x8F}, 2.44, 132.91},
    {56, "Ba", {0x00, 0xC9, 0x00}, 2.15, 137.33},
    {57, "La", {0x70, 0xD4, 0xFF}, 2.07, 138.91},
    {58, "Ce", {0xFF, 0xFF, 0xC7}, 2.04, 140.12},
    {59, "Pr", {0xD9, 0xFF, 0xC7}, 2.03, 140.91},
    {60, "Nd", {0xC7, 0xFF, 0xC7}, 2.01, 144.24},
    {61, "Pm", {0xA3, 0xFF, 0xC7}, 1.99, 0.0},
    {62, "Sm", {0x8F, 0xFF, 0xC7}, 1.98, 150.36},
    {63, "Eu", {0x61, 0xFF, 0xC7}, 1.98, 151.96},
    {64, "Gd", {0x45, 0xFF, 0xC7}, 1.96, 157.25},
    {65, "Tb", {0x30, 0xFF, 0xC7}, 1.94, 158.93},
    {66, "Dy", {0x1F, 0xFF, 0xC7}, 1.92, 162.50},
    {67, "Ho", {0x00, 0xFF, 0x9C}, 1.92, 164.93},
    {68, "Er", {0x00, 0xE6, 0x75}, 1.89, 167.26},
    {69, "Tm", {0x00, 0xD4, 0x52}, 1.9, 168.93},
    {70, "Yb", {0x00, 0xBF, 0x38}, 1.87, 173.05},
    {71, "Lu", {0x00, 0xAB, 0x24}, 1.87, 174.97},
    {72, "Hf", {0x4D, 0xC2, 0xFF}, 1.75, 178.49},
    {73, "Ta", {0x4D, 0xA6, 0xFF}, 1.7, 180.95},
    {74, "W", {0x21, 0x94, 0xD6}, 1.62, 183.84},
    {75, "Re", {0x26, 0x7D, 0xAB}, 1.51, 186.21},
    {76, "Os", {0x26, 0x66, 0x96}, 1.44, 190.23},
    {77, "Ir", {0x17, 0x54, 0x87}, 1.41, 192.22},
    {78, "Pt", {0xD0, 0xD0, 0xE0}, 1.36, 195.08},
    {79, "Au", {0xFF, 0xD1, 0x23}, 1.36, 196.97},
    {80, "Hg", {0xB8, 0xB8, 0xD0}, 1.32, 200.59},
    {81, "Tl", {0xA6, 0x54, 0x4D}, 1.45, 204.38},
    {82, "Pb", {0x57, 0x59, 0x61}, 1.46, 207.2},
    {83, "Bi", {0x9E, 0x4F, 0xB5}, 1.48, 208.98},
    {84, "Po", {0xAB, 0x5C, 0x00}, 1.4, 0.0},
    {85, "At", {0x75, 0x4F, 0x45}, 1.5, 0.0},
    {86, "Rn", {0x42, 0x82, 0x96}, 1.5, 0.0},
    {87, "Fr", {0x42, 0x00, 0x66}, 2.6, 0.0},
    {88, "Ra", {0x00, 0x7D, 0x00}, 2.21, 0.0},
    {89, "Ac", {0x70, 0xAB, 0xFA}, 2.15, 0.0},
    {90, "Th", {0x00, 0xBA, 0xFF}, 2.06, 232.04},
    {91, "Pa", {0x00, 0xA1, 0xFF}, 2.0, 231.04},
    {92, "U", {0x00, 0x8F, 0xFF}, 1.96, 238.03},
    {93, "Np", {0x00, 0x80, 0xFF}, 1.9, 0.0},
    {94, "Pu", {0x00, 0x6B, 0xFF}, 1.87, 0.0},
    {95, "Am", {0x54, 0x5C, 0xF2}, 1.8, 0.0},
    {96, "Cm", {0x78, 0x5C, 0xE3}, 1.69, 0.0},
    {97, "Bk", {0x8A, 0x4F, 0xE3}, 1.5, 0.0},
    {98, "Cf", {0xA1, 0x36, 0xD4}, 1.5, 0.0},
    {99, "Es", {0xB3, 0x1F, 0xD4}, 1.5, 0.0},
    {100, "Fm", {0xB3, 0x1F, 0xBA}, 1.5, 0.0},
    {101, "Md", {0xB3, 0x0D, 0xA6}, 1.5, 0.0},
    {102, "No", {0xBD, 0x0D, 0x87}, 1.5, 0.0},
    {103, "Lr", {0xC7, 0x00, 0x66}, 1.5, 0.0},
    {104, "Rf", {0xCC, 0x00, 0x59}, 1.5, 0.0},
    {105, "Db", {0xD1, 0x00, 0x4F}, 1.5, 0.0},
    {106, "Sg", {0xD9, 0x00, 0x45}, 1.5, 0.0},
    {107, "Bh", {0xE0, 0x00, 0x38}, 1.5, 0.0},
    {108, "Hs", {0xE6, 0x00, 0x2E}, 1.5, 0.0},
    {109, "Mt", {0xEB, 0x00, 0x26}, 1.5, 0.0},
    // clang-format on
}};

// Species that are no element: colours that stay apart for colour-blind readers too (Okabe & Ito 2008, then Tol's
// muted set).
constexpr std::array<std::array<std::uint8_t, 3>, 12> other_colors{{{0xE6, 0x9F, 0x00},
                                                                    {0x56, 0xB4, 0xE9},
                                                                    {0x00, 0x9E, 0x73},
                                                                    {0xF0, 0xE4, 0x42},
                                                                    {0x00, 0x72, 0xB2},
                                                                    {0xD5, 0x5E, 0x00},
                                                                    {0xCC, 0x79, 0xA7},
                                                                    {0x99, 0x99, 0x33},
                                                                    {0x33, 0x22, 0x88},
                                                                    {0x88, 0xCC, 0xEE},
                                                                    {0x88, 0x22, 0x55},
                                                                    {0xDD, 0xCC, 0x77}}};

}  // namespace

const Element* find_element(std::string_view symbol) {
  for (const Element& element : elements) {
    if (element.symbol == symbol) return &element;
  }
  return nullptr;
}

const Element* find_element(int number) {
  if (number < 1 || number > static_cast<int>(elements.size())) return nullptr;
  return &elements[static_cast<std::size_t>(number - 1)];
}

const Element* find_element_by_mass(double mass) {
  const Element* found = nullptr;
  for (const Element& element : elements) {
    if (element.mass <= 0.0 || !(std::abs(element.mass - mass) <= 0.05)) continue;
    if (found != nullptr) return nullptr;
    found = &element;
  }
  return found;
}

std::array<std::uint8_t, 3> default_species_color(std::string_view name, std::size_t ordinal) {
  const Element* element = find_element(name);
  return element != nullptr ? element->color : other_colors[ordinal % other_colors.size()];
}

double default_species_radius(std::string_view name) {
  const Element* element = find_element(name);
  return element != nullptr ? element->radius : 1.0;
}

}  // namespace atomesh
