// Set-up of a tile's cells: double in, float about the tile out. Four lanes of doubles carry a cell's four faces, then
// its four attributes. Included by the kernels' sources after lanes.h.

namespace atomesh::ATOMESH_ISA {

using namespace cell_projection;

typedef double D4 __attribute__((vector_size(32)));
typedef float F4 __attribute__((vector_size(16)));
typedef std::int64_t L4 __attribute__((vector_size(32)));
typedef std::int32_t I4 __attribute__((vector_size(16)));

// For each set of faces (bit k: face k): its faces first, then the others.
struct FaceLists {
  I4 list[16];
};

constexpr FaceLists make_face_lists() {
  FaceLists lists{};
  for (int set = 0; set < 16; ++set) {
    int found = 0;
    int faces[4] = {0, 0, 0, 0};
    for (const int chosen : {1, 0}) {
      for (int k = 0; k < 4; ++k) {
        if ((set >> k & 1) == chosen) faces[found++] = k;
      }
    }
    lists.list[set] = I4{faces[0], faces[1], faces[2], faces[3]};
  }
  return lists;
}

constexpr FaceLists face_lists = make_face_lists();

#define ATOMESH_SPLAT(x) ((x)-D4{})
#define ATOMESH_SUM(v) ((v)[0] + (v)[1] + (v)[2] + (v)[3])
#define ATOMESH_STORE4(target, v) __builtin_memcpy(target, &(v), 16)

// Corners of a cell in ascending order of vertex index.
struct SortedCorners {
  Index vertex[4];
  bool odd;  // the permutation's parity
};

static inline SortedCorners sort_corners(const Index* corners) {
  SortedCorners s{{corners[0], corners[1], corners[2], corners[3]}, false};
  constexpr int network[5][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}};
  for (const auto& [i, j] : network) {
    const bool swap = s.vertex[j] < s.vertex[i];
    const Index vi = s.vertex[i];
    const Index vj = s.vertex[j];
    s.vertex[i] = swap ? vj : vi;
    s.vertex[j] = swap ? vi : vj;
    s.odd ^= swap;
  }
  return s;
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
  BlockTest() {
    static_assert(blocks_per_side == 8 && lane_count == 16);
    float column[lane_count];
    for (int i = 0; i < lane_count; ++i) column[i] = static_cast<float>(i % blocks_per_side * block_side) + middle;
    column_ = load(column);
    for (int group = 0; group < groups; ++group) {
      float row[lane_count];
      for (int i = 0; i < lane_count; ++i) {
        row[i] = static_cast<float>((2 * group + i / blocks_per_side) * block_side) + middle;
      }
      row_[group] = load(row);
    }
  }

  // A ray meets the cell where each face it leaves by is farther than each it enters by. Along a face's outline that is
  // a straight line, and a block on the wrong side of one of the lines is not met. Faces first those entered by, of
  // which there are `entries`, 1 to 3. What rounding may hide is added, here and where the rays are intersected.
  BlockSet blocks(const F4& a, const F4& b, const F4& c, int entries) {
    const FacePairs& pairs = face_pairs[entries];
    const F4 slope_a = __builtin_shuffle(a, pairs.out) - __builtin_shuffle(a, pairs.in);
    const F4 slope_b = __builtin_shuffle(b, pairs.out) - __builtin_shuffle(b, pairs.in);
    const F4 reach =
        magnitude(a) * static_cast<float>(tile_side) + magnitude(b) * static_cast<float>(tile_side) + magnitude(c);
    const F4 rounding = 1e-6F * (__builtin_shuffle(reach, pairs.out) + __builtin_shuffle(reach, pairs.in));
    const F4 offset = __builtin_shuffle(c, pairs.out) - __builtin_shuffle(c, pairs.in) + rounding +
                      middle * (magnitude(slope_a) + magnitude(slope_b));
    Lanes along[4];
    Lanes down[4];
    for (int k = 0; k < 4; ++k) {
      along[k] = multiply_add(Lanes(slope_a[k]), column_, Lanes(offset[k]));
      down[k] = Lanes(slope_b[k]);
    }
    BlockSet set = 0;
    for (int group = 0; group < groups; ++group) {
      const Lanes least =
          min(min(multiply_add(down[0], row_[group], along[0]), multiply_add(down[1], row_[group], along[1])),
              min(multiply_add(down[2], row_[group], along[2]), multiply_add(down[3], row_[group], along[3])));
      const Mask met = least > Lanes(0.0F);
      count_[group] = count_[group] + select(met, Lanes(1.0F), Lanes(0.0F));
      set |= static_cast<BlockSet>(bits(met)) << (lane_count * group);
    }
    return set;
  }

