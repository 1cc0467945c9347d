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

  static constexpr bool prepares = true;
  using Record = CellScalar;
  const CellScalar& record(std::uint32_t number) const { return scalars_[number]; }

  struct Intervals {
    int first, last;
  };
  // The scalar in the segment's middle, from the cell's reference, and half of what it changes by; `length` as
  // ClosedForm::add() has it; and the intervals that lanes with a segment touch.
  struct Prepared {
    Lanes middle, half, length;
    Intervals range;
    bool thin;  // the optical depth of no lane's segment exceeds thin_limit
  };
  void prepare(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Prepared& prepared) const {
    const CellScalar& cell = scalars_[number];
    const Mask met = u_in < u_out;
    const Middle m = BlockOptics::middle(u_in, u_out);
    const Lanes length = m.depth * extinction();
    const Pixels pixels{pixels_.column - Lanes(cell.column), pixels_.row - Lanes(cell.row)};
    const Lanes base = affine(pixels, cell.base_a, cell.base_b, cell.base_c);
    const Lanes slope = affine(pixels, cell.slope_a, cell.slope_b, cell.slope_c);
    Lanes middle = multiply_add(m.twice_z - Lanes(cell.twice_depth), slope, base);
    Lanes half = m.depth * slope;
    if (cell.wild != 0) {
      const float low = cell.low - cell.reference;
      const float high = cell.high - cell.reference;
      const Lanes s_in = clamp(middle - half, low, high);
      const Lanes s_out = clamp(middle + half, low, high);
      middle = Lanes(0.5F) * (s_in + s_out);
      half = Lanes(0.5F) * (s_out - s_in);
    }
    prepared.middle = middle;
    prepared.half = half;
    prepared.length = length;
    const Lanes reach = magnitude(half);
    prepared.range = intervals(cell, middle - reach, middle + reach, met);
    prepared.thin = !any(length > Lanes(cell.thin_length));
  }

 protected:
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

  // The intervals that the scalars from `bottom` to `top` of the lanes in `met` touch, of those that the cell touches.
  // First comes after last where no lane is met.
  Intervals intervals(const CellScalar& cell, const Lanes& bottom, const Lanes& top, const Mask& met) const {
    Intervals range{cell.first_interval, cell.last_interval};
    // Few cells touch more: so far nothing need be guessed.
    if (range.last - range.first > 1) {
      // Finding out roughly costs as much as asking at so many knots.
      constexpr int few_knots = 4;
      if (range.last - range.first > few_knots) {
        constexpr float rounding = 1e-6F;
        const int first = find(smallest(select(met, bottom, Lanes(1.0F))) + cell.reference - rounding);
        const int last = find(largest(select(met, top, Lanes(-1.0F))) + cell.reference + rounding);
        range.first = range.first > first ? range.first : first;
        range.last = range.last < last ? range.last : last;
      }
      const Intervals all = range;
      for (int n = all.first + 1; n <= all.last; ++n) {
        const Lanes knot(begin_of(interval(n), cell));
        range.first += any(met & (bottom < knot)) ? 0 : 1;
        range.last -= any(met & !(top < knot)) ? 0 : 1;
      }
      return range;
    }
    // Where the cell touches one interval only, all lie below the next one.
    const Lanes knot(cell.knot);
    const int above = any(met & !(top < knot)) ? 1 : 0;
    range.last = range.first + above;
    range.first += any(met & (bottom < knot)) ? 0 : 1;
    return range;
  }

  const CellScalar* scalars_;

 private:
  // MapIntervals::find().
  int find(float scalar) const {
    const float place = scalar * static_cast<float>(map_grid_size);
    const float last = static_cast<float>(map_grid_size - 1);
    int n = optics_.map_grid[static_cast<int>(place > 0.0F ? (place < last ? place : last) : 0.0F)];
    while (scalar >= optics_.map[n + 1].begin) ++n;
    return n;
  }
};

// The map at the segment's ends, RGBA linear between them by a rule of cell_projection_segment.inl.
template <class Rule>
class MappedEndsIntegrator : public MappedCells {
 public:
  MappedEndsIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : MappedCells(view, optics, block, pixels), rule_(optics) {}

