#include "samples/keating.h"

namespace atomesh {

namespace {

// In quarters of the cell's edge, from a cation; an anion's bonds are the negatives.
constexpr std::array<std::array<int, 3>, 4> bonds{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
// Sites of one cell in the order of zinc_blende_cell(), in quarters: four cations, then four anions.
constexpr std::array<std::array<int, 3>, 8> sites{
    {{0, 0, 0}, {0, 2, 2}, {2, 0, 2}, {2, 2, 0}, {1, 1, 1}, {1, 3, 3}, {3, 1, 3}, {3, 3, 1}}};

// Which atom stands on a point of the grid of quarters.
class QuarterGrid {
 public:
  explicit QuarterGrid(const BlockShape& shape) : cells_(shape.cells) {
    in_cell_.fill(8);
    for (std::size_t b = 0; b < 8; ++b) {
      in_cell_[static_cast<std::size_t>(sites[b][0] + 4 * (sites[b][1] + 4 * sites[b][2]))] = b;
    }
  }
  Index at(const std::array<long, 3>& q) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (q[axis] < 0 || q[axis] >= 4 * static_cast<long>(cells_[axis])) return no_index;
    }
    const std::array<std::size_t, 3> u{static_cast<std::size_t>(q[0]), static_cast<std::size_t>(q[1]),
                                       static_cast<std::size_t>(q[2])};
    const std::size_t b = in_cell_[u[0] % 4 + 4 * (u[1] % 4 + 4 * (u[2] % 4))];
    return static_cast<Index>(((u[2] / 4 * cells_[1] + u[1] / 4) * cells_[0] + u[0] / 4) * 8 + b);
  }

 private:
  std::array<std::size_t, 3> cells_;
  std::array<std::size_t, 64> in_cell_{};
};

}  // namespace

KeatingNetwork zinc_blende_network(const BlockShape& shape, const std::vector<std::uint8_t>& cation_kind,
                                   std::vector<KeatingBond> kinds) {
  KeatingNetwork network;
  network.kinds = std::move(kinds);
  const std::size_t atoms = 8 * shape.total();
  network.neighbours.assign(atoms, {no_index, no_index, no_index, no_index});
  network.reverse.assign(atoms, {});
  network.kind.assign(atoms, {});
  std::vector<std::uint8_t> bonded(atoms, 0);
  const QuarterGrid grid(shape);
  for (std::size_t cell = 0; cell < shape.total(); ++cell) {
    const std::array<std::size_t, 3> corner{cell % shape.cells[0], cell / shape.cells[0] % shape.cells[1],
                                            cell / shape.cells[0] / shape.cells[1]};
    for (std::size_t b = 0; b < 4; ++b) {
      const auto cation = static_cast<Index>(8 * cell + b);
      for (const auto& bond : bonds) {
        std::array<long, 3> q{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          q[axis] = 4 * static_cast<long>(corner[axis]) + sites[b][axis] + bond[axis];
        }
        const Index anion = grid.at(q);
        if (anion == no_index) continue;
        const std::uint8_t here = bonded[cation]++;
        const std::uint8_t there = bonded[anion]++;
        network.neighbours[cation][here] = anion;
        network.neighbours[anion][there] = cation;
        network.reverse[cation][here] = there;
        network.reverse[anion][there] = here;
        network.kind[cation][here] = network.kind[anion][there] = cation_kind[cation];
      }
    }
  }
  return network;
}

}  // namespace atomesh
