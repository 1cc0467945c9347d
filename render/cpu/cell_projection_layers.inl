// The surface's layers among a block's cells, and the medium between the cells. Included by the kernels' sources after
// cell_projection_integrate.inl.

namespace atomesh::ATOMESH_ISA {

// Each ray's hits of the surface yet to come, nearest first.
//
// A hit comes before the cells whose segment's middle is farther. Being the front or the back of the sample it never
// truly lies inside a segment; but depths are rounded, most where faces are steep.
//
// The medium begins where the last cell ended or the surface was entered, and ends where the next cell begins or the
// surface is left. Roundings only move those ends: however hits and cells are ordered, light changes by as little.
class Layers {
 public:
  Layers(const View& view, const CellOptics& optics, const BlockInput& block, const BlockOptics& rays)
      : optics_(optics), block_(block), rays_(rays), reference_(view.reference), perspective_(view.perspective) {
    for (int k = 0; k < 4; ++k) medium_.channel[k] = Lanes(optics.medium[k]);
    for (int lane = 0; lane < lane_count; ++lane) {
      if (block.layers != nullptr) at_[lane] = block.layer_begin[lane];
      find_next(lane);
    }
    if (block.layers == nullptr || !optics.has_medium) return;
    // What is left more often than entered was entered behind the eye.
    for (int lane = 0; lane < lane_count; ++lane) {
      int inside = 0;
      for (std::uint32_t n = block.layer_begin[lane]; n < block.layer_begin[lane + 1]; ++n) {
        inside += block.layers[n].triangle == no_index ? 1 : -1;
      }
      inside_[lane] = static_cast<float>(inside);
      from_[lane] = view.nearest;
      from_depth_[lane] = 0.0;
    }
  }

  // Lays what comes before the cell behind what is in `light`, and finishes what it leaves opaque.
  void lay_before(const Lanes& u_in, const Lanes& u_out, unsigned lanes, Light& light) {
    if (block_.layers == nullptr) return;
    lay_up_to(u_in + u_out, lanes, light);
    if (optics_.has_medium) fill_before(u_in, u_out, lanes, light);
  }
  void lay_rest(Light& light) {
    if (block_.layers != nullptr) lay_up_to(Lanes(none), (1U << lane_count) - 1, light);
  }

  // Stretches of the medium that were met.
  std::uint64_t steps() const { return steps_; }

 private:
  static constexpr float none = 3e38F;

  void lay_up_to(const Lanes& twice_u, unsigned lanes, Light& light) {
    if ((lanes & bits(load(next_) < twice_u)) != 0) light = lay_due(twice_u, lanes, light);
  }

  // Shaded one ray at a time: a ray has few.
  __attribute__((noinline)) Light lay_due(Lanes twice_u, unsigned lanes, Light light) {
    const unsigned open = lanes & bits(light.through > Lanes(opaque_enough));
    while (const unsigned due = open & bits(load(next_) < twice_u)) {
      alignas(64) float rgb[3][lane_count] = {};
      alignas(64) float opacity[lane_count] = {};
      alignas(64) float stretch[lane_count] = {};
      for (unsigned rest = due; rest != 0; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const LayerHit& hit = block_.layers[at_[lane]++];
        find_next(lane);
        if (optics_.has_medium) stretch[lane] = stretch_up_to(hit, lane);
        if (hit.triangle == no_index || !(optics_.layer_alpha > 0.0F)) continue;
        float color[3];
        shade(hit, lane, color);
        for (int k = 0; k < 3; ++k) rgb[k][lane] = color[k];
        opacity[lane] = optics_.layer_alpha;
      }
      if (optics_.has_medium) fill(load(stretch), light);
      absorb({{load(rgb[0]), load(rgb[1]), load(rgb[2]), Lanes(0.0F)}}, load(opacity), light);
    }
    finish_opaque(light);
    return light;
  }

  void shade(const LayerHit& hit, int lane, float* color) const {
    optics_.layer.shade(
        optics_.layer.context, hit,
        block_.tile_column + block_.lattice.column_phase +
            (block_.column + lane % block_side) * block_.lattice.column_stride,
        block_.tile_row + block_.lattice.row_phase + (block_.row + lane / block_side) * block_.lattice.row_stride,
        color);
  }

  void find_next(int lane) {
    const bool more = block_.layers != nullptr && at_[lane] < block_.layer_begin[lane + 1];
    next_[lane] = more ? 2.0F * block_.layers[at_[lane]].u : none;
  }

  // Lanes that meet the cell: the medium before it, which goes on behind it.
  void fill_before(const Lanes& u_in, const Lanes& u_out, unsigned lanes, Light& light) {
    const Mask met = mask_of(lanes);
    const Lanes from = load(from_);
    const Mask gap = met & (load(inside_) > Lanes(0.0F)) & (u_in > from);
    if (any(gap)) light = fill_gap(u_in, gap, light);
    store(from_, select(met, max(from, u_out), from));
    from_hit_ &= ~lanes;
  }

  __attribute__((noinline, flatten)) Light fill_gap(Lanes u_in, Mask gap, Light light) {
    alignas(64) float hit[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) hit[lane] = static_cast<float>(from_depth_[lane] - reference_);
    const Lanes from = select(mask_of(from_hit_), load(hit), rays_.relative_depth(load(from_)));
    fill(select(gap, max(rays_.relative_depth(u_in) - from, Lanes(0.0F)), Lanes(0.0F)), light);
    finish_opaque(light);
    return light;
  }

  // Depth from where the medium begins on the ray to the hit.
  float stretch_up_to(const LayerHit& hit, int lane) {
    double from = from_depth_[lane];
    if ((from_hit_ >> lane & 1U) == 0) {
      const double u = from_[lane];
      from = reference_ + (perspective_ ? reference_ * u / (1.0 - u) : u);
    }
    const bool fills = inside_[lane] > 0.0F && hit.depth > from;
    inside_[lane] += hit.triangle == no_index ? -1.0F : 1.0F;
    from_hit_ |= 1U << lane;
    from_depth_[lane] = hit.depth;
    from_[lane] = static_cast<float>(perspective_ ? 1.0 - reference_ / hit.depth : hit.depth - reference_);
    return fills ? static_cast<float>(hit.depth - from) : 0.0F;
  }

  void fill(const Lanes& depth, Light& light) {
    steps_ += static_cast<unsigned>(__builtin_popcount(bits(depth > Lanes(0.0F))));
    ClosedForm(optics_).add(medium_, medium_, depth * rays_.extinction(), light);
  }

  const CellOptics& optics_;
  const BlockInput& block_;
  const BlockOptics& rays_;
  double reference_;
  bool perspective_;
  std::uint32_t at_[lane_count];        // the next one of each ray
  alignas(64) float next_[lane_count];  // twice its u
  // The medium of each ray: how often the ray is inside the surface; where the medium begins that is not laid yet, and
  // whether that is a hit's depth, which is then known better.
  Rgba medium_;
  alignas(64) float inside_[lane_count];
  alignas(64) float from_[lane_count];  // u
  double from_depth_[lane_count];
  unsigned from_hit_ = (1U << lane_count) - 1;
  std::uint64_t steps_ = 0;
};

}  // namespace atomesh::ATOMESH_ISA
