// Which blocks of its tile a cell may cover. Included by the kernels' sources after lanes.h.

namespace atomesh::ATOMESH_ISA {

using namespace cell_projection;

typedef float F4 __attribute__((vector_size(16)));
typedef std::int32_t I4 __attribute__((vector_size(16)));

static inline void store4(float* target, const F4& v) {
  __builtin_memcpy(target, &v, sizeof v);
}

static inline F4 magnitude(const F4& v) {
  return v < 0.0F ? -v : v;
}

// For each number of faces that a ray enters by: every pair of one of those and one that it leaves by.
struct FacePairs {
  I4 in;
  I4 out;
};
constexpr FacePairs face_pairs[5] = {{I4{0, 0, 0, 0}, I4{0, 1, 2, 3}},
                                     {I4{0, 0, 0, 0}, I4{1, 2, 3, 3}},
                                     {I4{0, 0, 1, 1}, I4{2, 3, 2, 3}},
                                     {I4{0, 1, 2, 2}, I4{3, 3, 3, 3}},
                                     {I4{0, 1, 2, 3}, I4{0, 0, 0, 0}}};

// Sixteen blocks of a tile, two rows of them, as lanes: which of the tile's blocks a cell may cover.
class BlockTest {
 public:
  explicit BlockTest(const PixelLattice& lattice) {
    static_assert(blocks_per_side == 8 && lane_count == 16);
    // Middle of a block's pixels, from its first, and how far they are apart.
    constexpr float middle = 0.5F * (block_side - 1);
    const auto column_stride = static_cast<float>(lattice.column_stride);
    const auto row_stride = static_cast<float>(lattice.row_stride);
    half_width_ = middle * column_stride;
    half_height_ = middle * row_stride;
    float place[lane_count];
    for (int i = 0; i < lane_count; ++i) {
      place[i] = static_cast<float>(lattice.column_phase) +
                 column_stride * (static_cast<float>(i % blocks_per_side * block_side) + middle);
    }
    column_ = load(place);
    for (int group = 0; group < groups; ++group) {
      for (int i = 0; i < lane_count; ++i) {
        const int row = 2 * group + i / blocks_per_side;
        place[i] = static_cast<float>(lattice.row_phase) + row_stride * (static_cast<float>(row * block_side) + middle);
      }
      row_[group] = load(place);
    }
  }

  // A ray meets the cell where each face it leaves by is farther than each it enters by. Along a face's outline that is
  // a straight line, and a block on the wrong side of one of the lines is not met. Faces first those entered by, of
  // which there are `entries`, 1 to 3. What rounding may hide is added, here and where the rays are intersected.
  // Of the blocks `candidates`.
  BlockSet blocks(const F4& a, const F4& b, const F4& c, int entries, BlockSet candidates) const {
    const FacePairs& pairs = face_pairs[entries];
    const F4 slope_a = __builtin_shuffle(a, pairs.out) - __builtin_shuffle(a, pairs.in);
    const F4 slope_b = __builtin_shuffle(b, pairs.out) - __builtin_shuffle(b, pairs.in);
    const F4 reach =
        magnitude(a) * static_cast<float>(tile_side) + magnitude(b) * static_cast<float>(tile_side) + magnitude(c);
    const F4 rounding = 1e-6F * (__builtin_shuffle(reach, pairs.out) + __builtin_shuffle(reach, pairs.in));
    const F4 offset = __builtin_shuffle(c, pairs.out) - __builtin_shuffle(c, pairs.in) + rounding +
                      half_width_ * magnitude(slope_a) + half_height_ * magnitude(slope_b);
    Lanes along[4];
    Lanes down[4];
    for (int k = 0; k < 4; ++k) {
      along[k] = multiply_add(Lanes(slope_a[k]), column_, Lanes(offset[k]));
      down[k] = Lanes(slope_b[k]);
    }
    BlockSet set = 0;
    for (int group = 0; group < groups; ++group) {
      if ((candidates >> (lane_count * group) & 0xFFFFU) == 0) continue;
      const Lanes least =
          min(min(multiply_add(down[0], row_[group], along[0]), multiply_add(down[1], row_[group], along[1])),
              min(multiply_add(down[2], row_[group], along[2]), multiply_add(down[3], row_[group], along[3])));
      const Mask met = least > Lanes(0.0F);
      set |= static_cast<BlockSet>(bits(met)) << (lane_count * group);
    }
    return set & candidates;
  }

 private:
  static constexpr int groups = blocks_per_tile / lane_count;

  float half_width_, half_height_;  // of a block
  Lanes column_;
  Lanes row_[groups];
};

// How many of the sets each block is in.
static inline void count_blocks(const BlockSet* sets, std::size_t sets_count, std::uint32_t* per_block) {
  constexpr int groups = blocks_per_tile / lane_count;
  Lanes count[groups] = {Lanes(0.0F), Lanes(0.0F), Lanes(0.0F), Lanes(0.0F)};
  for (std::size_t n = 0; n < sets_count; ++n) {
    for (int group = 0; group < groups; ++group) {
      const Mask in = mask_of(static_cast<unsigned>(sets[n] >> (lane_count * group)) & 0xFFFFU);
      count[group] = select(in, count[group] + Lanes(1.0F), count[group]);
    }
  }
  for (int group = 0; group < groups; ++group) {
    float found[lane_count];
    store(found, count[group]);
    for (int i = 0; i < lane_count; ++i) per_block[lane_count * group + i] = static_cast<std::uint32_t>(found[i]);
  }
}

}  // namespace atomesh::ATOMESH_ISA
