// A block of 4×4 pixels: which cells its rays meet, in which order, and what they add up to. Included by the kernels'
// sources after cell_projection_layers.inl.

namespace atomesh::ATOMESH_ISA {

// Keeps `order`, the block's cells so far, sorted so that on every ray nearer segments stand before farther ones.
class Order {
 public:
  // Adds the cell `added`, of which there are that many already, with its depths in the scratch, and which meets the
  // rays `lanes`; if there are none, the next one takes its place. False when the cells overlap in a cycle, so that no
  // order is right for all of the block's rays; the cell is then last.
  bool add(const BlockScratch& scratch, std::uint32_t added, const Lanes& u_in, const Mask& lanes) {
    const Mask wrong = lanes & (u_in < last_);
    last_ = select(lanes, max(u_in, last_), last_);
    scratch.order[added] = added;
    return !any(wrong) || move_forward(scratch, added, u_in, lanes, bits(wrong));
  }

 private:
  // The added cell belongs before some earlier ones. Those of them that must follow it (directly or because they follow
  // one that must) move behind it in their present order; the others keep their place.
  static __attribute__((noinline)) bool move_forward(const BlockScratch& scratch, std::uint32_t added, Lanes u_in,
                                                     Mask lanes, unsigned unsettled) {
    std::uint32_t first = added;
    for (std::uint32_t at = added; at-- > 0 && unsettled != 0;) {
      const std::uint32_t other = scratch.order[at];
      const unsigned shared = scratch.lanes[other] & unsettled;
      if (shared == 0) continue;
      const unsigned farther = bits(load(scratch.u_in + 16 * other) > u_in) & shared;
      if (farther != 0) first = at;
      unsettled &= ~(shared & ~farther);  // on these rays all that stand before are nearer still
    }
    Lanes nearest_moved = select(lanes, u_in, Lanes(3e38F));
    std::uint32_t kept = first;
    std::uint32_t moved = 0;
    bool cyclic = false;
    for (std::uint32_t at = first; at < added; ++at) {
      const std::uint32_t other = scratch.order[at];
      const Mask other_lanes = mask_of(scratch.lanes[other]);
      const Lanes other_in = load(scratch.u_in + 16 * other);
      if (any(other_lanes & (other_in > nearest_moved))) {
        cyclic |= any(other_lanes & lanes & (other_in < u_in));
        nearest_moved = select(other_lanes, min(other_in, nearest_moved), nearest_moved);
        scratch.moved[moved++] = other;
      } else {
        scratch.order[kept++] = other;
      }
    }
    scratch.order[kept++] = added;
    for (std::uint32_t i = 0; i < moved; ++i) scratch.order[kept++] = scratch.moved[i];
    return !cyclic;
  }

