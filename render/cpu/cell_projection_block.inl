// A block of 4×4 pixels: which cells its rays meet, in which order, and what they add up to. Included by the kernels'
// sources after cell_projection_layers.inl.

namespace atomesh::ATOMESH_ISA {

constexpr std::uint32_t all_of_them = (1U << lane_count) - 1;

// Of two cells that a ray meets, that which begins first comes first; of two that begin at the same depth, that of the
// lower record.
//
// Keeps `order`, the block's cells so far, sorted so that on every ray they stand in this order.
class Order {
 public:
  // Adds the cell `added`, of which there are that many already, with its depths in the scratch, and which meets the
  // rays `lanes`; if there are none, the next one takes its place. False when the cells overlap in a cycle, so that no
  // order is right for all of the block's rays; the cell is then last.
  bool add(const BlockScratch& scratch, std::uint32_t added, const Lanes& u_in, const Mask& lanes) {
    // Where two begin at the same depth, it takes a closer look.
    const Mask wrong = lanes & !(u_in > last_);
    last_ = select(lanes, max(u_in, last_), last_);
    scratch.order[added] = added;
    return !any(wrong) || move_forward(scratch, added, u_in, lanes, bits(wrong));
  }

 private:
  // The added cell belongs before some earlier ones. Those of them that must follow it (directly or because they follow
  // one that must) move behind it in their present order; the others keep their place.
  static __attribute__((noinline)) bool move_forward(const BlockScratch& scratch, std::uint32_t added, Lanes u_in,
                                                     Mask lanes, unsigned unsettled) {
    const std::uint32_t record = scratch.record[added];
    std::uint32_t first = added;
    for (std::uint32_t at = added; at-- > 0 && unsettled != 0;) {
      const std::uint32_t other = scratch.order[at];
      const unsigned shared = scratch.lanes[other] & unsettled;
      if (shared == 0) continue;
      const Lanes other_in = load(scratch.u_in + 16 * other);
      const unsigned farther = bits(scratch.record[other] > record ? !(other_in < u_in) : other_in > u_in) & shared;
      if (farther != 0) first = at;
      unsettled &= ~(shared & ~farther);  // on these rays all that stand before are nearer still
    }
    if (first == added) return true;
    // Cells that begin where a moved one does are moved too, whether they must or not: at worst an order that there is
    // is not found.
    Lanes nearest_moved = select(lanes, u_in, Lanes(3e38F));
    std::uint32_t kept = first;
    std::uint32_t moved = 0;
    bool cyclic = false;
    for (std::uint32_t at = first; at < added; ++at) {
      const std::uint32_t other = scratch.order[at];
      const Mask other_lanes = mask_of(scratch.lanes[other] & all_of_them);
      const Lanes other_in = load(scratch.u_in + 16 * other);
      if (any(other_lanes & !(other_in < nearest_moved))) {
        cyclic |= any(other_lanes & lanes & (scratch.record[other] > record ? other_in < u_in : !(other_in > u_in)));
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

// Lays one cell behind what is in `light`, and the layers before it.
template <class Integrator>
static inline void compose(const Integrator& integrator, Layers& layers, std::uint32_t record, const Lanes& u_in,
                           const Lanes& u_out, unsigned lanes, Light& light) {
  layers.lay_before(u_in, u_out, lanes, light);
  if constexpr (Integrator::prepares) {
    typename Integrator::Prepared prepared;
    integrator.prepare(record, u_in, u_out, prepared);
    integrator.lay(record, prepared, light);
  } else {
    integrator.compose(record, u_in, u_out, light);
  }
  finish_opaque(light);
}

// Cells that overlap in a cycle: each ray's in the ray's own order, those that are next on several rays at once.
// Returns the steps.
template <class Integrator>
static __attribute__((noinline)) std::uint64_t compose_cyclic(const Integrator& integrator, Layers& layers,
                                                              const BlockScratch& scratch, std::uint32_t count,
                                                              Light& result) {
  std::uint32_t end[lane_count];
  std::uint32_t next[lane_count];
  for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
    std::uint32_t* const list = scratch.by_ray + lane * count;
    std::uint32_t met = 0;
    for (std::uint32_t n = 0; n < count; ++n) {
      if ((scratch.lanes[n] >> lane & 1) == 0) continue;
      const float depth = scratch.u_in[16 * n + lane];
      std::uint32_t at = met++;
      for (; at > 0; --at) {
        const std::uint32_t before = list[at - 1];
        const float other = scratch.u_in[16 * before + lane];
        if (other < depth || (other == depth && scratch.record[before] < scratch.record[n])) break;
        list[at] = before;
      }
      list[at] = n;
    }
    next[lane] = lane * count;
    end[lane] = next[lane] + met;
  }
  Light light = result;
  std::uint64_t steps = 0;
  for (std::uint32_t first = 0; first < lane_count;) {
    if (next[first] == end[first]) {
      ++first;
      continue;
    }
    const std::uint32_t n = scratch.by_ray[next[first]];
    unsigned lanes = 0;
    for (std::uint32_t lane = first; lane < lane_count; ++lane) {
      if (next[lane] == end[lane] || scratch.by_ray[next[lane]] != n) continue;
      lanes |= 1U << lane;
      ++next[lane];
    }
    const Lanes u_in = load(scratch.u_in + 16 * n);
    const Lanes u_out = select(mask_of(lanes), load(scratch.u_out + 16 * n), u_in);
    compose(integrator, layers, scratch.record[n], u_in, u_out, lanes, light);
    steps += static_cast<unsigned>(__builtin_popcount(lanes));
  }
  result = light;
  return steps;
}

// A block's cells lie scattered over its tile's records: their cache lines are asked for a few cells ahead.
constexpr std::uint32_t planes_ahead = 24;
constexpr std::uint32_t values_ahead = 16;

// Always inlined, as whatever else does nothing but prefetch: GCC leaves calls of such functions out, having found that
// they change nothing.
template <class Record>
static inline __attribute__((always_inline)) void prefetch(const Record& record) {
  const char* bytes = reinterpret_cast<const char*>(&record);
  for (std::size_t at = 0; at < sizeof(Record); at += 64) __builtin_prefetch(bytes + at);
}

// Where a cell begins and ends on the block's rays: on those that meet it, u_in < u_out. Of its faces the ray enters by
// the first and leaves by the last.
static inline void clip(const Lanes* u, unsigned entries, const Lanes& nearest, const Lanes& farthest, Lanes& u_in,
                        Lanes& u_out) {
  constexpr float far = 3e38F;
  static constexpr float enters[4][2] = {{-far, -far}, {-far, -far}, {far, -far}, {far, far}};
  const Lanes second(enters[entries][0]);
  const Lanes third(enters[entries][1]);
  u_in = max(max(nearest, u[0]), max(min(u[1], second), min(u[2], third)));
  u_out = min(min(farthest, u[3]), min(max(u[1], second), max(u[2], third)));
}

// Of a cell that has a refinement.
struct Crossing {
  Lanes u_in, u_out;
};
static __attribute__((noinline, flatten)) Crossing cross_refined(const CellPlanes& p, const CellRefinement& r,
                                                                 const Pixels& pixels, Lanes nearest, Lanes farthest) {
  Lanes u[4];
  for (int k = 0; k < 4; ++k) {
    u[k] = affine(pixels, p.a[k], p.b[k], p.c[k]) + affine(pixels, r.a[k], r.b[k], r.c[k]);
  }
  Crossing crossing;
  clip(u, p.entries, nearest, farthest, crossing.u_in, crossing.u_out);
  if (p.entries == 0) {
    crossing.u_in = nearest;
    crossing.u_out = min(u[0], crossing.u_out);
  }
  return crossing;
}

// Lanes of the block within the cell's box: columns and rows as sets of the tile's.
static inline unsigned in_box(const CellPlanes& p, int column, int row) {
  constexpr std::uint16_t spread[16] = {0x0000, 0x000F, 0x00F0, 0x00FF, 0x0F00, 0x0F0F, 0x0FF0, 0x0FFF,
                                        0xF000, 0xF00F, 0xF0F0, 0xF0FF, 0xFF00, 0xFF0F, 0xFFF0, 0xFFFF};
  return ((p.columns >> column) & 15U) * 0x1111U & spread[(p.rows >> row) & 15U];
}

// Notes the cells that meet a ray of the block, and their order. False when they overlap in a cycle.
static __attribute__((noinline, flatten)) bool cross_cells(const View& view, const BlockInput& block,
                                                           const Pixels& rays, const BlockScratch& lists,
                                                           std::uint32_t& met_cells) {
  const Pixels pixels = rays;
  float* const all_in = lists.u_in;
  float* const all_out = lists.u_out;
  std::uint32_t* const all_lanes = lists.lanes;
  std::uint32_t* const records = lists.record;
  const Lanes nearest(view.nearest);
  const Lanes farthest = block.farthest != nullptr ? load(block.farthest) : Lanes(view.farthest);
  const std::uint32_t* const cells = block.cells;
  const CellPlanes* const planes = block.planes;
  const CellRefinement* const refinements = block.refinements;
  const std::size_t cell_count = block.count;
  const int column = block.column;
  const int row = block.row;
  Order order;
  bool sorted = true;
  std::uint32_t count = 0;
  for (std::size_t n = 0; n < cell_count; ++n) {
    const std::uint32_t record = cells[n];
    if (n + planes_ahead < cell_count) {
      prefetch(planes[cells[n + planes_ahead]]);
      // A second part where there is one, and else what is there already.
      const std::uint32_t near = cells[n + planes_ahead / 2];
      __builtin_prefetch(planes[near].refined ? static_cast<const void*>(refinements + near) : planes + near);
    }
    const CellPlanes& p = planes[record];
    Lanes u_in;
    Lanes u_out;
    if (p.refined) {
      const Crossing crossing = cross_refined(p, refinements[record], pixels, nearest, farthest);
      u_in = crossing.u_in;
      u_out = crossing.u_out;
    } else {
      const Lanes u[4] = {affine(pixels, p.a[0], p.b[0], p.c[0]), affine(pixels, p.a[1], p.b[1], p.c[1]),
                          affine(pixels, p.a[2], p.b[2], p.c[2]), affine(pixels, p.a[3], p.b[3], p.c[3])};
      clip(u, p.entries, nearest, farthest, u_in, u_out);
    }
    const Mask lanes = mask_of(in_box(p, column, row)) & (u_in < u_out);
    const unsigned met = bits(lanes);
    // Which cells meet a ray follows no pattern that a branch could learn: every cell is noted, and those that meet
    // none are overwritten by the next.
    store(all_in + 16 * count, select(lanes, u_in, Lanes(0.0F)));
    store(all_out + 16 * count, select(lanes, u_out, Lanes(0.0F)));
    all_lanes[count] = met | (met | (p.wild ? all_of_them : 0U)) << lane_count;
    records[count] = record;
    if (sorted) sorted = order.add(lists, count, u_in, lanes);
    count += (0U - met) >> 31U;
  }
  met_cells = count;
  return sorted;
}

// Segments are prepared for so many cells at a time before they are laid: which way each then goes depends on nothing
// that has yet to be computed.
constexpr std::uint32_t cells_prepared = 16;

// Cells in the order that cross_cells() found, of a block without layers, by an integrator that prepares. Returns the
// steps.
template <class Integrator>
static __attribute__((noinline, flatten)) std::uint64_t compose_prepared(const Integrator& integrator,
                                                                         const BlockScratch& scratch,
                                                                         std::uint32_t count, Light& result) {
  typename Integrator::Prepared prepared[cells_prepared];
  Light light = result;
  std::uint64_t steps = 0;
  bool open = true;
  for (std::uint32_t n = 0; n < count && open;) {
    const std::uint32_t end = n + cells_prepared < count ? n + cells_prepared : count;
    for (std::uint32_t at = n; at < end; ++at) {
      const std::uint32_t next = scratch.order[at];
      if (at + values_ahead < count) prefetch(integrator.record(scratch.record[scratch.order[at + values_ahead]]));
      integrator.prepare(scratch.record[next], load(scratch.u_in + 16 * next), load(scratch.u_out + 16 * next),
                         prepared[at - n]);
    }
    for (const typename Integrator::Prepared* from = prepared; n < end && open; ++n, ++from) {
      const std::uint32_t next = scratch.order[n];
      steps += static_cast<unsigned>(__builtin_popcount(scratch.lanes[next] & all_of_them));
      integrator.lay(scratch.record[next], *from, light);
      finish_opaque(light);
      open = any(light.through > Lanes(0.0F));
    }
  }
  result = light;
  return steps;
}

// The next `together` cells of the order, which share no ray.
template <int together, class Integrator>
static inline void compose_together(const Integrator& integrator, Layers& layers, const BlockScratch& scratch,
                                    const std::uint32_t* next, unsigned lanes, Light& light) {
  std::uint32_t records[together];
  Mask rays[together];
  Lanes u_in = load(scratch.u_in + 16 * next[0]);
  Lanes u_out = load(scratch.u_out + 16 * next[0]);
  for (int n = 0; n < together; ++n) {
    records[n] = scratch.record[next[n]];
    rays[n] = mask_of(scratch.lanes[next[n]] & all_of_them);
    if (n == 0) continue;
    u_in = select(rays[n], load(scratch.u_in + 16 * next[n]), u_in);
    u_out = select(rays[n], load(scratch.u_out + 16 * next[n]), u_out);
  }
  layers.lay_before(u_in, u_out, lanes, light);
  integrator.template lay<together>(records, rays, u_in, u_out, light);
  finish_opaque(light);
}

// Cells in their order; consecutive ones that share no ray at once, where the integrator can. Returns the steps.
template <class Integrator>
static inline std::uint64_t compose_in_order(const Integrator& integrator, Layers& layers, const BlockScratch& scratch,
                                             std::uint32_t count, Light& result) {
  Light light = result;
  std::uint64_t steps = 0;
  constexpr bool together = requires(const Mask* rays, const std::uint32_t* numbers, const Lanes& u, Light& l) {
    integrator.template lay<1>(numbers, rays, u, u, l);
  };
  for (std::uint32_t n = 0; n < count;) {
    const std::uint32_t* const next = scratch.order + n;
    const auto ahead = [&](std::uint32_t by) __attribute__((always_inline)) {
      if (n + by < count) prefetch(integrator.record(scratch.record[next[by]]));
    };
    if constexpr (!together) {
      const unsigned lanes = scratch.lanes[next[0]] & all_of_them;
      ahead(values_ahead);
      compose(integrator, layers, scratch.record[next[0]], load(scratch.u_in + 16 * next[0]),
              load(scratch.u_out + 16 * next[0]), lanes, light);
      steps += static_cast<unsigned>(__builtin_popcount(lanes));
      ++n;
    } else {
      // In the upper half of `lanes` stand the rays that a cell shares with none beside it.
      unsigned taken = scratch.lanes[next[0]];
      std::uint32_t size = 1;
      const std::uint32_t most = count - n < 4 ? count - n : 4;
      for (; size < most; ++size) {
        const unsigned added = scratch.lanes[next[size]];
        if ((added & taken) >> lane_count != 0) break;
        taken |= added;
      }
      const unsigned lanes = taken & all_of_them;
      for (std::uint32_t i = 0; i < size; ++i) ahead(values_ahead + i);
      switch (size) {
        case 1:
          compose_together<1>(integrator, layers, scratch, next, lanes, light);
          break;
        case 2:
          compose_together<2>(integrator, layers, scratch, next, lanes, light);
          break;
        case 3:
          compose_together<3>(integrator, layers, scratch, next, lanes, light);
          break;
        default:
          compose_together<4>(integrator, layers, scratch, next, lanes, light);
      }
      steps += static_cast<unsigned>(__builtin_popcount(lanes));
      n += size;
    }
    if (!any(light.through > Lanes(0.0F))) break;
  }
  result = light;
  return steps;
}

template <class Integrator>
static __attribute__((flatten)) std::uint64_t draw_block_with(const View& view, const CellOptics& optics,
                                                              const BlockInput& block, const BlockScratch& scratch,
                                                              float* rgba) {
  const PixelLattice& lattice = block.lattice;
  float columns[lane_count];
  float rows[lane_count];
  for (int i = 0; i < lane_count; ++i) {
    columns[i] = static_cast<float>(lattice.column_phase + (block.column + i % block_side) * lattice.column_stride -
                                    tile_middle);
    rows[i] = static_cast<float>(lattice.row_phase + (block.row + i / block_side) * lattice.row_stride - tile_middle);
  }
  const Pixels pixels{load(columns), load(rows)};
  std::uint32_t count = 0;
  const bool sorted = cross_cells(view, block, pixels, scratch, count);

  const Integrator integrator(view, optics, block, pixels);
  Layers layers(view, optics, block, integrator);
  std::uint64_t steps = 0;
  Light light;
  if (!sorted) {
    steps = compose_cyclic(integrator, layers, scratch, count, light);
  } else if constexpr (Integrator::prepares) {
    steps = compose_prepared(integrator, scratch, count, light);
  } else {
    steps = compose_in_order(integrator, layers, scratch, count, light);
  }
  layers.lay_rest(light);
  steps += layers.steps();
  alignas(64) float channels[4][lane_count];
  store(channels[0], light.red);
  store(channels[1], light.green);
  store(channels[2], light.blue);
  store(channels[3], min(light.covered, Lanes(1.0F)));
  for (int i = 0; i < lane_count; ++i) {
    for (int k = 0; k < 4; ++k) rgba[4 * i + k] = channels[k][i];
  }
  return steps;
}

static std::uint64_t draw_block(const View& view, const CellOptics& optics, const BlockInput& block,
                                const BlockScratch& scratch, float* rgba) {
  return with_integrator(optics, [&](auto chosen) {
    return draw_block_with<typename decltype(chosen)::type>(view, optics, block, scratch, rgba);
  });
}

}  // namespace atomesh::ATOMESH_ISA
