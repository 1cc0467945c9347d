#include "render/gl/preintegration_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace atomesh::gl {

namespace {

// Beyond every scalar, and still far from what float overflows at.
constexpr double beyond = 1e30;

// Behind so much optical depth nothing is gathered: e^-20 = 2e-9.
constexpr double deepest = 20.0;
constexpr double piece_depth = 0.25;

// Not inlined: GCC 12 leaves the rounding out where it makes vectors of map_pieces()'s doubles.
[[gnu::noinline]] double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// (1 - e^-y) / y
double mean_transmittance(double y) {
  return y < 1e-6 ? 1.0 - 0.5 * y : -std::expm1(-y) / y;
}

// What is gathered along a segment.
struct Gathered {
  Vec3 emission{0.0};       // ∫ c σ T du
  double extinction = 0.0;  // ∫ σ du
};

// The part from u to u + h, along which RGB and extinction go linearly from `a` to `b`.
void gather(const glm::dvec4& a, const glm::dvec4& b, double h, double length, Gathered& gathered) {
  constexpr std::array<double, 4> nodes{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  constexpr std::array<double, 4> weights{0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                          0.1739274225687269};
  const double rise = h * length * (b.a - a.a);
  double v = 0.0;
  double before = gathered.extinction * length;
  while (v < 1.0 && before < deepest) {
    // The stretch of optical depth piece_depth, or what is left.
    const double density = std::max(h * length * (a.a + v * (b.a - a.a)), 0.0);
    double step = 1.0 - v;
    if (step * (density + 0.5 * step * rise) > piece_depth) {
      const double root = std::sqrt(std::max(density * density + 2.0 * piece_depth * rise, 0.0));
      step = std::min(step, 2.0 * piece_depth / (density + root));
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double way = step * nodes[k];
      const glm::dvec4 here = a + (v + way) * (b - a);
      const double depth = before + way * (density + 0.5 * way * rise);
      gathered.emission += weights[k] * step * h * here.a * std::exp(-depth) * Vec3(here);
    }
    before += step * (density + 0.5 * step * rise);
    v += step;
    if (step < 1e-15) break;
  }
  gathered.extinction += 0.5 * h * (a.a + b.a);
}

glm::dvec4 color_at(const MapPiece& piece, double scalar) {
  return piece.first + piece.slope * (scalar - piece.begin);
}

}  // namespace

std::vector<MapPiece> map_pieces(const ColorMap& map, double alpha_length) {
  const auto optical = [alpha_length](const Vec4f& color) {
    return glm::dvec4(color.r, color.g, color.b, static_cast<double>(color.a) * alpha_length);
  };
  const std::vector<ColorMapEntry>& entries = map.entries;
  std::vector<MapPiece> pieces;
  pieces.push_back({optical(entries.front().color), {}, -beyond, as_float(entries.front().scalar)});
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    const double begin = as_float(entries[i].scalar);
    const double end = as_float(entries[i + 1].scalar);
    if (!(begin < end)) continue;
    const glm::dvec4 first = optical(entries[i].color);
    pieces.push_back({first, (optical(entries[i + 1].color) - first) / (end - begin), begin, end});
  }
  pieces.push_back({optical(entries.back().color), {}, as_float(entries.back().scalar), beyond});
  return pieces;
}

TableEntry table_entry(const std::vector<MapPiece>& pieces, double near, double far, double length) {
  const auto above = std::upper_bound(pieces.begin(), pieces.end(), near,
                                      [](double scalar, const MapPiece& piece) { return scalar < piece.end; });
  Gathered gathered;
  if (near == far) {
    const glm::dvec4 color = color_at(*above, near);
    gather(color, color, 1.0, length, gathered);
  } else {
    const bool up = far > near;
    auto piece = above;
    // Coming from above, what lies at a knot belongs to the piece below.
    while (!up && piece->begin >= near) --piece;
    double at = near;
    for (;;) {
      const bool last = up ? piece->end >= far : piece->begin <= far;
      const double to = last ? far : up ? piece->end : piece->begin;
      gather(color_at(*piece, at), color_at(*piece, to), (to - at) / (far - near), length, gathered);
      if (last) break;
      at = to;
      if (up) {
        ++piece;
      } else {
        --piece;
      }
    }
  }
  return {gathered.emission / mean_transmittance(gathered.extinction * length), gathered.extinction};
}

