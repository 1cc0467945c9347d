#include "render/gl/map_ramps.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace atomesh::gl {

namespace {

constexpr std::size_t cells_per_range = 16384;

// Narrower pieces are not resolved by segments that are widened (ramp_segment.glsl).
constexpr double narrowest = 1.0 / 2048.0;
// By what segments of nearly one scalar are widened to either side.
constexpr double widening = 1.0 / 16384.0;
// By which a row counts on where it is not cut: more than segments are widened by.
constexpr double margin = 1.0 / 8192.0;
// Scalars of rows at either end of the map.
constexpr double far_away = 4.0;

// c σ and σ of a piece as polynomials of x.
struct Polynomial {
  glm::dvec4 constant{0.0};
  glm::dvec4 slope{0.0};
  Vec3 square{0.0};
};

// Of x counted from the scalar `zero`.
Polynomial polynomial(const MapPiece& piece, double zero) {
  const glm::dvec4 at = piece.first + piece.slope * (zero - piece.begin);
  const Vec3 color(at);
  const Vec3 change(piece.slope);
  return {{color * at.a, at.a}, {color * piece.slope.a + change * at.a, piece.slope.a}, change * piece.slope.a};
}

bool interior(const MapPiece& piece) {
  return std::abs(piece.begin) < far_away && std::abs(piece.end) < far_away;
}

}  // namespace

MapRamps::MapRamps(const Scene& scene, const ColorMap& color_map, double alpha_length)
    : pieces_(map_pieces(color_map, alpha_length)), cells_(scene.tetrahedra.size()) {
  make_rows();
  std::atomic<std::size_t> too_deep{0};
  std::atomic<std::size_t> one_piece{0};
  parallel_for(cells_.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
    std::size_t deep = 0;
    std::size_t simple = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = scene.tetrahedra[i];
      const std::array s{scene.scalars[t[0]], scene.scalars[t[1]], scene.scalars[t[2]], scene.scalars[t[3]]};
      const auto [low, high] = std::minmax_element(s.begin(), s.end());
      cells_[i] = cell_of(*low, *high);
      float longest = 0.0F;
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) {
          longest = std::max(longest, glm::length(scene.vertices[t[b]] - scene.vertices[t[a]]));
        }
      }
      deep += 0.5F * longest > cells_[i].longest ? 1 : 0;
      simple += in_one_piece(cells_[i]) ? 1 : 0;
    }
    too_deep += deep;
    one_piece += simple;
  });
  too_deep_ = too_deep;
  mostly_one_piece_ = 2 * one_piece > cells_.size();
}

int MapRamps::last_of_row(int first) const {
  const int last = std::min(first + pieces_per_row, static_cast<int>(pieces_.size())) - 1;
  for (int i = first; i < last; ++i) {
    if (jumps_[static_cast<std::size_t>(i) + 1] != 0) return i;
  }
  return last;
}

void MapRamps::make_rows() {
  transparent_.resize(pieces_.size());
  jumps_.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const MapPiece& piece = pieces_[i];
    transparent_[i] = piece.first.a == 0.0 && piece.slope.a == 0.0 ? 1 : 0;
    if (i == 0) continue;
    const MapPiece& before = pieces_[i - 1];
    // Of the first piece, which begins far below, the slope is 0.
    const glm::dvec4 end = interior(before) ? before.first + before.slope * (before.end - before.begin) : before.first;
    const glm::dvec4 jump = glm::abs(piece.first - end);
    const bool same = jump.r + jump.g + jump.b <= 1e-9 && jump.a <= 1e-9 * (std::abs(end.a) + std::abs(piece.first.a));
    jumps_[i] = same ? 0 : 1;
  }
  rows_.resize(4 * pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const auto last = static_cast<std::size_t>(last_of_row(static_cast<int>(i)));
    const double zero = pieces_[i].end < far_away ? pieces_[i].end : pieces_[i].begin;
    const Polynomial first = polynomial(pieces_[i], zero);
    RampRow row{};
    row.piece = Vec4f(first.constant);
    row.piece_slope = Vec4f(0.5 * first.slope);
    row.piece_square = Vec3f(first.square / 3.0);
    row.zero = {static_cast<float>(zero), 0.0F, 0.0F, 0.0F};
    for (std::size_t next = i + 1; next <= last; ++next) {
      const double knot = pieces_[next].begin;
      const Polynomial below = polynomial(pieces_[next - 1], knot);
      const Polynomial above = polynomial(pieces_[next], knot);
      const Vec4f ramp(0.5 * (above.slope - below.slope));
      const Vec3f square((above.square - below.square) / 3.0);
      if (next == i + 1) {
        row.knot = ramp;
        row.knot_square = square;
      } else {
        row.next_knot = ramp;
        row.next_knot_square = square;
        row.next = static_cast<float>(knot - zero);
      }
    }
    for (std::uint8_t cut = 0; cut < 4; ++cut) {
      const auto from = static_cast<float>(std::max(pieces_[i].begin - zero, -far_away));
      const auto to = static_cast<float>(std::min(pieces_[last].end - zero, far_away));
      row.lowest = (cut & cut_below) != 0 ? from : from - static_cast<float>(margin);
      row.highest = (cut & cut_above) != 0 ? to : to + static_cast<float>(margin);
      rows_[4 * i + cut] = row;
    }
  }
}

