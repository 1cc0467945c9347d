// Set-up of what a tile's cells carry, and the whole set-up of a tile. Included by the kernels' sources after
// cell_projection_setup.inl.

namespace atomesh::ATOMESH_ISA {

// What values at the corners become values along the rays by.
struct CellSlopes {
  Doubles wx[4], wy[4], wz[4];  // gradients of the barycentric coordinates
  Doubles mx, my, mz;           // centroid
  Doubles extent;               // no corner is farther from it
};

// What the corners' colours count in CellColors, and the depth those are counted from.
struct ColorWeights {
  Doubles base[4], slope_a[4], slope_b[4], slope_c[4];
  Floats depth;
  Floats extent;
  Floats far;  // at least h of the farthest corner, times half the tile's pixels
};

static inline void find_weights(const View& view, double x0, double y0, const CellSlopes& s, ColorWeights& w) {
  const Doubles one = Doubles{} + 1.0;
  w.depth = to_floats(s.mz - view.reference);
  const Doubles z = to_doubles(w.depth) + view.reference;
  const Doubles h = view.perspective ? z : one;
  const Doubles dx = h * x0 - s.mx;
  const Doubles dy = h * y0 - s.my;
  const Doubles dz = z - s.mz;
  for (int v = 0; v < 4; ++v) {
    w.base[v] = (s.wx[v] * dx + s.wy[v] * dy) + (s.wz[v] * dz + 0.25);
    w.slope_a[v] = s.wx[v] * view.pixel;
    w.slope_b[v] = s.wy[v] * -view.pixel;
    w.slope_c[v] = view.perspective ? s.wz[v] + (s.wx[v] * x0 + s.wy[v] * y0) : s.wz[v];
  }
  w.extent = to_floats(s.extent);
  const Floats depth = to_floats(h);
  const Floats zero{};
  w.far = static_cast<float>(tile_middle) *
          (view.perspective ? (depth < zero ? -depth : depth) + w.extent : to_floats(one));
}

// Cell l of vertices with RGBA. Returns whether it is wild.
static inline bool write_colors(const SetupInput& input, const CellGroup& g, const ColorWeights& w, int l,
                                CellColors& colors, ColorRange& range) {
  F4 corner[4];
  D4 sum[4];
  for (int v = 0; v < 4; ++v) {
    __builtin_memcpy(&corner[v], input.values + 4 * static_cast<std::size_t>(g.vertex[v][l]), sizeof(F4));
    const D4 exact = to_doubles(corner[v]);
    const double weights[4] = {w.base[v][l], w.slope_a[v][l], w.slope_b[v][l], w.slope_c[v][l]};
    for (int n = 0; n < 4; ++n)
      sum[n] = v == 0 ? exact * all_of(weights[n]) : multiply_add(exact, all_of(weights[n]), sum[n]);
  }
  const F4 base = to_floats(sum[0]);
  const F4 slope_a = to_floats(sum[1]);
  const F4 slope_b = to_floats(sum[2]);
  const F4 slope_c = to_floats(sum[3]);
  store4(colors.base, base);
  store4(colors.slope_a, slope_a);
  store4(colors.slope_b, slope_b);
  store4(colors.slope_c, slope_c);
  // Where the rounding of the largest terms is at most 2e-6 they are not clamped.
  const F4 reach = multiply_add(all_of(w.far[l]), magnitude(slope_a) + magnitude(slope_b),
                                multiply_add(all_of(w.extent[l]), magnitude(slope_c), magnitude(base)));
  const bool wild = any_above(reach, 32.0F);
  if (wild) {
    F4 low = corner[0];
    F4 high = corner[0];
    for (int v = 1; v < 4; ++v) {
      low = corner[v] < low ? corner[v] : low;
      high = corner[v] > high ? corner[v] : high;
    }
    store4(range.low, low);
    store4(range.high, high);
  }
  return wild;
}

// To the nearest whole number within a tile and its surroundings: further away (the centroid seen at the level of the
// eye) the difference to a pixel would cost the bits that it is to save.
static inline Doubles nearest_whole(const Doubles& v) {
  const Doubles limit = Doubles{} + 2.0 * tile_side;
  const Doubles bounded = v > -limit ? (v < limit ? v : limit) : -limit;
  constexpr double magic = 0x1.8p52;
  return (bounded + magic) - magic;
}

// Cells of vertices with a scalar, as many as `count` of the group.
static inline void write_scalars(const View& view, const SetupInput& input, double x0, double y0, const CellGroup& g,
                                 const CellSlopes& s, int count, CellScalar* scalars) {
  Floats low{};
  Floats high{};
  Doubles gx{};
  Doubles gy{};
  Doubles gz{};
  Doubles mean{};
  for (int v = 0; v < 4; ++v) {
    Floats here;
    for (int l = 0; l < group_size; ++l) here[l] = input.values[g.vertex[v][l]];
    low = v == 0 ? here : (here < low ? here : low);
    high = v == 0 ? here : (here > high ? here : high);
    const Doubles exact = to_doubles(here);
    mean += 0.25 * exact;
    gx += exact * s.wx[v];
    gy += exact * s.wy[v];
    gz += exact * s.wz[v];
  }
  // Around the pixel that the centroid is seen at, and at the very depth that the record names: what rounding adds is
  // then a share of what the scalar changes by within the cell.
  const Floats depth = to_floats(s.mz - view.reference);
  const Doubles depth_error = to_doubles(depth) - (s.mz - view.reference);
  const Doubles h = view.perspective ? s.mz + depth_error : Doubles{} + 1.0;
  const Doubles column = nearest_whole((s.mx / h - x0) / view.pixel);
  const Doubles row = nearest_whole((y0 - s.my / h) / view.pixel);
  const Doubles x = x0 + view.pixel * column;
  const Doubles y = y0 - view.pixel * row;
  const double across = view.perspective ? view.pixel : 0.0;
  const Floats base_a = to_floats(gx * (h * view.pixel));
  const Floats base_b = to_floats(gy * (h * -view.pixel));
  const Floats reference = to_floats(mean);
  const Floats base_c =
      to_floats((mean - to_doubles(reference)) + gx * (h * x - s.mx) + gy * (h * y - s.my) + gz * depth_error);
  const Floats slope_a = to_floats(gx * (0.5 * across));
  const Floats slope_b = to_floats(gy * (-0.5 * across));
  const Floats slope_c = to_floats(0.5 * (view.perspective ? gz + gx * x + gy * y : gz));
  // What rounding is a share of: the largest terms, anywhere in the cell, and what a rounded depth is worth.
  const auto size = [](const Floats& v) { return v < 0.0F ? -v : v; };
  const Floats extent = to_floats(s.extent);
  const Floats pixels = to_floats(2.0 * s.extent / (h * view.pixel));
  const Floats steepest = 2.0F * (pixels * (size(slope_a) + size(slope_b)) + size(slope_c));
  const Floats reach =
      pixels * (size(base_a) + size(base_b)) + size(base_c) + steepest * (extent + size(depth) * (1.0F / 64.0F));
  // One that reaches to the eye's level may be seen in any number of pixels.
  const Floats distance = view.perspective ? to_floats(s.mz) : 8.0F * extent + 1.0F;
  const Ints tame = (reach <= 64.0F * (high - low) + 1e-6F) & (distance > 4.0F * extent);
  const Floats columns = to_floats(column);
  const Floats rows = to_floats(row);
  const Floats twice_depth = depth + depth;
  for (int l = 0; l < count; ++l) {
    scalars[l] = {base_a[l],
                  base_b[l],
                  base_c[l],
                  slope_a[l],
                  slope_b[l],
                  slope_c[l],
                  columns[l],
                  rows[l],
                  twice_depth[l],
                  low[l],
                  high[l],
                  reference[l],
                  0,
                  0,
                  0.0F,
                  0.0F,
                  tame[l] == 0 ? 1U : 0U};
  }
}

static void setup(const View& view, const SetupInput& input, const SetupOutput& output) {
  const double x0 = view.left + view.pixel * (input.column + tile_middle);
  const double y0 = view.top - view.pixel * (input.row + tile_middle);
  const double keep = 1.0 - view.order_blend;
  const BlockTest test(input.lattice);
  const BoxFinder boxes(input);
  CellGroup g;
  CellSlopes s;
  ColorWeights weights;
  for (std::size_t first = 0; first < input.count; first += group_size) {
    prefetch_groups(input, first);
    load_group(input, first, g);
    g.entries = Ints{};
    g.steep = Ints{};
    g.reach = Doubles{};
    boxes.find(g);
    for (int k = 0; k < 4; ++k) find_planes(view, x0, y0, k, g);
    transpose(g.a, g.cell_a);
    transpose(g.b, g.cell_b);
    transpose(g.c, g.cell_c);

    // Gradients of the barycentric coordinates: ±N / 6V. A cell too flat to have them gets the mean of its corners.
    s.mx = 0.25 * (g.x[0] + g.x[1] + g.x[2] + g.x[3]);
    s.my = 0.25 * (g.y[0] + g.y[1] + g.y[2] + g.y[3]);
    s.mz = 0.25 * (g.z[0] + g.z[1] + g.z[2] + g.z[3]);
    const Doubles volume6 = g.nx[3] * (g.x[3] - g.x[0]) + g.ny[3] * (g.y[3] - g.y[0]) + g.nz[3] * (g.z[3] - g.z[0]);
    Doubles squares[4];
    Doubles size{};
    for (int k = 0; k < 4; ++k) {
      const Doubles dx = g.x[k] - s.mx;
      const Doubles dy = g.y[k] - s.my;
      const Doubles dz = g.z[k] - s.mz;
      squares[k] = dx * dx + dy * dy + dz * dz;
      size += squares[k];
    }
    const Doubles over_volume = volume6 * volume6 <= 1e-26 * size * size * size ? Doubles{} : 1.0 / volume6;
    // With L the linear function that equals |p - centroid|² at the corners, the power of the eye with respect to the
    // circumsphere is |eye - centroid|² - L(eye); seen from infinity cells sort by their circumcentre's depth.
    Doubles qx{};
    Doubles qy{};
    Doubles qz{};
    for (int k = 0; k < 4; ++k) {
      const Doubles weight = k % 2 == 0 ? -over_volume : over_volume;
      s.wx[k] = g.nx[k] * weight;
      s.wy[k] = g.ny[k] * weight;
      s.wz[k] = g.nz[k] * weight;
      qx += squares[k] * s.wx[k];
      qy += squares[k] * s.wy[k];
      qz += squares[k] * s.wz[k];
    }
    if (view.order_doubt > 0.0) {
      const Doubles squared = volume6 * volume6;
      const Doubles trust = squared / (squared + (view.order_doubt * size * size * size + 1e-300));
      qx *= trust;
      qy *= trust;
      qz *= trust;
    }
    const Doubles keys = view.perspective ? s.mx * s.mx + s.my * s.my + s.mz * s.mz +
                                                keep * (qx * s.mx + qy * s.my + qz * s.mz - 0.25 * size)
                                          : s.mz + keep * 0.5 * qz;
    s.extent = square_root(size);

    const std::size_t rest = input.count - first;
    const int count = rest < group_size ? static_cast<int>(rest) : group_size;
    if (input.value_count == 4) find_weights(view, x0, y0, s, weights);
    for (int l = 0; l < count; ++l) {
      const std::size_t n = first + static_cast<std::size_t>(l);
      output.keys[n] = keys[l];
      output.blocks[n] = write_planes(g, l, test, input.wanted, output.planes[n], output.refinements[n]);
      if (input.value_count == 4 && output.blocks[n] != 0) {
        output.planes[n].depth = weights.depth[l];
        output.planes[n].wild = write_colors(input, g, weights, l, output.colors[n], output.ranges[n]);
      }
    }
    if (input.value_count == 1) write_scalars(view, input, x0, y0, g, s, count, output.scalars + first);
  }
  count_blocks(output.blocks, input.count, output.per_block);
}

}  // namespace atomesh::ATOMESH_ISA
