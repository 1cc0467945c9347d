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

// Which of the tile's blocks a cell may cover, sixteen at a time: four rows of four.
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
    width_ = column_stride * block_side;
    height_ = row_stride * block_side;
    first_column_ = static_cast<float>(lattice.column_phase) + half_width_;
    first_row_ = static_cast<float>(lattice.row_phase) + half_height_;
    float columns[lane_count];
    float rows[lane_count];
    for (int i = 0; i < lane_count; ++i) {
      columns[i] = width_ * static_cast<float>(i % side);
      rows[i] = height_ * static_cast<float>(i / side);
    }
    column_ = load(columns);
    row_ = load(rows);
  }

  // A ray meets the cell where each face it leaves by is farther than each it enters by. Along a face's outline that is
  // a straight line, and a block on the wrong side of one of the lines is not met. Faces first those entered by, of
  // which there are `entries`, 1 to 3. What rounding may hide is added, here and where the rays are intersected.
  // Of the blocks `candidates`, which lie in columns left … right and rows top … bottom.
  BlockSet blocks(const F4& a, const F4& b, const F4& c, int entries, int left, int right, int top, int bottom,
                  BlockSet candidates) const {
    const FacePairs& pairs = face_pairs[entries];
    const F4 slope_a = __builtin_shuffle(a, pairs.out) - __builtin_shuffle(a, pairs.in);
    const F4 slope_b = __builtin_shuffle(b, pairs.out) - __builtin_shuffle(b, pairs.in);
    const F4 reach =
        magnitude(a) * static_cast<float>(tile_side) + magnitude(b) * static_cast<float>(tile_side) + magnitude(c);
    const F4 rounding = 1e-6F * (__builtin_shuffle(reach, pairs.out) + __builtin_shuffle(reach, pairs.in));
    const F4 offset = __builtin_shuffle(c, pairs.out) - __builtin_shuffle(c, pairs.in) + rounding +
                      half_width_ * magnitude(slope_a) + half_height_ * magnitude(slope_b);
    BlockSet set = 0;
    for (int row = top; row <= bottom; row += side) {
      for (int column = left; column <= right; column += side) {
        const float at_column = first_column_ + width_ * static_cast<float>(column);
        const float at_row = first_row_ + height_ * static_cast<float>(row);
        set |= sixteen(slope_a, slope_b, offset + at_column * slope_a + at_row * slope_b)
               << (blocks_per_side * row + column);
      }
    }
    return set & candidates;
  }

 private:
  static constexpr int side = 4;

  // As blocks of the tile's first four rows and columns.
  BlockSet sixteen(const F4& slope_a, const F4& slope_b, const F4& offset) const {
    Lanes least(3e38F);
    for (int k = 0; k < 4; ++k) {
      least = min(least, multiply_add(Lanes(slope_b[k]), row_,
                                      multiply_add(Lanes(slope_a[k]), column_, Lanes(offset[k]))));
    }
    const auto met = static_cast<BlockSet>(bits(least > Lanes(0.0F)));
    return (met & 0x000FU) | (met & 0x00F0U) << 4 | (met & 0x0F00U) << 8 | (met & 0xF000U) << 12;
  }

  float half_width_, half_height_;  // of a block
  float width_, height_;            // from one to the next
  float first_column_, first_row_;  // the first one's middle
  Lanes column_;                    // of the lanes, from the first one
  Lanes row_;
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