MapRamps::Cell MapRamps::cell_of(float low, float high) const {
  const auto first = std::upper_bound(pieces_.begin(), pieces_.end(), static_cast<double>(low),
                                      [](double scalar, const MapPiece& piece) { return scalar < piece.end; });
  auto last = first;
  while (last->end < static_cast<double>(high)) ++last;
  Cell cell{0.0F, static_cast<std::uint8_t>(first - pieces_.begin()),
            static_cast<std::uint8_t>(last - pieces_.begin())};
  // Pieces next to the cell's count where segments are widened into them.
  const auto reached = [&](const MapPiece& piece) {
    return piece.begin < static_cast<double>(high) + widening && piece.end > static_cast<double>(low) - widening;
  };
  // A row adds up what steep pieces change, and floats hold only so much more than what is left in the end.
  const double least_width = std::max(narrowest, (static_cast<double>(high) - static_cast<double>(low)) / 128.0);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const MapPiece& piece = pieces_[i];
    if (!reached(piece)) continue;
    if (interior(piece) && piece.end - piece.begin < least_width) return cell;
    const bool jump_inside = jumps_[i] != 0 && piece.begin > static_cast<double>(low) &&
                             piece.begin < static_cast<double>(high) &&
                             high - low < 4.0F * static_cast<float>(widening);
    if (jump_inside) return cell;
  }
  double densest = 0.0;
  Vec3 least(std::numeric_limits<double>::max());
  Vec3 most(std::numeric_limits<double>::lowest());
  for (auto piece = first;; ++piece) {
    for (const double end :
         {std::max(piece->begin, static_cast<double>(low)), std::min(piece->end, static_cast<double>(high))}) {
      const glm::dvec4 color = piece->first + piece->slope * (end - piece->begin);
      densest = std::max(densest, color.a);
      least = glm::min(least, Vec3(color));
      most = glm::max(most, Vec3(color));
    }
    if (piece == last) break;
  }
  const Vec3 change = most - least;
  const double largest = std::max({change.r, change.g, change.b, most_ramps_change / deepest_ramps});
  // of a cell without any opacity as well
  cell.longest = static_cast<float>(std::min(most_ramps_change / (largest * std::max(densest, 1e-30)), 1e30));
  return cell;
}

int MapRamps::rows_of(Index cell, std::uint8_t* rows) const {
  const int last = cells_[cell].last;
  int count = 0;
  for (int piece = cells_[cell].first; piece <= last;) {
    if (transparent_[static_cast<std::size_t>(piece)] != 0) {
      ++piece;
      continue;
    }
    const int end = last_of_row(piece);
    const unsigned below = piece > cells_[cell].first ? cut_below : 0U;
    const unsigned above = end < last ? cut_above : 0U;
    rows[count++] = static_cast<std::uint8_t>(4U * static_cast<unsigned>(piece) + below + above);
    piece = end + 1;
  }
  return count;
}

CellKind MapRamps::kind_of(Index cell) const {
  return mostly_one_piece_ && in_one_piece(cells_[cell]) ? CellKind::piece : CellKind::ramps;
}

}  // namespace atomesh::gl
