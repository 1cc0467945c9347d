// Cells whose vertices carry RGBA, by any rule of cell_projection_segment.inl. Included by the kernels' sources after
// it.

namespace atomesh::ATOMESH_ISA {

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
                                 Lanes(static_cast<float>(view.left + view.pixel * (block.tile_column + tile_middle))));
    const Lanes y = multiply_add(pixels.row, Lanes(-pixel),
                                 Lanes(static_cast<float>(view.top - view.pixel * (block.tile_row + tile_middle))));
    const Lanes length = view.perspective ? sqrt(multiply_add(x, x, multiply_add(y, y, Lanes(1.0F)))) : Lanes(1.0F);
    extinction_ = length * Lanes(optics.alpha_length);
  }

  // z - z_ref
  Lanes relative_depth(const Lanes& u) const { return perspective_ ? reference_ * u * reciprocal(Lanes(1.0F) - u) : u; }
  // alpha_length times the way per unit of depth
  const Lanes& extinction() const { return extinction_; }

 protected:
  // Of a segment, u_in <= u_out: z - z_ref where it begins, and how deep it is, to a few roundings of either.
  struct Stretch {
    Lanes z_in, depth;
  };
  Stretch stretch(const Lanes& u_in, const Lanes& u_out) const {
    if (!perspective_) return {u_in, u_out - u_in};
    const Lanes near_side = Lanes(1.0F) - u_in;
    const Lanes far_side = Lanes(1.0F) - u_out;
    const Lanes scale = reference_ * reciprocal(near_side * far_side);
    return {scale * (u_in * far_side), scale * (u_out - u_in)};
  }

  // The same with twice its middle's z - z_ref.
  struct Middle {
    Lanes twice_z, depth;
  };
  Middle middle(const Lanes& u_in, const Lanes& u_out) const {
    if (!perspective_) return {u_in + u_out, u_out - u_in};
    const Lanes near_side = Lanes(1.0F) - u_in;
    const Lanes far_side = Lanes(1.0F) - u_out;
    const Lanes scale = reference_ * reciprocal(near_side * far_side);
    return {scale * multiply_add(u_out, near_side, u_in * far_side), scale * (u_out - u_in)};
  }

  const CellOptics& optics_;
  Pixels pixels_;

 private:
  Lanes extinction_;
  Lanes reference_;
  bool perspective_;
};

template <class Rule>
class ColorIntegrator : public BlockOptics {
 public:
  ColorIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : BlockOptics(view, optics, block, pixels),
        rule_(optics),
        planes_(block.planes),
        colors_(block.colors),
        ranges_(block.ranges),
        from_eye_(view.perspective ? static_cast<float>(view.reference) : 1.0F),
        widening_(view.perspective ? 1.0F : 0.0F) {}

  static constexpr bool prepares = false;
  using Record = CellColors;
  const CellColors& record(std::uint32_t number) const { return colors_[number]; }

  // Lays the segment of one cell behind what is in `light`.
  void compose(std::uint32_t number, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const Mask every[1] = {mask_of(0xFFFFU)};
    lay<1>(&number, every, u_in, u_out, light);
  }

  // Lays `count` cells, each on rays of its own (the first on all that are not another's); those that are wild alone.
  template <int count>
  void lay(const std::uint32_t* numbers, const Mask* rays, const Lanes& u_in, const Lanes& u_out, Light& light) const {
    const CellColors* cells[count];
    for (int n = 0; n < count; ++n) cells[n] = &colors_[numbers[n]];
    Lanes depth(planes_[numbers[0]].depth);
    for (int n = 1; n < count; ++n) depth = select(rays[n], Lanes(planes_[numbers[n]].depth), depth);
    const auto of_rays = [&](const float(CellColors::*channels)[4], int k) {
      Lanes value((cells[0]->*channels)[k]);
      for (int n = 1; n < count; ++n) value = select(rays[n], Lanes((cells[n]->*channels)[k]), value);
      return value;
    };
    const Stretch s = stretch(u_in, u_out);
    const Lanes z_in = s.z_in - depth;
    const Lanes h_in = multiply_add(s.z_in, widening_, from_eye_);
    Rgba near_end;
    Rgba change;
    for (int k = 0; k < 4; ++k) {
      const Lanes slope_c = of_rays(&CellColors::slope_c, k);
      const Lanes across = multiply_add(of_rays(&CellColors::slope_a, k), pixels_.column,
                                        of_rays(&CellColors::slope_b, k) * pixels_.row);
      near_end.channel[k] = multiply_add(h_in, across, multiply_add(z_in, slope_c, of_rays(&CellColors::base, k)));
      change.channel[k] = s.depth * multiply_add(across, widening_, slope_c);
    }
    if (count == 1 && planes_[numbers[0]].wild) {
      const ColorRange& range = ranges_[numbers[0]];
      for (int k = 0; k < 4; ++k) {
        const Lanes far_end = clamp(near_end.channel[k] + change.channel[k], range.low[k], range.high[k]);
        near_end.channel[k] = clamp(near_end.channel[k], range.low[k], range.high[k]);
        change.channel[k] = far_end - near_end.channel[k];
      }
    }
    // However small, a negative opacity would shine where extinction is large.
    const Lanes far_opacity = max(near_end.channel[3] + change.channel[3], Lanes(0.0F));
    near_end.channel[3] = max(near_end.channel[3], Lanes(0.0F));
    const Lanes length = s.depth * extinction();
    if constexpr (std::is_same_v<Rule, ClosedForm>) {
      rule_.add_change(near_end, change, far_opacity, length, light);
    } else {
      Rgba far_end;
      for (int k = 0; k < 3; ++k) far_end.channel[k] = near_end.channel[k] + change.channel[k];
      far_end.channel[3] = far_opacity;
      rule_.add(near_end, far_end, length, light);
    }
  }

 private:
  Rule rule_;
  const CellPlanes* planes_;
  const CellColors* colors_;
  const ColorRange* ranges_;
  Lanes from_eye_, widening_;  // h = from_eye + widening (z - z_ref)
};

}  // namespace atomesh::ATOMESH_ISA
