// Set-up of a tile's cells: double in, float about the tile out. A register's lanes are cells side by side, but where
// vertices carry four values. Included by the kernels' sources after cell_projection_blocks.inl.

namespace atomesh::ATOMESH_ISA {

#if defined(__AVX512F__)
inline constexpr int group_size = 8;
#else
inline constexpr int group_size = 4;
#endif
typedef double Doubles __attribute__((vector_size(8 * group_size)));
typedef float Floats __attribute__((vector_size(4 * group_size)));
typedef Index Indices __attribute__((vector_size(4 * group_size)));
typedef std::int32_t Ints __attribute__((vector_size(4 * group_size)));
typedef double D4 __attribute__((vector_size(32)));
// Column and row of each cell.
typedef float Places __attribute__((vector_size(8 * group_size)));
typedef std::int32_t PlaceBits __attribute__((vector_size(8 * group_size)));
typedef std::uint32_t PlaceMasks __attribute__((vector_size(8 * group_size)));

// In one instruction, where the compiler's own conversion of vectors goes through memory.
#if defined(__AVX__)
static inline F4 to_floats(const D4& v) {
  return _mm256_cvtpd_ps(v);
}
static inline D4 to_doubles(const F4& v) {
  return _mm256_cvtps_pd(v);
}
#else
static inline F4 to_floats(const D4& v) {
  return __builtin_convertvector(v, F4);
}
static inline D4 to_doubles(const F4& v) {
  return __builtin_convertvector(v, D4);
}
#endif
#if defined(__AVX512F__)
static inline Floats to_floats(const Doubles& v) {
  return _mm512_cvtpd_ps(v);
}
static inline Doubles to_doubles(const Floats& v) {
  return _mm512_cvtps_pd(v);
}
#endif

static inline Doubles square_root(const Doubles& v) {
#if defined(__AVX512F__)
  return _mm512_sqrt_pd(v);
#elif defined(__AVX__)
  return _mm256_sqrt_pd(v);
#else
  Doubles root;
  for (int l = 0; l < group_size; ++l) root[l] = __builtin_sqrt(v[l]);
  return root;
#endif
}

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

static inline D4 all_of(double v) {
#if defined(__AVX__)
  return _mm256_set1_pd(v);
#else
  return D4{v, v, v, v};
#endif
}

static inline D4 multiply_add(const D4& a, const D4& b, const D4& c) {
#if defined(__FMA__)
  return _mm256_fmadd_pd(a, b, c);
#else
  return a * b + c;
#endif
}

static inline bool any_above(const F4& v, float limit) {
#if defined(__SSE2__)
  return _mm_movemask_ps(_mm_cmpnle_ps(v, _mm_set1_ps(limit))) != 0;
#else
  return !(v[0] <= limit && v[1] <= limit && v[2] <= limit && v[3] <= limit);
#endif
}

static inline bool any_above(const Doubles& v, double limit) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(v, _mm512_set1_pd(limit), _CMP_GT_OQ) != 0;
#elif defined(__AVX__)
  return _mm256_movemask_pd(_mm256_cmp_pd(v, _mm256_set1_pd(limit), _CMP_GT_OQ)) != 0;
#else
  bool any = false;
  for (int l = 0; l < group_size; ++l) any |= v[l] > limit;
  return any;
#endif
}

// So many cells of a tile at once. Corners stand in ascending order of vertex index, face k opposite corner k.
struct CellGroup {
  Indices vertex[4];
  Ints odd;  // all bits where that order is an odd permutation of the cell's own
  Doubles x[4], y[4], z[4];
  Places place[4];                                                // where the picture has them
  Doubles nx[4], ny[4], nz[4];                                    // of the faces' planes, from their corners in order
  Doubles a[4], b[4], c[4];                                       // the planes as u(i, j)
  F4 cell_a[group_size], cell_b[group_size], cell_c[group_size];  // the same, cell by cell
  Ints entries;                                                   // bit k: the ray enters by face k
  Ints steep;                                                     // bit k: of face k the coefficients are split
  Doubles reach;                                                  // how far from zero one of the planes gets
  // Of each cell column, then row: what of the lattice's grid lies between the corners.
  std::int32_t pixels[2 * group_size];  // a bit each
  std::int32_t first_block[2 * group_size];
  std::int32_t last_block[2 * group_size];
  std::int32_t blocks[2 * group_size];  // a bit each; none where there are no pixels
};

