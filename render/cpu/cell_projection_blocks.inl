// Which blocks of its tile a cell may cover. Included by the kernels' sources after lanes.h.

namespace atomesh::ATOMESH_ISA {

using namespace cell_projection;

typedef float F4 __attribute__((vector_size(16)));
typedef std::int32_t I4 __attribute__((vector_size(16)));

static inline void store4(float* target, const F4& v) {
  __builtin_memcpy(target, &v, sizeof v);
}

// In one instruction, where the compiler's own would be three.
static inline F4 magnitude(const F4& v) {
#if defined(__SSE2__)
  return _mm_andnot_ps(_mm_set1_ps(-0.0F), v);
#else
  return v < 0.0F ? -v : v;
#endif
}
static inline F4 multiply_add(const F4& a, const F4& b, const F4& c) {
#if defined(__FMA__)
  return _mm_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}
static inline F4 all_of(float v) {
#if defined(__SSE2__)
  return _mm_set1_ps(v);
#else
  return F4{v, v, v, v};
#endif
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
    half_width_ = middle * static_cast<float>(lattice.column_stride);
    half_height_ = middle * static_cast<float>(lattice.row_stride);
    for (int i = 0; i < blocks_per_side; ++i) {
      column_[i] =
          static_cast<float>(lattice.column_phase + block_side * i * lattice.column_stride - tile_middle) + half_width_;
      row_[i] =
          static_cast<float>(lattice.row_phase + block_side * i * lattice.row_stride - tile_middle) + half_height_;
    }
    float columns[lane_count];
    float rows[lane_count];
    for (int i = 0; i < lane_count; ++i) {
      columns[i] = column_[i % side] - column_[0];
      rows[i] = row_[i / side] - row_[0];
    }
    across_ = load(columns);
    down_ = load(rows);
  }

  // A ray meets the cell where each face it leaves by is farther than each it enters by. Along a face's outline that is
  // a straight line, and a block on the wrong side of one of the lines is not met. Faces first those entered by, of
  // which there are `entries`, 1 to 3. `rounding`, what it may hide, is added, here and where the rays are intersected.
  // Of the blocks `candidates`, which lie in columns left … right and rows top … bottom.
  BlockSet blocks(const F4& a, const F4& b, const F4& c, int entries, float rounding, int left, int right, int top,
                  int bottom, BlockSet candidates) const {
    const FacePairs& pairs = face_pairs[entries];
    const F4 slope_a = __builtin_shuffle(a, pairs.out) - __builtin_shuffle(a, pairs.in);
    const F4 slope_b = __builtin_shuffle(b, pairs.out) - __builtin_shuffle(b, pairs.in);
    const F4 offset =
        multiply_add(all_of(half_width_), magnitude(slope_a),
                     multiply_add(all_of(half_height_), magnitude(slope_b),
                                  (__builtin_shuffle(c, pairs.out) - __builtin_shuffle(c, pairs.in)) + rounding));
    const BlockSet set = right - left < side && bottom - top < side
                             ? sixteen(slope_a, slope_b, offset, left, top)
                             : more_blocks(slope_a, slope_b, offset, left, right, top, bottom);
    return set & candidates;
  }

 private:
  static constexpr int side = 4;

  // Those of four columns and rows, and maybe others: in the columns left of `left`, or above `top`.
  BlockSet sixteen(const F4& slope_a, const F4& slope_b, const F4& offset, int left, int top) const {
    alignas(16) float a[4];
    alignas(16) float b[4];
    alignas(16) float c[4];
    store4(a, slope_a);
    store4(b, slope_b);
    store4(c, multiply_add(all_of(column_[left]), slope_a, multiply_add(all_of(row_[top]), slope_b, offset)));
    const auto line = [&](int k) {
      return multiply_add(Lanes(b[k]), down_, multiply_add(Lanes(a[k]), across_, Lanes(c[k])));
    };
    const Lanes least = min(min(line(0), line(1)), min(line(2), line(3)));
    const BlockSet met = bits(least > Lanes(0.0F));
    return ((met & 0x000FU) | (met & 0x00F0U) << 4 | (met & 0x0F00U) << 8 | (met & 0xF000U) << 12)
           << (blocks_per_side * top + left);
  }
  __attribute__((noinline)) BlockSet more_blocks(F4 slope_a, F4 slope_b, F4 offset, int left, int right, int top,
                                                 int bottom) const {
    BlockSet set = 0;
    for (int row = top; row <= bottom; row += side) {
      for (int column = left; column <= right; column += side) set |= sixteen(slope_a, slope_b, offset, column, row);
    }
    return set;
  }

  float half_width_, half_height_;  // of a block
  float column_[blocks_per_side];   // the blocks' middles
  float row_[blocks_per_side];
  Lanes across_;  // the lanes' blocks, from the first one
  Lanes down_;
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
