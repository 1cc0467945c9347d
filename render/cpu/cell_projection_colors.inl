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
                                 Lanes(static_cast<float>(view.left + view.pixel * block.tile_column)));
    const Lanes y =
        multiply_add(pixels.row, Lanes(-pixel), Lanes(static_cast<float>(view.top - view.pixel * block.tile_row)));
    const Lanes length = view.perspective ? sqrt(multiply_add(x, x, multiply_add(y, y, Lanes(1.0F)))) : Lanes(1.0F);
    extinction_ = length * Lanes(optics.alpha_length);
  }

  // z - z_ref
  Lanes relative_depth(const Lanes& u) const { return perspective_ ? reference_ * u * reciprocal(Lanes(1.0F) - u) : u; }
  // alpha_length times the way per unit of depth
  const Lanes& extinction() const { return extinction_; }

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
  Lanes extinction_;
  Lanes reference_;
  bool perspective_;
};

template <class Rule>
class ColorIntegrator : public BlockOptics {
 public:
  ColorIntegrator(const View& view, const CellOptics& optics, const BlockInput& block, const Pixels& pixels)
      : BlockOptics(view, optics, block, pixels), rule_(optics), colors_(block.colors), ranges_(block.ranges) {}

  static constexpr bool prepares = false;
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
    // However small, a negative opacity would shine where extinction is large.
    near_end.channel[3] = max(near_end.channel[3], Lanes(0.0F));
    far_end.channel[3] = max(far_end.channel[3], Lanes(0.0F));
    rule_.add(near_end, far_end, w.length, light);
  }

 private:
  Rule rule_;
  const CellColors* colors_;
  const ColorRange* ranges_;
};

}  // namespace atomesh::ATOMESH_ISA
