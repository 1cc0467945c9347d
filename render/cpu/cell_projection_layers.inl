// The surface's layers among a block's cells. Included by the kernels' sources after cell_projection_integrate.inl.

namespace atomesh::ATOMESH_ISA {

// Each ray's layers yet to come, nearest first.
//
// A layer comes before the cells whose segment's middle is farther. Being the front of the sample it never truly lies
// inside a segment; but depths are rounded, most where faces are steep.
class Layers {
 public:
  Layers(const CellOptics& optics, const BlockInput& block) : optics_(optics), block_(block) {
    for (int lane = 0; lane < lane_count; ++lane) {
      if (block.layers != nullptr) at_[lane] = block.layer_begin[lane];
      find_next(lane);
    }
  }

  // Lays those that come before the cell behind what is in `light`.
  void lay_before(const Lanes& u_in, const Lanes& u_out, unsigned lanes, Light& light) {
    if (block_.layers != nullptr) lay_up_to(u_in + u_out, lanes, light);
  }
  void lay_rest(Light& light) {
    if (block_.layers != nullptr) lay_up_to(Lanes(none), (1U << lane_count) - 1, light);
  }

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
      for (unsigned rest = due; rest != 0; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        float color[3];
        take(lane, color);
        for (int k = 0; k < 3; ++k) rgb[k][lane] = color[k];
        opacity[lane] = optics_.layer_alpha;
      }
      absorb({{load(rgb[0]), load(rgb[1]), load(rgb[2]), Lanes(0.0F)}}, load(opacity), light);
    }
    return light;
  }

  // The colour of the next one, which is then no longer to come.
  void take(int lane, float* color) {
    optics_.layer.shade(
        optics_.layer.context, block_.layers[at_[lane]++],
        block_.tile_column + block_.lattice.column_phase +
            (block_.column + lane % block_side) * block_.lattice.column_stride,
        block_.tile_row + block_.lattice.row_phase + (block_.row + lane / block_side) * block_.lattice.row_stride,
        color);
    find_next(lane);
  }

  void find_next(int lane) {
    const bool more = block_.layers != nullptr && at_[lane] < block_.layer_begin[lane + 1];
    next_[lane] = more ? 2.0F * block_.layers[at_[lane]].u : none;
  }

  const CellOptics& optics_;
  const BlockInput& block_;
  std::uint32_t at_[lane_count];        // the next one of each ray
  alignas(64) float next_[lane_count];  // twice its u
};

}  // namespace atomesh::ATOMESH_ISA
