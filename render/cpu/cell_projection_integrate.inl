// What the segment of a ray in a cell adds: RGBA linear along it, a scalar through the colour map, samples of either.
// Included by the kernels' sources after cell_projection_setup.inl.

namespace atomesh::ATOMESH_ISA {

// Pixels of a block within its tile.
struct Pixels {
  Lanes column;
  Lanes row;
};

static inline Lanes affine(const Pixels& p, float a, float b, float c) {
  return multiply_add(Lanes(a), p.column, multiply_add(Lanes(b), p.row, Lanes(c)));
}

// Premultiplied light gathered so far and what of the rest still gets through.
struct Light {
  Lanes red{0.0F};
  Lanes green{0.0F};
  Lanes blue{0.0F};
  Lanes through{1.0F};
};

struct Rgba {
  Lanes channel[4];
};

static inline void absorb(const Rgba& color, const Lanes& opacity, Light& light) {
  const Lanes taken = light.through * opacity;
  light.red = multiply_add(taken, color.channel[0], light.red);
  light.green = multiply_add(taken, color.channel[1], light.green);
  light.blue = multiply_add(taken, color.channel[2], light.blue);
  light.through = light.through - taken;
}

static inline Rgba mix(const Rgba& a, const Rgba& b, const Lanes& t) {
  Rgba color;
  for (int k = 0; k < 4; ++k) color.channel[k] = multiply_add(t, b.channel[k] - a.channel[k], a.channel[k]);
  return color;
}

static inline void add(const Rgba& near_end, const Rgba& far_end, const optics::Piece<Lanes>& piece, Light& light) {
  const Lanes first = light.through * piece.opacity;
  const Lanes second = light.through * piece.ramp;
  Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
  for (int k = 0; k < 3; ++k) {
    *gathered[k] = multiply_add(first, near_end.channel[k],
                                multiply_add(second, far_end.channel[k] - near_end.channel[k], *gathered[k]));
  }
  light.through = light.through - first;
}

// What is seldom needed is not inlined, and takes and returns values: so the light of the common case may stay in
// registers.

// In pieces of optical depth 1, until the end or until nothing gets through: at most as many as a ray survives.
static __attribute__((noinline, flatten)) Light add_dense(Rgba near_end, Rgba far_end, Lanes density_near,
                                                          Lanes half_difference, Light light) {
  const Lanes one(1.0F);
  const Lanes limit(optics::piece_limit);
  const Lanes far_density = density_near + half_difference + half_difference;
  Lanes u(0.0F);
  Rgba here = near_end;
  for (;;) {
    const Mask active = (u < one) & (light.through > Lanes(opaque_enough));
    if (!any(active)) return light;
    const Lanes density = multiply_add(half_difference + half_difference, u, density_near);
    const Lanes rest = one - u;
    const Mask cut = Lanes(0.5F) * rest * (density + far_density) > limit;
    const Lanes root = sqrt(max(multiply_add(density, density, half_difference * Lanes(4.0F)), Lanes(0.0F)));
    const Lanes reach = min(Lanes(2.0F) / max(density + root, Lanes(1e-30F)), rest);
    const Lanes h = select(active, select(cut, reach, rest), Lanes(0.0F));
    const Lanes next_u = select(active, select(cut & (reach < rest), u + reach, one), u);
    const Rgba next = mix(near_end, far_end, next_u);
    const Lanes bend = half_difference * h * h;
    add(here, next, optics::integrate_piece(min(multiply_add(density, h, bend), limit), bend), light);
    here = next;
    u = next_u;
  }
}

// As add_segment() by `samples` samples.
static __attribute__((noinline, flatten)) Light add_samples(Rgba near_end, Rgba far_end, Lanes length, int samples,
                                                            Light light) {
  const float step = 1.0F / static_cast<float>(samples);
  const Lanes step_length = length * Lanes(step);
  for (int i = 0; i < samples; ++i) {
    const Rgba color = mix(near_end, far_end, Lanes((static_cast<float>(i) + 0.5F) * step));
    absorb(color, Lanes(1.0F) - exp_minus(color.channel[3] * step_length), light);
  }
  return light;
}

// RGBA linear from end to end; `length` is alpha_length times the way.
static inline void add_segment(const Rgba& near_end, const Rgba& far_end, const Lanes& length, Light& light) {
  const Lanes density_near = near_end.channel[3] * length;
  const Lanes density_far = far_end.channel[3] * length;
  const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
  const Lanes mean = density_near + half_difference;
  if (!any(mean > Lanes(optics::thin_limit))) {
    add(near_end, far_end, optics::integrate_thin_piece(mean, half_difference), light);
  } else if (!any(mean > Lanes(optics::piece_limit))) {
    add(near_end, far_end, optics::integrate_piece(mean, half_difference), light);
  } else {
    light = add_dense(near_end, far_end, density_near, half_difference, light);
  }
}

// What every integrator knows of its block.
class BlockOptics {
 public:
  BlockOptics(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : optics_(optics),
        pixels_(pixels),
        reference_(static_cast<float>(view.reference)),
        perspective_(view.perspective) {
    const float pixel = static_cast<float>(view.pixel);
    const Lanes x = multiply_add(pixels.column, Lanes(pixel),
                                 Lanes(static_cast<float>(view.left + view.pixel * block.tile_column)));
    const Lanes y =
        multiply_add(pixels.row, Lanes(-pixel), Lanes(static_cast<float>(view.top - view.pixel * block.tile_row)));
    const Lanes length = view.perspective ? sqrt(multiply_add(x, x, multiply_add(y, y, Lanes(1.0F)))) : Lanes(1.0F);
    extinction_ = length * Lanes(optics.alpha_length);
  }

 protected:
  // Of a segment, u_in < u_out where there is one: its ends' depths from the cell's own, and alpha_length times the
  // way, zero where there is none (where the depths are finite all the same).
  struct Way {
    Lanes z_in, z_out, length;
  };
  Way way(const Lanes& u_in, const Lanes& u_out, float cell_depth) const {
    const Lanes depth(cell_depth);
    Way w;
    w.z_in = relative_depth(min(u_in, u_out)) - depth;
    w.z_out = relative_depth(u_out) - depth;
    w.length = select(u_in < u_out, (w.z_out - w.z_in) * extinction_, Lanes(0.0F));
    return w;
  }

  const CellOptics& optics_;
  Pixels pixels_;

 private:
  Lanes relative_depth(const Lanes& u) const { return perspective_ ? reference_ * u * reciprocal(Lanes(1.0F) - u) : u; }

  Lanes extinction_;  // alpha_length times the way per unit of depth
  Lanes reference_;
  bool perspective_;
};

// Cells whose vertices carry RGBA.
class ColorIntegrator : public BlockOptics {
 public:
  ColorIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : BlockOptics(view, optics, block, pixels), colors_(block.colors), ranges_(block.ranges) {}