static inline void transpose(const Doubles* doubles, F4* cells) {
  const Floats faces[4] = {to_floats(doubles[0]), to_floats(doubles[1]), to_floats(doubles[2]), to_floats(doubles[3])};
  for (int part = 0; part < group_size; part += 4) {
    F4 row[4];
    for (int k = 0; k < 4; ++k) {
      __builtin_memcpy(&row[k], reinterpret_cast<const float*>(&faces[k]) + part, sizeof(F4));
    }
    const F4 low01 = __builtin_shuffle(row[0], row[1], I4{0, 4, 1, 5});
    const F4 low23 = __builtin_shuffle(row[2], row[3], I4{0, 4, 1, 5});
    const F4 high01 = __builtin_shuffle(row[0], row[1], I4{2, 6, 3, 7});
    const F4 high23 = __builtin_shuffle(row[2], row[3], I4{2, 6, 3, 7});
    cells[part] = __builtin_shuffle(low01, low23, I4{0, 1, 4, 5});
    cells[part + 1] = __builtin_shuffle(low01, low23, I4{2, 3, 6, 7});
    cells[part + 2] = __builtin_shuffle(high01, high23, I4{0, 1, 4, 5});
    cells[part + 3] = __builtin_shuffle(high01, high23, I4{2, 3, 6, 7});
  }
}

// Cells input.cells[first] and on; the tile's last one fills the lanes that are left.
#if defined(__AVX512F__)
static inline void load_group(const SetupInput& input, std::size_t first, CellGroup& g) {
  const auto corners_of = [&](std::size_t l) {
    const std::size_t at = first + l;
    const Index cell = input.cells[at < input.count ? at : input.count - 1];
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(input.corners + 4 * static_cast<std::size_t>(cell)));
  };
  const auto four = [&](std::size_t l) {
    __m512i cells = _mm512_castsi128_si512(corners_of(l));
    cells = _mm512_inserti32x4(cells, corners_of(l + 1), 1);
    cells = _mm512_inserti32x4(cells, corners_of(l + 2), 2);
    return _mm512_inserti32x4(cells, corners_of(l + 3), 3);
  };
  const __m512i low = four(0);
  const __m512i high = four(4);
  const __m512i by_corner = _mm512_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25, 29);
  const __m512i corners01 = _mm512_permutex2var_epi32(low, by_corner, high);
  const __m512i corners23 = _mm512_permutex2var_epi32(low, _mm512_add_epi32(by_corner, _mm512_set1_epi32(2)), high);
  __m256i corner[4] = {_mm512_castsi512_si256(corners01), _mm512_extracti64x4_epi64(corners01, 1),
                       _mm512_castsi512_si256(corners23), _mm512_extracti64x4_epi64(corners23, 1)};
  unsigned odd = 0;
  constexpr int network[5][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}};
  for (const auto& [i, j] : network) {
    odd ^= _mm256_cmplt_epu32_mask(corner[j], corner[i]);
    const __m256i lesser = _mm256_min_epu32(corner[i], corner[j]);
    corner[j] = _mm256_max_epu32(corner[i], corner[j]);
    corner[i] = lesser;
  }
  g.odd = reinterpret_cast<Ints>(_mm256_movm_epi32(static_cast<__mmask8>(odd)));
  for (int k = 0; k < 4; ++k) g.vertex[k] = reinterpret_cast<Indices>(corner[k]);
  const __m512i first_of_pairs = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i second_of_pairs = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  for (int k = 0; k < 4; ++k) {
    const auto vertex = [&](int l) {
      return _mm256_load_pd(reinterpret_cast<const double*>(input.vertices + g.vertex[k][l]));
    };
    const auto pair = [&](int l) { return _mm512_insertf64x4(_mm512_castpd256_pd512(vertex(l)), vertex(l + 4), 1); };
    const __m512d p0 = pair(0);
    const __m512d p1 = pair(1);
    const __m512d p2 = pair(2);
    const __m512d p3 = pair(3);
    const __m512d xz01 = _mm512_unpacklo_pd(p0, p1);
    const __m512d xz23 = _mm512_unpacklo_pd(p2, p3);
    const __m512d yw01 = _mm512_unpackhi_pd(p0, p1);
    const __m512d yw23 = _mm512_unpackhi_pd(p2, p3);
    g.x[k] = _mm512_permutex2var_pd(xz01, first_of_pairs, xz23);
    g.y[k] = _mm512_permutex2var_pd(yw01, first_of_pairs, yw23);
    g.z[k] = _mm512_permutex2var_pd(xz01, second_of_pairs, xz23);
    g.place[k] = reinterpret_cast<Places>(_mm512_permutex2var_pd(yw01, second_of_pairs, yw23));
  }
}
#else
static inline void load_group(const SetupInput& input, std::size_t first, CellGroup& g) {
  for (int l = 0; l < group_size; ++l) {
    const std::size_t at = first + static_cast<std::size_t>(l);
    const Index cell = input.cells[at < input.count ? at : input.count - 1];
    const Index* corners = input.corners + 4 * static_cast<std::size_t>(cell);
    for (int k = 0; k < 4; ++k) g.vertex[k][l] = corners[k];
  }
  g.odd = Ints{};
  constexpr int network[5][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}};
  for (const auto& [i, j] : network) {
    const Indices vi = g.vertex[i];
    const Indices vj = g.vertex[j];
    const Ints swap = vj < vi;
    g.vertex[i] = swap ? vj : vi;
    g.vertex[j] = swap ? vi : vj;
    g.odd ^= swap;
  }
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < group_size; ++l) {
      const ProjectedVertex& p = input.vertices[g.vertex[k][l]];
      g.x[k][l] = p.x;
      g.y[k][l] = p.y;
      g.z[k][l] = p.z;
      g.place[k][2 * l] = p.column;
      g.place[k][2 * l + 1] = p.row;
    }
  }
}
#endif