glm::dvec4 light_of(const TableEntry& entry, double length) {
  const double depth = entry.extinction * length;
  return {entry.emission * length * mean_transmittance(depth), -std::expm1(-depth)};
}

double TableSize::length_of(double layer) const {
  const double gamma = layer / (layers - 1);
  // From γ: L (longest + bend - γ longest) = γ longest bend.
  return gamma * longest * bend / (longest * (1.0 - gamma) + bend);
}

double TableSize::layer_of(double length) const {
  const double inside = std::clamp(length, 0.0, longest);
  return (layers - 1) * inside * (longest + bend) / (longest * (inside + bend));
}

namespace {

struct Pair {
  double near = 0.0;
  double far = 0.0;
};

TableEntry mix(const TableEntry& a, const TableEntry& b, double u) {
  return {a.emission + u * (b.emission - a.emission), a.extinction + u * (b.extinction - a.extinction)};
}

// error_of_segment()'s share of the light that does not depend on the opacity.
constexpr double within_piece = 1.0 / 256.0;
constexpr double across_knot = 1.0 / 4.0;

// Of the error of a table's worst segment samples find so much at least.
constexpr double nearly_all = 0.95;

// Samples of a table's error: what is looked at first is what was worst in the table before, so that a table that is
// too small is found out soon.
class Samples {
 public:
  Samples(const std::vector<MapPiece>& pieces, double longest) : pieces_(pieces), longest_(longest) {
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) knots_.push_back(pieces[i].end);
  }

  // The largest error of tables of `scalars` entries each way, layers apart; stops at the first above `limit`.
  double along_scalars(int scalars, double limit) {
    double worst = 0.0;
    const std::vector<Pair> pairs = pairs_for(scalars - 1);
    const auto look = [&](std::size_t i) {
      for (const double length : {longest_, longest_ / 8.0}) {
        worst = std::max(worst, scalar_error(pairs[i], scalars - 1, length));
      }
      return worst <= limit;
    };
    if (worst_pair_ < pairs.size() && !look(worst_pair_)) return worst;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (look(i)) continue;
      worst_pair_ = i;
      break;
    }
    return worst;
  }

  // The same of a table's layers, scalars apart.
  double along_lengths(const TableSize& size, double limit) const {
    double worst = 0.0;
    for (const Pair& pair : pairs_for(16)) {
      for (int layer = 0; layer + 1 < size.layers; ++layer) {
        const double length = size.length_of(layer + 0.5);
        const TableEntry mixed = mix(table_entry(pieces_, pair.near, pair.far, size.length_of(layer)),
                                     table_entry(pieces_, pair.near, pair.far, size.length_of(layer + 1)), 0.5);
        worst = std::max(worst, error_of(pair, mixed, length));
        if (worst > limit) return worst;
      }
    }
    return worst;
  }

 private:
  // In a table of so many cells each way: within cells at and to either side of the knots (which may lie between two
  // cells, and are rounded), and in the midst of others.
  std::vector<Pair> pairs_for(int cells) const {
    std::vector<double> about;
    const double cell = 1.0 / cells;
    std::size_t per_knot = 0;
    for (const double knot : knots_) {
      if (knot < 0.0 || knot > 1.0) continue;
      const std::size_t first = about.size();
      about.push_back(knot);
      for (const double beside : {-1.0, 0.0, 1.0}) {
        for (const double within : {0.3, 0.7}) {
          about.push_back(std::clamp((std::floor(knot * cells) + beside + within) * cell, 0.0, 1.0));
        }
      }
      per_knot = about.size() - first;
    }
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < about.size(); ++i) {
      const std::size_t first = i / per_knot * per_knot;
      for (std::size_t j = first; j < first + per_knot; ++j) pairs.push_back({about[i], about[j]});
      // From one knot to others, both ways.
      const std::size_t other = (7 * i + 4) % about.size();
      pairs.push_back({about[i], about[other]});
      pairs.push_back({about[other], about[i]});
    }
    // Midst of cells, near the diagonal and far from it.
    constexpr int others = 12;
    for (int i = 0; i < others; ++i) {
      const double near = (std::floor((i + 0.5) / others * cells) + 0.5) * cell;
      for (const int beside : {0, 1, -2, 5 * cells / 8, cells - 1}) {
        const double far = near + beside * cell;
        pairs.push_back({near, far > 1.0 ? far - 1.0 : std::max(far, 0.5 * cell)});
      }
    }
    return pairs;
  }

  double scalar_error(const Pair& pair, int cells, double length) const {
    const auto split = [cells](double scalar, double& begin) {
      begin = std::min(std::floor(scalar * cells), cells - 1.0);
      return scalar * cells - begin;
    };
    double near = 0.0;
    double far = 0.0;
    const double u = split(pair.near, near);
    const double v = split(pair.far, far);
    const auto entry = [&](double i, double j) { return table_entry(pieces_, i / cells, j / cells, length); };
    const TableEntry mixed =
        mix(mix(entry(near, far), entry(near + 1, far), u), mix(entry(near, far + 1), entry(near + 1, far + 1), u), v);
    return error_of(pair, mixed, length);
  }

  double error_of(const Pair& pair, const TableEntry& entry, double length) const {
    return error_of_segment(pieces_, pair.near, pair.far, length, light_of(entry, length));
  }

  const std::vector<MapPiece>& pieces_;
  double longest_;
  std::vector<double> knots_;
  std::size_t worst_pair_ = ~std::size_t{0};
};

}  // namespace