  Lanes last_{-3e38F};
};

// Every cell's light on its own, composed ray by ray in the ray's own order: right for any set of cells.
template <class Integrator>
static __attribute__((noinline)) void compose_ray_by_ray(const Integrator& integrator, Layers& layers,
                                                         const BlockScratch& scratch, std::uint32_t count,
                                                         float* rgba) {
  for (std::uint32_t n = 0; n < count; ++n) {
    Light light;
    integrator.compose(scratch.record[n], load(scratch.u_in + 16 * n), load(scratch.u_out + 16 * n), light);
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
constexpr std::uint32_t planes_ahead = 12;
constexpr std::uint32_t values_ahead = 6;

template <class Record>
static inline void prefetch(const Record& record) {
  const char* bytes = reinterpret_cast<const char*>(&record);
  for (std::size_t at = 0; at < sizeof(Record); at += 64) __builtin_prefetch(bytes + at);
}

// Where a cell begins and ends on the block's rays: on those that meet it, u_in < u_out.
static inline void cross(const CellPlanes& p, const Pixels& pixels, const Lanes& nearest, const Lanes& farthest,
                         Lanes& u_in, Lanes& u_out) {
  const Lanes u0 = affine(pixels, p.a[0], p.b[0], p.c[0]);
  const Lanes u1 = affine(pixels, p.a[1], p.b[1], p.c[1]);
  const Lanes u2 = affine(pixels, p.a[2], p.b[2], p.c[2]);
  const Lanes u3 = affine(pixels, p.a[3], p.b[3], p.c[3]);
  const Lanes enters1(p.enters[0]);
  const Lanes enters2(p.enters[1]);
  u_in = max(max(nearest, u0), max(min(u1, enters1), min(u2, enters2)));
  u_out = min(min(farthest, u3), min(max(u1, enters1), max(u2, enters2)));
  if (p.eye_inside != 0) {
    u_in = nearest;
    u_out = min(u0, u_out);
  }
}

// Notes the cells that meet a ray of the block, and their order. False when they overlap in a cycle.
static __attribute__((noinline, flatten)) bool cross_cells(const View& view, const BlockInput& block,
                                                           const Pixels& rays, const BlockScratch& lists,
                                                           std::uint32_t& met_cells) {
  const Pixels pixels = rays;
  const BlockScratch scratch = lists;
  const Lanes nearest(view.nearest);
  const Lanes farthest(view.farthest);
  const std::uint32_t* const cells = block.cells;
  const CellPlanes* const planes = block.planes;
  const std::size_t cell_count = block.count;
  Order order;
  bool sorted = true;
  std::uint32_t count = 0;
  for (std::size_t n = 0; n < cell_count; ++n) {
    const std::uint32_t record = cells[n];
    if (n + planes_ahead < cell_count) prefetch(planes[cells[n + planes_ahead]]);
    Lanes u_in;
    Lanes u_out;
    cross(planes[record], pixels, nearest, farthest, u_in, u_out);
    const Mask lanes = u_in < u_out;
    const unsigned met = bits(lanes);
    // Which cells meet a ray follows no pattern that a branch could learn: every cell is noted, and those that meet
    // none are overwritten by the next.
    store(scratch.u_in + 16 * count, u_in);
    store(scratch.u_out + 16 * count, u_out);
    scratch.lanes[count] = static_cast<std::uint16_t>(met);
    scratch.record[count] = record;
    if (sorted) sorted = order.add(scratch, count, u_in, lanes);
    count += (0U - met) >> 31U;
  }
  met_cells = count;
  return sorted;
}

template <class Integrator>
static __attribute__((flatten)) std::uint64_t draw_block_with(const View& view, const CellOptics& optics,
                                                              const BlockInput& block, const BlockScratch& scratch,
                                                              float* rgba) {
  float columns[lane_count];
  float rows[lane_count];
  for (int i = 0; i < lane_count; ++i) {
    columns[i] = static_cast<float>(block.column + i % block_side);
    rows[i] = static_cast<float>(block.row + i / block_side);
  }
  const Pixels pixels{load(columns), load(rows)};
  std::uint32_t count = 0;
  const bool sorted = cross_cells(view, block, pixels, scratch, count);

  const Integrator integrator(view, optics, block, pixels);
  Layers layers(optics, block);
  std::uint64_t steps = 0;
  if (!sorted) {
    for (std::uint32_t n = 0; n < count; ++n) steps += static_cast<unsigned>(__builtin_popcount(scratch.lanes[n]));
    compose_ray_by_ray(integrator, layers, scratch, count, rgba);
    return steps;
  }
  Light light;
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t next = scratch.order[n];
    const unsigned lanes = scratch.lanes[next];
    if (n + values_ahead < count) prefetch(integrator.record(scratch.record[scratch.order[n + values_ahead]]));
    steps += static_cast<unsigned>(__builtin_popcount(lanes));
    const Lanes u_in = load(scratch.u_in + 16 * next);
    const Lanes u_out = load(scratch.u_out + 16 * next);
    layers.lay_before(u_in, u_out, lanes, light);
    integrator.compose(scratch.record[next], u_in, u_out, light);
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

static std::uint64_t draw_block(const View& view, const CellOptics& optics, const BlockInput& block,
                                const BlockScratch& scratch, float* rgba) {
  return optics.map == nullptr ? draw_block_with<ColorIntegrator>(view, optics, block, scratch, rgba)
                               : draw_block_with<ScalarIntegrator>(view, optics, block, scratch, rgba);
}

}  // namespace atomesh::ATOMESH_ISA