  using Record = CellColors;
  const CellColors& record(std::uint32_t number) const { return colors_[number]; }

  // Lays the segment of one cell behind what is in `light`.
  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellColors& cell = colors_[number];
    const Way w = way(u_in, u_out, cell.depth);
    Rgba near_end;
    Rgba far_end;
    for (int k = 0; k < 4; ++k) {
      const Lanes base = affine(pixels_, cell.base_a[k], cell.base_b[k], cell.base_c[k]);
      const Lanes slope = affine(pixels_, cell.slope_a[k], cell.slope_b[k], cell.slope_c[k]);
      near_end.channel[k] = multiply_add(w.z_in, slope, base);
      far_end.channel[k] = multiply_add(w.z_out, slope, base);
    }
    if (cell.wild != 0) {
      const ColorRange& range = ranges_[number];
      for (int k = 0; k < 4; ++k) {
        near_end.channel[k] = clamp(near_end.channel[k], range.low[k], range.high[k]);
        far_end.channel[k] = clamp(far_end.channel[k], range.low[k], range.high[k]);
      }
    }
    if (optics_.samples == 0) {
      add_segment(near_end, far_end, w.length, light);
    } else {
      light = add_samples(near_end, far_end, w.length, optics_.samples, light);
    }
  }

 private:
  const CellColors* colors_;
  const ColorRange* ranges_;
};

// Cells whose vertices carry a scalar that the colour map turns into RGBA.
class ScalarIntegrator : public BlockOptics {
 public:
  ScalarIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : BlockOptics(view, optics, block, pixels), scalars_(block.scalars) {}

  using Record = CellScalar;
  const CellScalar& record(std::uint32_t number) const { return scalars_[number]; }

  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellScalar& cell = scalars_[number];
    const Way w = way(u_in, u_out, cell.depth);
    const Lanes base = affine(pixels_, cell.base_a, cell.base_b, cell.base_c);
    const Lanes slope = affine(pixels_, cell.slope_a, cell.slope_b, cell.slope_c);
    const Lanes s_in = clamp(multiply_add(w.z_in, slope, base), cell.low, cell.high);
    const Lanes s_out = clamp(multiply_add(w.z_out, slope, base), cell.low, cell.high);
    if (optics_.samples == 0 && cell.first_interval == cell.last_interval) {
      add_mapped(optics_.map[cell.first_interval], s_in, s_out, w.length, light);
    } else if (optics_.samples > 0) {
      light = sample_map(cell, s_in, s_out, w.length, light);
    } else if (any(w.length > Lanes(optics::piece_limit))) {
      light = lay_intervals_each_way(cell, s_in, s_out, w.length, light);
    } else if (any(w.length > Lanes(optics::thin_limit))) {
      light = lay_intervals<false>(cell, s_in, s_out, u_in < u_out, w.length, light);
    } else {
      light = lay_intervals<true>(cell, s_in, s_out, u_in < u_out, w.length, light);
    }
  }

