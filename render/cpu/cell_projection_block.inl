// A block of 4×4 pixels: which cells its rays meet, in which order, and what they add up to. Included by the kernels'
// sources after cell_projection_layers.inl.

namespace atomesh::ATOMESH_ISA {

// Keeps `order`, the block's cells so far, sorted so that on every ray nearer segments stand before farther ones.
class Order {
 public:
  explicit Order(const BlockScratch& scratch) : scratch_(scratch) {}

  std::uint32_t count() const { return count_; }

  // Adds the cell `added`, whose depths are in the scratch. False when the cells overlap in a cycle, so that no order
  // is right for all of the block's rays; the cell is then last.
  bool add(std::uint32_t added, const Lanes& u_in, const Mask& lanes) {
    const Mask wrong = lanes & (u_in < last_);
    last_ = select(lanes, max(u_in, last_), last_);
    scratch_.order[count_++] = added;
    const unsigned wrong_lanes = bits(wrong);
    return wrong_lanes == 0 || move_forward(added, u_in, lanes, wrong_lanes);
  }

 private:
  // The added cell belongs before some earlier ones. Those of them that must follow it (directly or because they follow
  // one that must) move behind it in their present order; the others keep their place.
  bool move_forward(std::uint32_t added, const Lanes& u_in, const Mask& lanes, unsigned unsettled) {
    std::uint32_t first = count_ - 1;
    for (std::uint32_t at = count_ - 1; at-- > 0 && unsettled != 0;) {
      const std::uint32_t other = scratch_.order[at];
      const unsigned shared = scratch_.lanes[other] & unsettled;
      if (shared == 0) continue;
      const unsigned farther = bits(load(scratch_.u_in + 16 * other) > u_in) & shared;
      if (farther != 0) first = at;
      unsettled &= ~(shared & ~farther);  // on these rays all that stand before are nearer still
    }
    Lanes nearest_moved = select(lanes, u_in, Lanes(3e38F));
    std::uint32_t kept = first;
    std::uint32_t moved = 0;
    bool cyclic = false;
    for (std::uint32_t at = first; at + 1 < count_; ++at) {
      const std::uint32_t other = scratch_.order[at];
      const Mask other_lanes = mask_of(scratch_.lanes[other]);
      const Lanes other_in = load(scratch_.u_in + 16 * other);
      if (any(other_lanes & (other_in > nearest_moved))) {
        cyclic |= any(other_lanes & lanes & (other_in < u_in));
        nearest_moved = select(other_lanes, min(other_in, nearest_moved), nearest_moved);
        scratch_.moved[moved++] = other;
      } else {
        scratch_.order[kept++] = other;
      }
    }
    scratch_.order[kept++] = added;
    for (std::uint32_t i = 0; i < moved; ++i) scratch_.order[kept++] = scratch_.moved[i];
    return !cyclic;
  }

  const BlockScratch& scratch_;
  std::uint32_t count_ = 0;
  Lanes last_{-3e38F};
};

// Every cell's light on its own, composed ray by ray in the ray's own order: right for any set of cells.
static void compose_ray_by_ray(const Integrator& integrator, Layers& layers, const BlockScratch& scratch,
                               std::uint32_t count, float* rgba) {
  for (std::uint32_t n = 0; n < count; ++n) {
    Light light;
    integrator.compose(scratch.record[n], load(scratch.u_in + 16 * n), load(scratch.u_out + 16 * n), scratch.lanes[n],
                       light);
    store(scratch.light + 64 * n, light.red);
    store(scratch.light + 64 * n + 16, light.green);
    store(scratch.light + 64 * n + 32, light.blue);
    store(scratch.light + 64 * n + 48, light.through);
  }
  for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
    std::uint32_t met = 0;
    for (std::uint32_t n = 0; n < count; ++n) {
      if ((scratch.lanes[n] >> lane & 1) == 0) continue;
      const float depth = scratch.u_in[16 * n + lane];
      std::uint32_t at = met++;
      for (; at > 0 && scratch.u_in[16 * scratch.order[at - 1] + lane] > depth; --at) {
        scratch.order[at] = scratch.order[at - 1];
      }
      scratch.order[at] = n;
    }
    float sum[4] = {0.0F, 0.0F, 0.0F, 1.0F};
    for (std::uint32_t i = 0; i < met; ++i) {
      const std::uint32_t at = 16 * scratch.order[i] + lane;
      layers.lay_before(scratch.u_in[at], scratch.u_out[at], static_cast<int>(lane), sum);
      const float* light = scratch.light + 64 * scratch.order[i] + lane;
      for (int k = 0; k < 3; ++k) sum[k] += sum[3] * light[16 * k];
      sum[3] *= light[48];
    }
    layers.lay_rest(static_cast<int>(lane), sum);
    for (int k = 0; k < 3; ++k) rgba[4 * lane + k] = sum[k];
    rgba[4 * lane + 3] = 1.0F - sum[3];
  }
}

