// Cells whose vertices carry a scalar that the colour map turns into RGBA: at a segment's two ends, at samples, or at
// every point. Included by the kernels' sources after cell_projection_colors.inl.
//
// Scalars are counted from the cell's own reference, a scalar in its midst: what floats resolve is then a share of the
// cell's range, and where a knot is met is as good as where the cell begins and ends.

namespace atomesh::ATOMESH_ISA {

class MappedCells : public BlockOptics {
 public:
  MappedCells(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : BlockOptics(view, optics, block, pixels), scalars_(block.scalars) {}

  using Record = CellScalar;
  const CellScalar& record(std::uint32_t number) const { return scalars_[number]; }

 protected:
  // Scalars of the segment's ends, from the cell's reference, and `length` as ClosedForm::add() has it.
  struct Segment {
    Lanes s_in, s_out, length;
  };
  Segment segment(const CellScalar& cell, const Lanes& u_in, const Lanes& u_out) const {
    const Way w = way(u_in, u_out, cell.depth);
    const Pixels pixels{pixels_.column - Lanes(cell.column), pixels_.row - Lanes(cell.row)};
    const Lanes base = affine(pixels, cell.base_a, cell.base_b, cell.base_c);
    const Lanes slope = affine(pixels, cell.slope_a, cell.slope_b, cell.slope_c);
    const float low = cell.low - cell.reference;
    const float high = cell.high - cell.reference;
    return {clamp(multiply_add(w.z_in, slope, base), low, high), clamp(multiply_add(w.z_out, slope, base), low, high),
            w.length};
  }

  const MapInterval& interval(int n) const { return optics_.map[n]; }

  // Where an interval begins, from the cell's reference: the difference of two floats that are near each other is
  // exact.
  static float begin_of(const MapInterval& interval, const CellScalar& cell) {
    return interval.begin - cell.reference + interval.begin_rest;
  }

  static Rgba color_at(const MapInterval& interval, const Lanes& place) {
    Rgba color;
    for (int k = 0; k < 4; ++k) {
      color.channel[k] = multiply_add(place, Lanes(interval.slope[k]), Lanes(interval.first[k]));
    }
    return color;
  }

  // The intervals that scalars from `bottom` to `top` of any lane in `met` may touch, of those that the cell touches.
  struct Intervals {
    int first, last;
  };
  Intervals intervals(const CellScalar& cell, const Lanes& bottom, const Lanes& top, const Mask& met) const {
    Intervals range{cell.first_interval, cell.last_interval};
    // Finding out which are met costs as much as passing about so many.
    constexpr int few_intervals = 3;
    if (range.last - range.first > few_intervals) {
      constexpr float rounding = 1e-6F;
      const int first = find(smallest(select(met, bottom, Lanes(1.0F))) + cell.reference - rounding);
      const int last = find(largest(select(met, top, Lanes(-1.0F))) + cell.reference + rounding);
      range.first = range.first > first ? range.first : first;
      range.last = range.last < last ? range.last : last;
    }
    return range;
  }

  const CellScalar* scalars_;

 private:
  // MapIntervals::find().
  int find(float scalar) const {
    const float place = scalar * static_cast<float>(map_grid_size);
    const float last = static_cast<float>(map_grid_size - 1);
    int n = optics_.map_grid[static_cast<int>(place > 0.0F ? (place < last ? place : last) : 0.0F)];
    while (n + 1 < optics_.map_intervals && scalar >= optics_.map[n + 1].begin) ++n;
    return n;
  }
};

// The map at the segment's ends, RGBA linear between them by a rule of cell_projection_segment.inl.
template <class Rule>
class MappedEndsIntegrator : public MappedCells {
 public:
  MappedEndsIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : MappedCells(view, optics, block, pixels), rule_(optics) {}

  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellScalar& cell = scalars_[number];
    const Segment s = segment(cell, u_in, u_out);
    const Intervals range = intervals(cell, min(s.s_in, s.s_out), max(s.s_in, s.s_out), u_in < u_out);
    const MapInterval* map = &interval(range.first);
    const float begin = begin_of(*map, cell);
    Rgba near_end = color_at(*map, s.s_in - Lanes(begin));
    Rgba far_end = color_at(*map, s.s_out - Lanes(begin));
    for (int n = range.first + 1; n <= range.last; ++n) {
      map = &interval(n);
      const Lanes next(begin_of(*map, cell));
      const Mask near_below = s.s_in < next;
      const Mask far_below = s.s_out < next;
      const Rgba near_color = color_at(*map, s.s_in - next);
      const Rgba far_color = color_at(*map, s.s_out - next);
      for (int k = 0; k < 4; ++k) {
        near_end.channel[k] = select(near_below, near_end.channel[k], near_color.channel[k]);
        far_end.channel[k] = select(far_below, far_end.channel[k], far_color.channel[k]);
      }
    }
    rule_.add(near_end, far_end, s.length, light);
  }

 private:
  Rule rule_;
};

// The map at samples in the middle of equal steps.
class MappedSamplesIntegrator : public MappedCells {
 public:
  using MappedCells::MappedCells;

  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellScalar& cell = scalars_[number];
    const Segment s = segment(cell, u_in, u_out);
    light = add_all(cell, intervals(cell, min(s.s_in, s.s_out), max(s.s_in, s.s_out), u_in < u_out), s, light);
  }