  void lay(std::uint32_t number, const Prepared& s, Light& light) const {
    const CellScalar& cell = scalars_[number];
    const Intervals range = s.range;
    const MapInterval* map = &interval(range.first);
    const float begin = begin_of(*map, cell);
    const Lanes s_in = s.middle - s.half;
    const Lanes s_out = s.middle + s.half;
    Rgba near_end = color_at(*map, s_in - Lanes(begin));
    Rgba far_end = color_at(*map, s_out - Lanes(begin));
    for (int n = range.first + 1; n <= range.last; ++n) {
      map = &interval(n);
      const Lanes next(begin_of(*map, cell));
      const Mask near_below = s_in < next;
      const Mask far_below = s_out < next;
      const Rgba near_color = color_at(*map, s_in - next);
      const Rgba far_color = color_at(*map, s_out - next);
      for (int k = 0; k < 4; ++k) {
        near_end.channel[k] = select(near_below, near_end.channel[k], near_color.channel[k]);
        far_end.channel[k] = select(far_below, far_end.channel[k], far_color.channel[k]);
      }
    }
    // However small, a negative opacity would shine where extinction is large.
    near_end.channel[3] = max(near_end.channel[3], Lanes(0.0F));
    far_end.channel[3] = max(far_end.channel[3], Lanes(0.0F));
    rule_.add(near_end, far_end, s.length, light);
  }

 private:
  Rule rule_;
};

// The map at samples in the middle of equal steps.
class MappedSamplesIntegrator : public MappedCells {
 public:
  using MappedCells::MappedCells;

  void lay(std::uint32_t number, const Prepared& s, Light& light) const { light = add_all(scalars_[number], s, light); }

 private:
  __attribute__((noinline, flatten)) Light add_all(const CellScalar& cell, const Prepared& s, Light light) const {
    const Intervals range = s.range;
    const float step = 1.0F / static_cast<float>(optics_.samples);
    const Lanes step_length = s.length * Lanes(step);
    Light gathered;
    for (int i = 0; i < optics_.samples; ++i) {
      const Lanes here = multiply_add(Lanes((static_cast<float>(2 * i + 1) * step) - 1.0F), s.half, s.middle);
      Rgba color = color_at(interval(range.first), here - Lanes(begin_of(interval(range.first), cell)));
      for (int n = range.first + 1; n <= range.last; ++n) {
        const Lanes begin(begin_of(interval(n), cell));
        const Mask below = here < begin;
        const Rgba other = color_at(interval(n), here - begin);
        for (int k = 0; k < 4; ++k) color.channel[k] = select(below, color.channel[k], other.channel[k]);
      }
      absorb(color, opacity_of(max(color.channel[3], Lanes(0.0F)) * step_length), gathered);
    }
    add_gathered(gathered, light);
    return light;
  }
};

// The map at every point: the closed form in each interval.
class MappedIntegrator : public MappedCells {
 public:
  using MappedCells::MappedCells;

  void lay(std::uint32_t number, const Prepared& s, Light& light) const {
    const CellScalar& cell = scalars_[number];
    if (s.range.first == s.range.last) {
      const MapInterval& map = interval(s.range.first);
      const Lanes place = s.middle - Lanes(begin_of(map, cell));
      if (s.thin) {
        add_piece<true>(map, place, s.half, s.length, light);
      } else {
        add_piece<false>(map, place, s.half, s.length, light);
      }
    } else if (s.thin) {
      add_across<true>(cell, s, light);
    } else {
      add_across<false>(cell, s, light);
    }
  }

 private:
  // A piece within one interval: the scalar in its middle, from where the interval begins, and half of what it changes
  // by. Of no length it adds nothing.
  template <bool thin>
  static void add_piece(const MapInterval& map, const Lanes& middle, const Lanes& half, const Lanes& length,
                        Light& light) {
    const Lanes opacity_slope(map.slope[3]);
    const Lanes mean = max(multiply_add(middle, opacity_slope, Lanes(map.first[3])), Lanes(0.0F)) * length;
    const Lanes half_difference = half * length * opacity_slope;
    const optics::CenteredPiece<Lanes> piece =
        thin ? optics::integrate_thin_centered(mean, half_difference) : integrate_centered(mean, half_difference);
    const Lanes taken = light.through * piece.opacity;
    const Lanes place = multiply_add(taken, middle, light.through * piece.skew * half);
    // Light of which `taken` has the colour of the interval's beginning, changed as far as `place` says.
    Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
    for (int k = 0; k < 3; ++k) {
      *gathered[k] = multiply_add(taken, Lanes(map.first[k]), multiply_add(place, Lanes(map.slope[k]), *gathered[k]));
    }
    take(taken, light);
  }

