// AB graphite of which two stacks of layers have slid along the layers as rigid blocks.
#include "samples/crystal.h"
#include "samples/generators.h"

namespace atomesh {

namespace {

constexpr double lattice_a = 2.461;                         // Å
constexpr double lattice_c = 6.708;                         // Å, two layers
constexpr double half_root_three = 0.8660254037844386;      // √3/2
constexpr double bond = lattice_a / (2 * half_root_three);  // 1.421 Å

// Less than a third of a bond, so that every atom is still nearest to its own site.
struct Slide {
  double from, to;  // share of the layers, counted from below
  Vec3 shift;       // Å
};
constexpr std::array<Slide, 2> slides{
    {{0.25, 0.5, Vec3(0.28 * bond, 0, 0)}, {0.7, 0.85, Vec3(-0.12 * bond, 0.2 * bond, 0)}}};

UnitCell graphite() {
  UnitCell cell;
  cell.primitive = {Vec3(lattice_a, 0, 0), lattice_a * Vec3(-0.5, half_root_three, 0), Vec3(0, 0, lattice_c)};
  const Vec3 up(0, 0, 0.5 * lattice_c);
  cell.basis = {{"C", Vec3(0.0)}, {"C", Vec3(0, bond, 0)}, {"C", up}, {"C", up + Vec3(0.5 * lattice_a, 0.5 * bond, 0)}};
  return cell;
}

// The rectangular tile of a layer: a × √3 a, four atoms, one layer of each kind.
UnitCell rectangular_layer(bool upper) {
  const Vec3 across(0.5 * lattice_a, half_root_three * lattice_a, 0);
  const Vec3 second = upper ? Vec3(0.5 * lattice_a, 0.5 * bond, 0) : Vec3(0, bond, 0);
  UnitCell tile;
  tile.primitive = {Vec3(lattice_a, 0, 0), Vec3(0, 2 * half_root_three * lattice_a, 0), Vec3(0, 0, lattice_c)};
  tile.basis = {{"C", Vec3(0.0)}, {"C", second}, {"C", across}, {"C", across + second}};
  // Both atoms that leave the tile on the right come back in on the left.
  for (BasisAtom& atom : tile.basis) {
    if (atom.position.x > 0.75 * lattice_a) atom.position.x -= lattice_a;
  }
  return tile;
}

}  // namespace

Sample grow_graphite_slided(std::size_t atoms, std::uint64_t /*seed*/, Progress& progress) {
  Sample sample;
  sample.unit_cell = graphite();
  const auto [nx, ny, layers] =
      choose_block(static_cast<double>(atoms) / 4.0, Vec3(lattice_a, 2 * half_root_three * lattice_a, 0.5 * lattice_c),
                   Vec3(1, 1, 0.5))
          .cells;
  sample.atoms.add_species("C");
  const std::array<Atoms, 2> layer{build_block(rectangular_layer(false), {{nx, ny, 1}}),
                                   build_block(rectangular_layer(true), {{nx, ny, 1}})};
  for (std::size_t k = 0; k < layers; ++k) {
    progress.update(static_cast<double>(k) / static_cast<double>(layers));
    const double height = (static_cast<double>(k) + 0.5) / static_cast<double>(layers);
    Vec3 shift(0.0);
    for (const Slide& slide : slides) {
      if (height > slide.from && height < slide.to) shift = slide.shift;
    }
    const Vec3 offset = shift + Vec3(0, 0, 0.5 * lattice_c * static_cast<double>(k));
    for (const Vec3& p : layer[k % 2].positions) {
      if (shift != Vec3(0.0)) sample.truth.displaced.push_back(static_cast<Index>(sample.atoms.size()));
      sample.atoms.positions.push_back(p + offset);
      sample.atoms.species.push_back(0);
    }
  }
  return sample;
}

}  // namespace atomesh
