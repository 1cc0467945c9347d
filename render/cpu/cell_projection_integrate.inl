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

class Integrator {
 public:
  Integrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : view_(view), optics_(optics), block_(block), pixels_(pixels) {
    const float pixel = static_cast<float>(view.pixel);
    const Lanes x = multiply_add(pixels.column, Lanes(pixel),
                                 Lanes(static_cast<float>(view.left + view.pixel * block.tile_column)));
    const Lanes y =
        multiply_add(pixels.row, Lanes(-pixel), Lanes(static_cast<float>(view.top - view.pixel * block.tile_row)));
    const Lanes length = view.perspective ? sqrt(multiply_add(x, x, multiply_add(y, y, Lanes(1.0F)))) : Lanes(1.0F);
    extinction_ = length * Lanes(optics.alpha_length);
    reference_ = Lanes(static_cast<float>(view.reference));
  }

  // Lays the segment of one cell behind what is in `light`.
  void compose(std::uint32_t record, const Lanes& u_in, const Lanes& u_out, unsigned lanes, Light& light) const {
    const CellValues& cell = block_.values[record];
    const Mask mask = mask_of(lanes);
    const Lanes depth(cell.depth);
    const Lanes z_in = relative_depth(min(u_in, u_out)) - depth;
    const Lanes z_out = relative_depth(u_out) - depth;
    const Lanes length = select(mask, (z_out - z_in) * extinction_, Lanes(0.0F));
    if (optics_.map == nullptr) {
      Rgba near_end;
      Rgba far_end;
      for (int k = 0; k < 4; ++k) ends(cell, k, z_in, z_out, near_end.channel[k], far_end.channel[k]);
      segment(near_end, far_end, length, light);
      return;
    }
    Lanes s_in;
    Lanes s_out;
    ends(cell, 0, z_in, z_out, s_in, s_out);
    if (optics_.samples > 0) {
      sample_map(cell, s_in, s_out, length, light);
    } else if (cell.first_interval == cell.last_interval) {
      const MapInterval& interval = optics_.map[cell.first_interval];
      segment(mapped(interval, s_in), mapped(interval, s_out), length, light);
    } else {
      split_at_knots(cell, s_in, s_out, length, light);
    }
  }

 private:
  Lanes relative_depth(const Lanes& u) const { return view_.perspective ? reference_ * u / (Lanes(1.0F) - u) : u; }

  void ends(const CellValues& cell, int k, const Lanes& z_in, const Lanes& z_out, Lanes& near_end,
            Lanes& far_end) const {
    const Lanes base = affine(pixels_, cell.base_a[k], cell.base_b[k], cell.base_c[k]);
    const Lanes slope = affine(pixels_, cell.slope_a[k], cell.slope_b[k], cell.slope_c[k]);
    near_end = clamp(multiply_add(z_in, slope, base), cell.low[k], cell.high[k]);
    far_end = clamp(multiply_add(z_out, slope, base), cell.low[k], cell.high[k]);
  }

  static Rgba mapped(const MapInterval& interval, const Lanes& s) {
    const Lanes from_begin = s - Lanes(interval.begin);
    Rgba color;
    for (int k = 0; k < 4; ++k) {
      color.channel[k] = multiply_add(from_begin, Lanes(interval.slope[k]), Lanes(interval.first[k]));
    }
    return color;
  }

  static Rgba mix(const Rgba& a, const Rgba& b, const Lanes& t) {
    Rgba color;
    for (int k = 0; k < 4; ++k) color.channel[k] = multiply_add(t, b.channel[k] - a.channel[k], a.channel[k]);
    return color;
  }

  static void add(const Rgba& near_end, const Rgba& far_end, const optics::Piece<Lanes>& piece, Light& light) {
    const Lanes first = light.through * piece.opacity;
    const Lanes second = light.through * piece.ramp;
    Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
    for (int k = 0; k < 3; ++k) {
      *gathered[k] = multiply_add(first, near_end.channel[k],
                                  multiply_add(second, far_end.channel[k] - near_end.channel[k], *gathered[k]));
    }
    light.through = light.through - first;
  }

  // RGBA linear from end to end; `length` is alpha_length times the way.
  void segment(const Rgba& near_end, const Rgba& far_end, const Lanes& length, Light& light) const {
    if (optics_.samples > 0) {
      const float step = 1.0F / static_cast<float>(optics_.samples);
      const Lanes step_length = length * Lanes(step);
      for (int i = 0; i < optics_.samples; ++i) {
        const Rgba color = mix(near_end, far_end, Lanes((static_cast<float>(i) + 0.5F) * step));
        absorb(color, Lanes(1.0F) - exp_minus(color.channel[3] * step_length), light);
      }
      return;
    }
    const Lanes density_near = near_end.channel[3] * length;
    const Lanes density_far = far_end.channel[3] * length;
    const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
    const Lanes mean = density_near + half_difference;
    if (!any(mean > Lanes(optics::piece_limit))) {
      add(near_end, far_end, optics::integrate_piece(mean, half_difference), light);
      return;
    }
    dense_segment(near_end, far_end, density_near, half_difference, light);
  }

  // In pieces of optical depth 1, until the end or until nothing gets through: at most as many as a ray survives.
  static void dense_segment(const Rgba& near_end, const Rgba& far_end, const Lanes& density_near,
                            const Lanes& half_difference, Light& light) {
    const Lanes one(1.0F);
    const Lanes limit(optics::piece_limit);
    const Lanes far_density = density_near + half_difference + half_difference;
    Lanes u(0.0F);
    Rgba here = near_end;
    for (;;) {
      const Mask active = (u < one) & (light.through > Lanes(opaque_enough));
      if (!any(active)) return;
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

  // Rays on which the scalar rises pass the colour map's intervals upwards, the others downwards; each interval that
  // the cell touches is laid down once in each direction for the rays it concerns.
  void split_at_knots(const CellValues& cell, const Lanes& s_in, const Lanes& s_out, const Lanes& length,
                      Light& light) const {
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
        const MapInterval& interval = optics_.map[direction == 0 ? n : last - (n - first)];
        const Lanes begin(interval.begin);
        const Lanes end(interval.end);
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
        segment(mapped(interval, at_from), mapped(interval, at_to), part, light);
      }
    }
  }

  void sample_map(const CellValues& cell, const Lanes& s_in, const Lanes& s_out, const Lanes& length,
                  Light& light) const {
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
  }

  const View& view_;
  const CellOptics& optics_;
  const BlockInput& block_;
  const Pixels& pixels_;
  Lanes extinction_;  // alpha_length times the way per unit of depth
  Lanes reference_;
};

}  // namespace atomesh::ATOMESH_ISA