 private:
  __attribute__((noinline, flatten)) Light add_all(const CellScalar& cell, Intervals range, Segment s,
                                                   Light light) const {
    const float step = 1.0F / static_cast<float>(optics_.samples);
    const Lanes step_length = s.length * Lanes(step);
    for (int i = 0; i < optics_.samples; ++i) {
      const Lanes here = multiply_add(Lanes((static_cast<float>(i) + 0.5F) * step), s.s_out - s.s_in, s.s_in);
      Rgba color = color_at(interval(range.first), here - Lanes(begin_of(interval(range.first), cell)));
      for (int n = range.first + 1; n <= range.last; ++n) {
        const Lanes begin(begin_of(interval(n), cell));
        const Mask below = here < begin;
        const Rgba other = color_at(interval(n), here - begin);
        for (int k = 0; k < 4; ++k) color.channel[k] = select(below, color.channel[k], other.channel[k]);
      }
      absorb(color, opacity_of(color.channel[3] * step_length), light);
    }
    return light;
  }
};

// The map at every point: the closed form in each interval.
class MappedIntegrator : public MappedCells {
 public:
  using MappedCells::MappedCells;

  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellScalar& cell = scalars_[number];
    const Segment s = segment(cell, u_in, u_out);
    if (cell.first_interval == cell.last_interval) {
      add_within(cell, s, light);
    } else if (any(s.length > Lanes(optics::thin_limit))) {
      light = add_across<false>(cell, s, u_in < u_out, light);
    } else {
      light = add_across<true>(cell, s, u_in < u_out, light);
    }
  }

 private:
  // Adds light of which `taken` has the colour of the interval's beginning, changed as far as `place` says.
  static void lay(const MapInterval& interval, const Lanes& taken, const Lanes& place, Light& light) {
    Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
    for (int k = 0; k < 3; ++k) {
      *gathered[k] =
          multiply_add(taken, Lanes(interval.first[k]), multiply_add(place, Lanes(interval.slope[k]), *gathered[k]));
    }
  }

  // A segment of a cell that touches one interval only.
  void add_within(const CellScalar& cell, const Segment& s, Light& light) const {
    const MapInterval& map = interval(cell.first_interval);
    const Lanes begin(begin_of(map, cell));
    const Lanes near_place = s.s_in - begin;
    const Lanes far_place = s.s_out - begin;
    const Lanes zero(0.0F);
    const Lanes first_opacity(map.first[3]);
    const Lanes opacity_slope(map.slope[3]);
    const Lanes density_near = max(multiply_add(near_place, opacity_slope, first_opacity), zero) * s.length;
    const Lanes density_far = max(multiply_add(far_place, opacity_slope, first_opacity), zero) * s.length;
    const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
    const optics::Piece<Lanes> piece = integrate(density_near + half_difference, density_near, half_difference);
    const Lanes taken = light.through * piece.opacity;
    const Lanes place = multiply_add(taken, near_place, light.through * piece.ramp * (far_place - near_place));
    lay(map, taken, place, light);
    take(taken, light);
  }

  // A segment that passes several intervals, taken upwards whichever way the scalar goes: where it falls each
  // interval's light is laid before that of those below, where it rises behind. Intervals that a lane does not touch
  // leave it as it is. `thin`: no lane's optical depth may exceed thin_limit.
  template <bool thin>
  Light add_across(const CellScalar& cell, Segment s, Mask met, Light light) const {
    const Lanes zero(0.0F);
    const Lanes one(1.0F);
    const Lanes bottom = min(s.s_in, s.s_out);
    // A scalar that does not change gets a range to spread over: a rounding's worth.
    const float below = cell.reference - cell.low;
    const float above = cell.high - cell.reference;
    const float least = (below > above ? below : above) * 0x1p-22F + 1e-25F;
    const Lanes top = max(max(s.s_in, s.s_out), bottom + Lanes(least));
    const Intervals range = intervals(cell, bottom, top, met);
    const Mask falls = s.s_out < s.s_in;
    const Lanes half_way = select(falls, Lanes(-0.5F), Lanes(0.5F));
    const Lanes per_rise = s.length / (top - bottom);
    Light here;
    Lanes begin(begin_of(interval(range.first), cell));
    for (int n = range.first; n <= range.last; ++n) {
      const MapInterval& map = interval(n);
      const Lanes end(n == range.last ? 3e38F : begin_of(interval(n + 1), cell));
      const Lanes from = n == range.first ? bottom : max(bottom, begin);
      const Lanes to = min(top, end);
      const Lanes part = max(to - from, zero) * per_rise;
      const Lanes low_place = from - begin;
      const Lanes high_place = to - begin;
      begin = end;
      const Lanes opacity_slope(map.slope[3]);
      const Lanes first_opacity(map.first[3]);
      const Lanes density_low = part * max(multiply_add(low_place, opacity_slope, first_opacity), zero);
      const Lanes density_high = part * max(multiply_add(high_place, opacity_slope, first_opacity), zero);
      const Lanes mean = Lanes(0.5F) * (density_low + density_high);
      const Lanes half_difference = half_way * (density_high - density_low);
      const optics::Piece<Lanes> piece =
          thin ? optics::integrate_thin_piece(mean, half_difference)
               : integrate(mean, select(falls, density_high, density_low), half_difference);
      const Lanes low_weight = select(falls, piece.ramp, piece.opacity - piece.ramp);
      const Lanes high_weight = piece.opacity - low_weight;
      const Lanes before = select(falls, one, here.through);
      const Lanes kept = select(falls, one - piece.opacity, one);
      here.red = kept * here.red;
      here.green = kept * here.green;
      here.blue = kept * here.blue;
      lay(map, before * piece.opacity, before * multiply_add(low_weight, low_place, high_weight * high_place), here);
      take(here.through * piece.opacity, here);
    }
    light.red = multiply_add(light.through, here.red, light.red);
    light.green = multiply_add(light.through, here.green, light.green);
    light.blue = multiply_add(light.through, here.blue, light.blue);
    light.covered = multiply_add(light.through, here.covered, light.covered);
    light.through = light.through * here.through;
    return light;
  }
};

}  // namespace atomesh::ATOMESH_ISA