double error_of_segment(const std::vector<MapPiece>& pieces, double near, double far, double length,
                        const glm::dvec4& light) {
  const glm::dvec4 exact = light_of(table_entry(pieces, near, far, length), length);
  const glm::dvec4 difference = glm::abs(light - exact);
  const double low = std::min(near, far);
  const double high = std::max(near, far);
  const bool knot =
      std::ranges::any_of(pieces, [&](const MapPiece& piece) { return low < piece.end && piece.end < high; });
  return std::max({difference.r, difference.g, difference.b, difference.a}) /
         (exact.a + (knot ? across_knot : within_piece));
}

TableSize choose_size(const std::vector<MapPiece>& pieces, double longest, double error) {
  double densest = 0.0;
  for (const MapPiece& piece : pieces) densest = std::max(densest, piece.first.a);
  TableSize size;
  size.longest = longest;
  size.bend = densest > 0.0 ? std::min(12.0 / densest, 1e6 * longest) : longest;
  Samples samples(pieces, longest);
  double of_lengths = 0.0;
  // Layers are cheap: they get a quarter of the error.
  for (const int layers : {2, 3, 5, 9, 17, most_layers}) {
    size.layers = layers;
    of_lengths = samples.along_lengths(size, layers == most_layers ? HUGE_VAL : 0.25 * error);
    if (of_lengths <= 0.25 * error) break;
  }
  // A table whose entries lie at the knots may be far smaller than its neighbours: all are tried.
  const double rest = nearly_all * error - of_lengths;
  double of_scalars = HUGE_VAL;
  int scalars = 16;
  for (; scalars <= most_scalars && scalars * scalars * size.layers <= most_entries; ++scalars) {
    of_scalars = samples.along_scalars(scalars, rest);
    if (of_scalars <= rest) break;
  }
  size.scalars = of_scalars <= rest ? scalars : 0;
  size.estimated = of_lengths + (size.scalars > 0 ? of_scalars : samples.along_scalars(scalars - 1, HUGE_VAL));
  return size;
}

}  // namespace atomesh::gl