// Corners, then what they name, are asked for some cells ahead. (Always inlined: see prefetch().)
static inline __attribute__((always_inline)) void prefetch_groups(const SetupInput& input, std::size_t first) {
  constexpr std::size_t step = 16;
  for (std::size_t near = first + step; near < first + step + group_size && near < input.count; ++near) {
    if (near + step < input.count) {
      __builtin_prefetch(input.corners + 4 * static_cast<std::size_t>(input.cells[near + step]));
    }
    const Index* ahead = input.corners + 4 * static_cast<std::size_t>(input.cells[near]);
    for (int k = 0; k < 4; ++k) {
      __builtin_prefetch(input.vertices + static_cast<std::size_t>(ahead[k]));
      __builtin_prefetch(input.values + static_cast<std::size_t>(input.value_count) * ahead[k]);
    }
  }
}

// The plane of face k. Every face goes through the same instructions, whichever number it has in its cell, so that its
// two cells get the same bits: hence a function that is not inlined.
static __attribute__((noinline)) void find_planes(const View& view, double x0, double y0, int k, CellGroup& g) {
  constexpr int corners[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  const Doubles zero{};
  const bool perspective = view.perspective;
  const Doubles ax = g.x[corners[k][0]];
  const Doubles ay = g.y[corners[k][0]];
  const Doubles az = g.z[corners[k][0]];
  const Doubles bx = g.x[corners[k][1]] - ax;
  const Doubles by = g.y[corners[k][1]] - ay;
  const Doubles bz = g.z[corners[k][1]] - az;
  const Doubles cx = g.x[corners[k][2]] - ax;
  const Doubles cy = g.y[corners[k][2]] - ay;
  const Doubles cz = g.z[corners[k][2]] - az;
  const Doubles nx = by * cz - bz * cy;
  const Doubles ny = bz * cx - bx * cz;
  const Doubles nz = bx * cy - by * cx;
  const Doubles constant = nx * ax + ny * ay + nz * az;
  g.nx[k] = nx;
  g.ny[k] = ny;
  g.nz[k] = nz;

  // u(x, y) = (m - k (Nx x + Ny y)) / d + offset. A face that holds the eye (or is parallel to the rays) has d = 0: a d
  // of next to nothing then puts it before or behind everything, the same for both its cells.
  Doubles d = perspective ? constant : nz;
  const Doubles tiny = zero + 1e-200;
  d = (d < tiny && d > -tiny) ? tiny : d;
  const double scale_u = perspective ? view.reference : 1.0;
  const Doubles m = perspective ? -view.reference * nz : constant;
  const Doubles inverse = 1.0 / d;
  Doubles a = -scale_u * view.pixel * nx * inverse;
  Doubles b = scale_u * view.pixel * ny * inverse;
  Doubles c = (m - scale_u * (x0 * nx + y0 * ny)) * inverse + (perspective ? 1.0 : -view.reference);
  const Doubles abs_a = a < zero ? -a : a;
  const Doubles abs_b = b < zero ? -b : b;
  const Doubles abs_c = c < zero ? -c : c;
  Doubles largest = abs_a > abs_b ? abs_a : abs_b;
  largest = largest > abs_c ? largest : abs_c;
  // Far beyond any depth, and nowhere near where floats end when it is multiplied.
  const Doubles limit = zero + 1e20;
  Doubles reach = tile_middle * (abs_a + abs_b) + abs_c;
  if (any_above(largest, 1e20)) {
    const Doubles scale = largest > limit ? limit / largest : zero + 1.0;
    a *= scale;
    b *= scale;
    c *= scale;
    reach *= scale;
  }
  g.a[k] = a;
  g.b[k] = b;
  g.c[k] = c;
  g.reach = g.reach > reach ? g.reach : reach;
  g.steep |= __builtin_convertvector(reach > zero + view.plain_reach, Ints) & (1 << k);

  // The ray enters by the faces whose outward normal looks back at it. Which way is outward follows from the order of
  // the corners alone, so that the cells at a face never disagree.
  const Ints inward = g.odd ^ (k % 2 == 0 ? -1 : 0);
  const Ints back = __builtin_convertvector(d < zero, Ints);
  g.entries |= (back ^ inward) & (1 << k);
}

// The lattice's pixels between the corners, those within pixel_margin included; all where a corner is not before the
// eye.
class BoxFinder {
 public:
  explicit BoxFinder(const SetupInput& input) {
    const PixelLattice& lattice = input.lattice;
    for (int i = 0; i < 2 * group_size; ++i) {
      const bool row = i % 2 == 1;
      const int stride = row ? lattice.row_stride : lattice.column_stride;
      const int begin = row ? input.row + lattice.row_phase : input.column + lattice.column_phase;
      begin_[i] = static_cast<float>(begin);
      per_stride_[i] = 1.0F / static_cast<float>(stride);
      end_[i] = static_cast<float>(tile_side / stride);
    }
  }

  void find(CellGroup& g) const {
    const Places zero{};
    Places low = g.place[0];
    Places high = g.place[0];
    PlaceBits behind = g.place[0] != g.place[0];
    for (int k = 1; k < 4; ++k) {
      low = g.place[k] < low ? g.place[k] : low;
      high = g.place[k] > high ? g.place[k] : high;
      behind |= g.place[k] != g.place[k];
    }
    // One beyond the last pixel where there is none.
    const Places from = ((low - begin_) - pixel_margin) * per_stride_;
    const Places to = ((high - begin_) + pixel_margin) * per_stride_ + 1.0F;
    const Places first = from > zero ? (from < end_ ? from : end_) : zero;
    const Places last = to > zero ? (to < end_ ? to : end_) : zero;
    const PlaceBits whole = __builtin_convertvector(first, PlaceBits);
    const PlaceBits one = PlaceBits{} + 1;
    const PlaceBits first_pixel = behind ? PlaceBits{} : whole - (__builtin_convertvector(whole, Places) < first);
    const PlaceBits last_pixel = __builtin_convertvector(behind ? end_ : last, PlaceBits) - 1;
    const PlaceBits some = first_pixel <= last_pixel;
    const PlaceBits begin = some ? first_pixel : PlaceBits{};
    const PlaceBits end = some ? last_pixel : PlaceBits{};
    const PlaceBits first_block = begin / block_side;
    const PlaceBits last_block = end / block_side;
    // Without sign: a set of 32 pixels fills its word, and the difference wraps.
    const PlaceMasks unit = PlaceMasks{} + 1U;
    const PlaceMasks pixels = (unit << __builtin_convertvector(end, PlaceMasks) << 1U) -
                              (unit << __builtin_convertvector(begin, PlaceMasks));
    const PlaceBits blocks = ((one << last_block << 1) - (one << first_block)) & some;
    __builtin_memcpy(g.pixels, &pixels, sizeof pixels);
    __builtin_memcpy(g.first_block, &first_block, sizeof first_block);
    __builtin_memcpy(g.last_block, &last_block, sizeof last_block);
    __builtin_memcpy(g.blocks, &blocks, sizeof blocks);
  }

 private:
  Places begin_, per_stride_, end_;
};

// Of each set of rows of blocks, all blocks of the first column.
struct RowSpread {
  BlockSet rows[1 << blocks_per_side];
};
constexpr RowSpread make_row_spread() {
  RowSpread spread{};
  for (unsigned set = 0; set < 1U << blocks_per_side; ++set) {
    for (int row = 0; row < blocks_per_side; ++row) {
      spread.rows[set] |= static_cast<BlockSet>(set >> row & 1) << (blocks_per_side * row);
    }
  }
  return spread;
}
constexpr RowSpread row_spread = make_row_spread();

// u(i, j) = (a i + b j + c) + (rest): the first part in multiples of so large a number that floats lose nothing of it
// anywhere in the tile.
static inline void split_plane(double a, double b, double c, float* first, float* rest) {
  const double reach = tile_middle * ((a < 0.0 ? -a : a) + (b < 0.0 ? -b : b)) + (c < 0.0 ? -c : c);
  std::uint64_t exponent;
  __builtin_memcpy(&exponent, &reach, sizeof exponent);
  // Adding 1.5 · 2^52 such multiples, of which the reach has 2^22 to 2^23, rounds to a multiple.
  const std::uint64_t rounder_bits = ((exponent >> 52) + 30) << 52 | std::uint64_t{1} << 51;
  double rounder;
  __builtin_memcpy(&rounder, &rounder_bits, sizeof rounder);
  const double whole[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    const double rounded = (whole[i] + rounder) - rounder;
    first[i] = static_cast<float>(rounded);
    rest[i] = static_cast<float>(whole[i] - rounded);
  }
}

// Cell l's planes as the kernel wants them, and its blocks.
static inline BlockSet write_planes(const CellGroup& g, int l, const BlockTest& test, BlockSet wanted,
                                    CellPlanes& plane, CellRefinement& refinement) {
  const auto entries = static_cast<unsigned>(g.entries[l]);
  if (entries == 15U) return 0;  // turned over by rounding
  const BlockSet between = static_cast<BlockSet>(g.blocks[2 * l]) * row_spread.rows[g.blocks[2 * l + 1]] & wanted;
  if (between == 0) return 0;
  const I4 list = face_lists.list[entries];
  const F4 a = __builtin_shuffle(g.cell_a[l], list);
  const F4 b = __builtin_shuffle(g.cell_b[l], list);
  const F4 c = __builtin_shuffle(g.cell_c[l], list);
  const int entry_count = __builtin_popcount(entries);
  const BlockSet blocks =
      entries == 0 ? between
                   : test.blocks(a, b, c, entry_count, static_cast<float>(2e-6 * g.reach[l]), g.first_block[2 * l],
                                 g.last_block[2 * l], g.first_block[2 * l + 1], g.last_block[2 * l + 1], between);
  if (blocks == 0) return 0;
  store4(plane.a, a);
  store4(plane.b, b);
  store4(plane.c, c);
  plane.columns = static_cast<std::uint32_t>(g.pixels[2 * l]);
  plane.rows = static_cast<std::uint32_t>(g.pixels[2 * l + 1]);
  plane.entries = static_cast<std::uint8_t>(entry_count);
  plane.wild = false;
  plane.refined = g.steep[l] != 0 || entries == 0;
  if (plane.refined) {
    refinement = {};
    for (int n = 0; n < 4; ++n) {
      const int k = list[n];
      if ((g.steep[l] >> k & 1) == 0) continue;
      float first[3];
      float rest[3];
      split_plane(g.a[k][l], g.b[k][l], g.c[k][l], first, rest);
      plane.a[n] = first[0];
      plane.b[n] = first[1];
      plane.c[n] = first[2];
      refinement.a[n] = rest[0];
      refinement.b[n] = rest[1];
      refinement.c[n] = rest[2];
    }
  }
  return blocks;
}

}  // namespace atomesh::ATOMESH_ISA