 private:
  // Finding out which intervals are met costs as much as passing about so many.
  static constexpr int few_intervals = 3;

  static Rgba mapped(const MapInterval& interval, const Lanes& s) {
    const Lanes from_begin = s - Lanes(interval.begin);
    Rgba color;
    for (int k = 0; k < 4; ++k) {
      color.channel[k] = multiply_add(from_begin, Lanes(interval.slope[k]), Lanes(interval.first[k]));
    }
    return color;
  }

  // MapIntervals::find().
  int find(float scalar) const {
    const float place = scalar * static_cast<float>(map_grid_size);
    const float last = static_cast<float>(map_grid_size - 1);
    int n = optics_.map_grid[static_cast<int>(place > 0.0F ? (place < last ? place : last) : 0.0F)];
    while (n + 1 < optics_.map_intervals && scalar >= optics_.map[n + 1].begin) ++n;
    return n;
  }

  // A segment within one interval.
  static void add_mapped(const MapInterval& interval, const Lanes& s_in, const Lanes& s_out, const Lanes& length,
                         Light& light) {
    const Lanes near_place = s_in - Lanes(interval.begin);
    const Lanes far_place = s_out - Lanes(interval.begin);
    const Lanes first_opacity(interval.first[3]);
    const Lanes opacity_slope(interval.slope[3]);
    const Lanes density_near = multiply_add(near_place, opacity_slope, first_opacity) * length;
    const Lanes density_far = multiply_add(far_place, opacity_slope, first_opacity) * length;
    const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
    const Lanes mean = density_near + half_difference;
    if (any(mean > Lanes(optics::thin_limit))) {
      add_segment(mapped(interval, s_in), mapped(interval, s_out), length, light);
      return;
    }
    const optics::Piece<Lanes> piece = optics::integrate_thin_piece(mean, half_difference);
    const Lanes taken = light.through * piece.opacity;
    const Lanes place = multiply_add(taken, near_place, light.through * piece.ramp * (far_place - near_place));
    lay(interval, taken, place, light);
    light.through = light.through - taken;
  }

  // Adds light of which `taken` has the colour of the interval's beginning, changed as far as `place` says.
  static void lay(const MapInterval& interval, const Lanes& taken, const Lanes& place, Light& light) {
    Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
    for (int k = 0; k < 3; ++k) {
      *gathered[k] =
          multiply_add(taken, Lanes(interval.first[k]), multiply_add(place, Lanes(interval.slope[k]), *gathered[k]));
    }
  }

  // Segments of optical depth at most 1, or thin_limit, that pass several intervals of the colour map, taken upwards
  // whichever way the scalar goes: where it falls each interval's light is laid before that of those below, where it
  // rises behind.
  template <bool thin>
  Light lay_intervals(const CellScalar& cell, Lanes s_in, Lanes s_out, Mask met, Lanes length, Light light) const {
    const Lanes zero(0.0F);
    const Lanes one(1.0F);
    const Lanes bottom = min(s_in, s_out);
    // A scalar that does not change gets a range to spread over: a rounding's worth.
    const Lanes top = max(max(s_in, s_out), bottom + Lanes(1e-7F));
    int first = cell.first_interval;
    int last = cell.last_interval;
    if (last - first > few_intervals) {  // rarely all of them are met here
      first = find(smallest(select(met, bottom, Lanes(3e38F))));
      last = find(largest(select(met, top, Lanes(-3e38F))));
    }
    const Mask falls = s_out < s_in;
    const Lanes half_way = select(falls, Lanes(-0.5F), Lanes(0.5F));
    const Lanes per_rise = length / (top - bottom);
    Light here;
    for (int n = first; n <= last; ++n) {
      const MapInterval& interval = optics_.map[n];
      const Lanes begin(interval.begin);
      const Lanes from = max(bottom, begin);
      const Lanes to = min(top, Lanes(n == last ? 3e38F : interval.end));
      const Lanes part = max(to - from, zero) * per_rise;
      const Lanes low_place = from - begin;
      const Lanes high_place = to - begin;
      const Lanes density_low = part * multiply_add(low_place, Lanes(interval.slope[3]), Lanes(interval.first[3]));
      const Lanes density_high = part * multiply_add(high_place, Lanes(interval.slope[3]), Lanes(interval.first[3]));
      const Lanes mean = Lanes(0.5F) * (density_low + density_high);
      const Lanes half_difference = half_way * (density_high - density_low);
      const optics::Piece<Lanes> piece =
          thin ? optics::integrate_thin_piece(mean, half_difference) : optics::integrate_piece(mean, half_difference);
      const Lanes low_weight = select(falls, piece.ramp, piece.opacity - piece.ramp);
      const Lanes high_weight = piece.opacity - low_weight;
      const Lanes before = select(falls, one, here.through);
      const Lanes kept = select(falls, one - piece.opacity, one);
      here.red = kept * here.red;
      here.green = kept * here.green;
      here.blue = kept * here.blue;
      lay(interval, before * piece.opacity, before * multiply_add(low_weight, low_place, high_weight * high_place),
          here);
      here.through = here.through - here.through * piece.opacity;
    }
    light.red = multiply_add(light.through, here.red, light.red);
    light.green = multiply_add(light.through, here.green, light.green);
    light.blue = multiply_add(light.through, here.blue, light.blue);
    light.through = light.through * here.through;
    return light;
  }