// A block's cells lie scattered over its tile's records: their cache lines are asked for a few cells ahead.
constexpr std::uint32_t prefetch_ahead = 4;

template <class Record>
static inline void prefetch(const Record& record) {
  const char* bytes = reinterpret_cast<const char*>(&record);
  for (std::size_t at = 0; at < sizeof(Record); at += 64) __builtin_prefetch(bytes + at);
}

static std::uint64_t draw_block(const View& view, const CellOptics& optics, const BlockInput& block,
                                const BlockScratch& scratch, float* rgba) {
  float columns[lane_count];
  float rows[lane_count];
  for (int i = 0; i < lane_count; ++i) {
    columns[i] = static_cast<float>(block.column + i % block_side);
    rows[i] = static_cast<float>(block.row + i / block_side);
  }
  const Pixels pixels{load(columns), load(rows)};
  const Lanes nearest(view.nearest);
  const Lanes farthest(view.farthest);

  Order order(scratch);
  bool cyclic = false;
  std::uint32_t count = 0;
  for (std::size_t n = 0; n < block.count; ++n) {
    const std::uint32_t record = block.cells[n];
    const CellPlanes& p = block.planes[record];
    if (n + prefetch_ahead < block.count) prefetch(block.planes[block.cells[n + prefetch_ahead]]);
    Lanes u_in = max(nearest, affine(pixels, p.in_a[0], p.in_b[0], p.in_c[0]));
    u_in = max(u_in, affine(pixels, p.in_a[1], p.in_b[1], p.in_c[1]));
    u_in = max(u_in, affine(pixels, p.in_a[2], p.in_b[2], p.in_c[2]));
    Lanes u_out = min(farthest, affine(pixels, p.out_a[0], p.out_b[0], p.out_c[0]));
    u_out = min(u_out, affine(pixels, p.out_a[1], p.out_b[1], p.out_c[1]));
    u_out = min(u_out, affine(pixels, p.out_a[2], p.out_b[2], p.out_c[2]));
    if (p.out_count == 4) u_out = min(u_out, affine(pixels, p.out_a[3], p.out_b[3], p.out_c[3]));
    const Mask lanes = u_in < u_out;
    const unsigned met = bits(lanes);
    if (met == 0) continue;
    store(scratch.u_in + 16 * count, u_in);
    store(scratch.u_out + 16 * count, u_out);
    scratch.lanes[count] = static_cast<std::uint16_t>(met);
    scratch.record[count] = record;
    if (!cyclic) cyclic = !order.add(count, u_in, lanes);
    ++count;
  }

  const Integrator integrator(view, optics, block, pixels);
  Layers layers(optics, block);
  std::uint64_t steps = 0;
  if (cyclic) {
    for (std::uint32_t n = 0; n < count; ++n) steps += static_cast<unsigned>(__builtin_popcount(scratch.lanes[n]));
    compose_ray_by_ray(integrator, layers, scratch, count, rgba);
    return steps;
  }
  Light light;
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t next = scratch.order[n];
    const unsigned lanes = scratch.lanes[next];
    if (n + prefetch_ahead < count) prefetch(block.values[scratch.record[scratch.order[n + prefetch_ahead]]]);
    steps += static_cast<unsigned>(__builtin_popcount(lanes));
    const Lanes u_in = load(scratch.u_in + 16 * next);
    const Lanes u_out = load(scratch.u_out + 16 * next);
    layers.lay_before(u_in, u_out, lanes, light);
    integrator.compose(scratch.record[next], u_in, u_out, lanes, light);
    if (!any(light.through > Lanes(opaque_enough))) break;
  }
  layers.lay_rest(light);
  alignas(64) float channels[4][lane_count];
  store(channels[0], light.red);
  store(channels[1], light.green);
  store(channels[2], light.blue);
  store(channels[3], Lanes(1.0F) - light.through);
  for (int i = 0; i < lane_count; ++i) {
    for (int k = 0; k < 4; ++k) rgba[4 * i + k] = channels[k][i];
  }
  return steps;
}

}  // namespace atomesh::ATOMESH_ISA