  BlockSet all_blocks() {
    for (Lanes& count : count_) count = count + Lanes(1.0F);
    return ~BlockSet{0};
  }

  // How many cells each block has been found for.
  void counts(std::uint32_t* per_block) const {
    for (int group = 0; group < groups; ++group) {
      float count[lane_count];
      store(count, count_[group]);
      for (int i = 0; i < lane_count; ++i) per_block[lane_count * group + i] = static_cast<std::uint32_t>(count[i]);
    }
  }

 private:
  static constexpr int groups = blocks_per_tile / lane_count;
  static constexpr float middle = 0.5F * (block_side - 1);  // of a block's pixels, from its first

  Lanes column_;
  Lanes row_[groups];
  Lanes count_[groups] = {Lanes(0.0F), Lanes(0.0F), Lanes(0.0F), Lanes(0.0F)};
};

static void setup(const View& view, const SetupInput& input, const SetupOutput& output) {
  const bool perspective = view.perspective;
  const double pixel = view.pixel;
  const double x0 = view.left + pixel * input.column;
  const double y0 = view.top - pixel * input.row;
  BlockTest test;
  for (std::size_t n = 0; n < input.count; ++n) {
    const Index cell = input.cells[n];
    // Corners, then what they name, are asked for some cells ahead.
    if (n + 16 < input.count) __builtin_prefetch(input.corners + 4 * static_cast<std::size_t>(input.cells[n + 16]));
    if (n + 8 < input.count) {
      const Index* ahead = input.corners + 4 * static_cast<std::size_t>(input.cells[n + 8]);
      for (int k = 0; k < 4; ++k) {
        __builtin_prefetch(input.vertices + 3 * static_cast<std::size_t>(ahead[k]));
        __builtin_prefetch(input.values + static_cast<std::size_t>(input.value_count) * ahead[k]);
      }
    }
    const SortedCorners corners = sort_corners(input.corners + 4 * static_cast<std::size_t>(cell));
    const double* p[4];
    for (int k = 0; k < 4; ++k) p[k] = input.vertices + 3 * static_cast<std::size_t>(corners.vertex[k]);
    const D4 x{p[0][0], p[1][0], p[2][0], p[3][0]};
    const D4 y{p[0][1], p[1][1], p[2][1], p[3][1]};
    const D4 z{p[0][2], p[1][2], p[2][2], p[3][2]};

    // Planes N·p = c of the faces opposite each corner, from their corners a < b < c.
    const L4 to_a{1, 0, 0, 0};
    const L4 to_b{2, 2, 1, 1};
    const L4 to_c{3, 3, 3, 2};
    const D4 ax = __builtin_shuffle(x, to_a);
    const D4 ay = __builtin_shuffle(y, to_a);
    const D4 az = __builtin_shuffle(z, to_a);
    const D4 bx = __builtin_shuffle(x, to_b) - ax;
    const D4 by = __builtin_shuffle(y, to_b) - ay;
    const D4 bz = __builtin_shuffle(z, to_b) - az;
    const D4 cx = __builtin_shuffle(x, to_c) - ax;
    const D4 cy = __builtin_shuffle(y, to_c) - ay;
    const D4 cz = __builtin_shuffle(z, to_c) - az;
    const D4 nx = by * cz - bz * cy;
    const D4 ny = bz * cx - bx * cz;
    const D4 nz = bx * cy - by * cx;
    const D4 constant = nx * ax + ny * ay + nz * az;

    // u(x, y) = (m - k (Nx x + Ny y)) / d + offset. A face that holds the eye (or is parallel to the rays) has d = 0: a
    // d of next to nothing then puts it before or behind everything, the same for both its cells.
    D4 d = perspective ? constant : nz;
    const D4 tiny = ATOMESH_SPLAT(1e-200);
    d = (d < tiny && d > -tiny) ? tiny : d;
    const double k = perspective ? view.reference : 1.0;
    const D4 m = perspective ? -view.reference * nz : constant;
    const D4 inverse = 1.0 / d;
    D4 a = -k * pixel * nx * inverse;
    D4 b = k * pixel * ny * inverse;
    D4 c = (m - k * (x0 * nx + y0 * ny)) * inverse + (perspective ? 1.0 : -view.reference);
    const D4 abs_a = a < 0.0 ? -a : a;
    const D4 abs_b = b < 0.0 ? -b : b;
    const D4 abs_c = c < 0.0 ? -c : c;
    D4 largest = abs_a > abs_b ? abs_a : abs_b;
    largest = largest > abs_c ? largest : abs_c;
    const D4 limit = ATOMESH_SPLAT(1e30);
    const D4 scale = largest > limit ? limit / largest : ATOMESH_SPLAT(1.0);
    a *= scale;
    b *= scale;
    c *= scale;

    // The ray enters by the faces whose outward normal looks back at it. Which way is outward follows from the order of
    // the corners alone, so that the cells at a face never disagree.
    const double turn = corners.odd ? -1.0 : 1.0;
    const D4 outward = D4{-1.0, 1.0, -1.0, 1.0} * turn;
    const L4 enters = (d * outward < 0.0);
    const unsigned entries =
        static_cast<unsigned>((enters[0] & 1) | (enters[1] & 2) | (enters[2] & 4) | (enters[3] & 8));
    if (entries == 15U) {  // turned over by rounding
      output.blocks[n] = 0;
      continue;
    }
    CellPlanes& plane = output.planes[n];
    const F4 fa = __builtin_convertvector(a, F4);
    const F4 fb = __builtin_convertvector(b, F4);
    const F4 fc = __builtin_convertvector(c, F4);
    const I4 list = face_lists.list[entries];
    const F4 plane_a = __builtin_shuffle(fa, list);
    const F4 plane_b = __builtin_shuffle(fb, list);
    const F4 plane_c = __builtin_shuffle(fc, list);
    ATOMESH_STORE4(plane.a, plane_a);
    ATOMESH_STORE4(plane.b, plane_b);
    ATOMESH_STORE4(plane.c, plane_c);
    const int entry_count = __builtin_popcount(entries);
    const BlockSet met = entries == 0 ? test.all_blocks() : test.blocks(plane_a, plane_b, plane_c, entry_count);
    output.blocks[n] = met;
    if (met == 0) continue;
    plane.enters[0] = entry_count >= 2 ? 3e38F : -3e38F;
    plane.enters[1] = entry_count >= 3 ? 3e38F : -3e38F;
    plane.eye_inside = entry_count == 0 ? 1 : 0;

    // Gradients of the barycentric coordinates: ±N / 6V. A cell too flat to have them gets the mean of its corners.
    const double mx = 0.25 * ATOMESH_SUM(x);
    const double my = 0.25 * ATOMESH_SUM(y);
    const double mz = 0.25 * ATOMESH_SUM(z);
    const D4 squares = (x - mx) * (x - mx) + (y - my) * (y - my) + (z - mz) * (z - mz);
    const double size = ATOMESH_SUM(squares);
    const double volume6 = nx[3] * (x[3] - x[0]) + ny[3] * (y[3] - y[0]) + nz[3] * (z[3] - z[0]);
    const bool flat = volume6 * volume6 <= 1e-26 * size * size * size;
    const D4 over_volume = D4{-1.0, 1.0, -1.0, 1.0} * (flat ? 0.0 : 1.0 / volume6);
    const D4 wx = nx * over_volume;
    const D4 wy = ny * over_volume;
    const D4 wz = nz * over_volume;
    D4 gx{};
    D4 gy{};
    D4 gz{};
    D4 mean{};
    F4 low{};
    F4 high{};
    for (int v = 0; v < 4; ++v) {
      F4 here{};
      const float* source = input.values + static_cast<std::size_t>(input.value_count) * corners.vertex[v];
      if (input.value_count == 4) {
        __builtin_memcpy(&here, source, 16);
      } else {
        here[0] = *source;
      }
      low = v == 0 ? here : (here < low ? here : low);
      high = v == 0 ? here : (here > high ? here : high);
      const D4 exact = __builtin_convertvector(here, D4);
      mean += 0.25 * exact;
      gx += exact * wx[v];
      gy += exact * wy[v];
      gz += exact * wz[v];
    }
    const double h = perspective ? mz : 1.0;
    const F4 base_a = __builtin_convertvector(gx * (h * pixel), F4);
    const F4 base_b = __builtin_convertvector(gy * (-h * pixel), F4);
    const F4 base_c = __builtin_convertvector(mean + gx * (h * x0 - mx) + gy * (h * y0 - my), F4);
    const double across = perspective ? 1.0 : 0.0;
    const F4 slope_a = __builtin_convertvector(gx * (across * pixel), F4);
    const F4 slope_b = __builtin_convertvector(gy * (-across * pixel), F4);
    const F4 slope_c = __builtin_convertvector(gz + across * (gx * x0 + gy * y0), F4);
    const float depth = static_cast<float>(mz - view.reference);
    if (input.value_count == 4) {
      // Where the rounding of the sums' largest terms is at most 2e-6 they are not clamped.
      const float extent = static_cast<float>(__builtin_sqrt(size));
      constexpr float side = tile_side;
      const F4 reach = side * (magnitude(base_a) + magnitude(base_b)) + magnitude(base_c) +
                       extent * (side * (magnitude(slope_a) + magnitude(slope_b)) + magnitude(slope_c));
      const bool tame = reach[0] <= 32.0F && reach[1] <= 32.0F && reach[2] <= 32.0F && reach[3] <= 32.0F;
      CellColors& cell_colors = output.colors[n];
      ATOMESH_STORE4(cell_colors.base_a, base_a);
      ATOMESH_STORE4(cell_colors.base_b, base_b);
      ATOMESH_STORE4(cell_colors.base_c, base_c);
      ATOMESH_STORE4(cell_colors.slope_a, slope_a);
      ATOMESH_STORE4(cell_colors.slope_b, slope_b);
      ATOMESH_STORE4(cell_colors.slope_c, slope_c);
      cell_colors.depth = depth;
      cell_colors.wild = tame ? 0 : 1;
      ATOMESH_STORE4(output.ranges[n].low, low);
      ATOMESH_STORE4(output.ranges[n].high, high);
    } else {
      output.scalars[n] = {base_a[0], base_b[0], base_c[0], slope_a[0], slope_b[0], slope_c[0],
                           depth,     low[0],    high[0],   0,          0};
    }

    // With L the linear function that equals |p - centroid|² at the corners, the power of the eye with respect to the
    // circumsphere is |eye - centroid|² - L(eye); seen from infinity cells sort by their circumcentre's depth.
    const double qx = ATOMESH_SUM(squares * wx);
    const double qy = ATOMESH_SUM(squares * wy);
    const double qz = ATOMESH_SUM(squares * wz);
    const double keep = 1.0 - view.order_blend;
    if (perspective) {
      output.keys[n] = mx * mx + my * my + mz * mz + keep * (qx * mx + qy * my + qz * mz - 0.25 * size);
    } else {
      output.keys[n] = mz + keep * 0.5 * qz;
    }
  }
  test.counts(output.per_block);
}

}  // namespace atomesh::ATOMESH_ISA