  // Of any density: rays on which the scalar rises pass the colour map's intervals upwards, the others downwards; each
  // interval that the cell touches is laid down once in each direction for the rays it concerns.
  __attribute__((noinline, flatten)) Light lay_intervals_each_way(const CellScalar& cell, Lanes s_in, Lanes s_out,
                                                                  Lanes length, Light light) const {
    const Lanes zero(0.0F);
    const Lanes one(1.0F);
    const Lanes rise = s_out - s_in;
    const Mask falls = rise < zero;
    const Mask level = rise == zero;
    const Lanes per_rise = one / select(level, one, rise);
    const int first = cell.first_interval;
    const int last = cell.last_interval;
    for (int direction = 0; direction < 2; ++direction) {
      const Lanes way = direction == 0 ? select(falls, zero, length) : select(falls, length, zero);
      if (!any(way > zero)) continue;
      for (int n = first; n <= last; ++n) {
        const int number = direction == 0 ? n : last - (n - first);
        const MapInterval& interval = optics_.map[number];
        const Lanes begin(number == first ? -3e38F : interval.begin);
        const Lanes end(number == last ? 3e38F : interval.end);
        const Lanes from = direction == 0 ? begin : end;
        const Lanes to = direction == 0 ? end : begin;
        Lanes u_from = clamp((from - s_in) * per_rise, 0.0F, 1.0F);
        Lanes u_to = clamp((to - s_in) * per_rise, 0.0F, 1.0F);
        // A scalar that does not change lies in one interval for the whole way.
        u_from = select(level, zero, u_from);
        u_to = select(level, select(s_in < begin, zero, select(s_in < end, one, zero)), u_to);
        const Lanes part = way * (u_to - u_from);
        if (!any(part > zero)) continue;
        const Lanes at_from = min(max(multiply_add(rise, u_from, s_in), begin), end);
        const Lanes at_to = min(max(multiply_add(rise, u_to, s_in), begin), end);
        add_segment(mapped(interval, at_from), mapped(interval, at_to), part, light);
      }
    }
    return light;
  }

  __attribute__((noinline, flatten)) Light sample_map(const CellScalar& cell, Lanes s_in, Lanes s_out, Lanes length,
                                                      Light light) const {
    const float step = 1.0F / static_cast<float>(optics_.samples);
    const Lanes step_length = length * Lanes(step);
    for (int i = 0; i < optics_.samples; ++i) {
      const Lanes s = multiply_add(Lanes((static_cast<float>(i) + 0.5F) * step), s_out - s_in, s_in);
      Rgba color = mapped(optics_.map[cell.first_interval], s);
      for (int n = cell.first_interval + 1; n <= cell.last_interval; ++n) {
        const MapInterval& interval = optics_.map[n];
        const Mask below = s < Lanes(interval.begin);
        const Rgba other = mapped(interval, s);
        for (int k = 0; k < 4; ++k) color.channel[k] = select(below, color.channel[k], other.channel[k]);
      }
      absorb(color, Lanes(1.0F) - exp_minus(color.channel[3] * step_length), light);
    }
    return light;
  }

  const CellScalar* scalars_;
};

}  // namespace atomesh::ATOMESH_ISA