  // Segments of which some pass several intervals. Whatever others pass, those that lie in one interval get what
  // lay() would add of them alone.
  template <bool thin>
  void add_across(const CellScalar& cell, const Prepared& s, Light& light) const {
    const Mask falls = s.half < Lanes(0.0F);
    const Mask met = s.length > Lanes(0.0F);
    const bool some_fall = any(met & falls);
    if (s.range.last - s.range.first == 1 && !(some_fall && any(met & !falls))) {
      add_two<thin>(cell, s, !some_fall, light);
      return;
    }
    if (any(met & !falls)) add_parts<true, thin>(cell, s, select(falls, Lanes(0.0F), s.length), light);
    if (some_fall) add_parts<false, thin>(cell, s, select(falls, s.length, Lanes(0.0F)), light);
  }

  // Two intervals, which all rays pass in one order: what add_parts() would add, in fewer instructions and with none
  // that depends on the order but an address.
  template <bool thin>
  void add_two(const CellScalar& cell, const Prepared& s, bool up, Light& light) const {
    const Lanes zero(0.0F);
    const Lanes reach = magnitude(s.half);
    const Lanes bottom = s.middle - reach;
    const Lanes top = s.middle + reach;
    const MapInterval* const map = &interval(s.range.first);
    const Lanes begin(begin_of(map[0], cell));
    const Lanes knot(begin_of(map[1], cell));
    const Lanes share = min(Lanes(0.5F) * (knot - bottom) / reach, Lanes(1.0F));
    const Mask some = bottom < knot;
    const Mask all = top < knot;
    const Mask passes = some & !all;
    struct Part {
      Lanes middle, half, length;
    };
    Part lower, upper;
    lower.length = select(all, s.length, select(some, share * s.length, zero));
    lower.half = select(all, s.half, select(some, share * s.half, zero));
    upper.length = s.length - lower.length;
    upper.half = s.half - lower.half;
    lower.middle = select(passes, (knot - begin) - magnitude(lower.half), s.middle - begin);
    upper.middle = select(passes, magnitude(upper.half), s.middle - knot);
    if (up) {
      add_piece<thin>(map[0], lower.middle, lower.half, lower.length, light);
      add_piece<thin>(map[1], upper.middle, upper.half, upper.length, light);
    } else {
      add_piece<thin>(map[1], upper.middle, upper.half, upper.length, light);
      add_piece<thin>(map[0], lower.middle, lower.half, lower.length, light);
    }
  }

  // The segments along which the scalar rises, or those along which it falls; of the others `length` is zero. What
  // lies below each knot tells how much lies between two.
  template <bool up, bool thin>
  void add_parts(const CellScalar& cell, const Prepared& s, const Lanes& length, Light& light) const {
    const Lanes zero(0.0F);
    const Lanes reach = magnitude(s.half);
    const Lanes bottom = s.middle - reach;
    const Lanes top = s.middle + reach;
    const Intervals range = s.range;
    // Length and half change up to the knot that was met last.
    Lanes old_length = up ? zero : length;
    Lanes old_half = up ? zero : s.half;
    Lanes begin(begin_of(interval(up ? range.first : range.last), cell));
    Lanes end = begin;
    Mask passes_begin = zero < zero;
    Mask passes_end = passes_begin;
    for (int n = up ? range.first : range.last; up ? n <= range.last : n >= range.first; n += up ? 1 : -1) {
      const bool at_last = n == (up ? range.last : range.first);
      Lanes new_length = up ? length : zero;
      Lanes new_half = up ? s.half : zero;
      Mask passes = zero < zero;
      if (!at_last) {
        const Lanes knot = up ? Lanes(begin_of(interval(n + 1), cell)) : begin;
        const Lanes share = min(Lanes(0.5F) * (knot - bottom) / reach, Lanes(1.0F));
        const Mask some = bottom < knot;
        const Mask all = top < knot;
        passes = some & !all;
        new_length = select(all, length, select(some, share * length, zero));
        new_half = select(all, s.half, select(some, share * s.half, zero));
        if (up) end = knot;
      }
      (up ? passes_end : passes_begin) = passes;
      const Lanes part_length = up ? new_length - old_length : old_length - new_length;
      const Lanes half = up ? new_half - old_half : old_half - new_half;
      const Lanes part_reach = magnitude(half);
      const Lanes middle =
          select(passes_begin, part_reach, select(passes_end, (end - begin) - part_reach, s.middle - begin));
      add_piece<thin>(interval(n), middle, half, part_length, light);
      old_length = new_length;
      old_half = new_half;
      if (up) {
        begin = end;
        passes_begin = passes;
      } else {
        end = begin;
        passes_end = passes;
        if (!at_last) begin = Lanes(begin_of(interval(n - 1), cell));
      }
    }
  }
};

}  // namespace atomesh::ATOMESH_ISA
