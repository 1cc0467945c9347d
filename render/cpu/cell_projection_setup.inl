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

// So many cells of a tile at once. Corners stand in ascending order of vertex index, face k opposite corner k.
struct CellGroup {
  Indices vertex[4];
  Ints odd;  // all bits where that order is an odd permutation of the cell's own
  Doubles x[4], y[4], z[4];
  Doubles nx[4], ny[4], nz[4];                                    // of the faces' planes, from their corners in order
  Doubles a[4], b[4], c[4];                                       // the planes as u(i, j)
  F4 cell_a[group_size], cell_b[group_size], cell_c[group_size];  // the same, cell by cell
  Ints entries;                                                   // bit k: the ray enters by face k
  Ints steep;                                                     // bit k: of face k the coefficients are split
  Ints first_column, last_column, first_row, last_row;            // of the lattice's grid, between the corners
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
      const double* p = input.vertices + 3 * static_cast<std::size_t>(g.vertex[k][l]);
      g.x[k][l] = p[0];
      g.y[k][l] = p[1];
      g.z[k][l] = p[2];
    }
  }
}

// Corners, then what they name, are asked for some cells ahead.
static inline void prefetch_groups(const SetupInput& input, std::size_t first) {
  for (std::size_t near = first + 8; near < first + 8 + group_size && near < input.count; ++near) {
    if (near + 8 < input.count) {
      __builtin_prefetch(input.corners + 4 * static_cast<std::size_t>(input.cells[near + 8]));
    }
    const Index* ahead = input.corners + 4 * static_cast<std::size_t>(input.cells[near]);
    for (int k = 0; k < 4; ++k) {
      __builtin_prefetch(input.vertices + 3 * static_cast<std::size_t>(ahead[k]));
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
  const Doubles scale = largest > limit ? limit / largest : zero + 1.0;
  g.a[k] = a * scale;
  g.b[k] = b * scale;
  g.c[k] = c * scale;
  const Doubles reach = (tile_side * (abs_a + abs_b) + abs_c) * scale;
  g.steep |= __builtin_convertvector(reach > zero + view.plain_reach, Ints) & (1 << k);

  // The ray enters by the faces whose outward normal looks back at it. Which way is outward follows from the order of
  // the corners alone, so that the cells at a face never disagree.
  const Ints inward = g.odd ^ (k % 2 == 0 ? -1 : 0);
  const Ints back = __builtin_convertvector(d < zero, Ints);
  g.entries |= (back ^ inward) & (1 << k);
}

// The lattice's pixels between the corners, those within a thousandth of a pixel included; all where a corner is not
// before the eye.
static inline void find_box(const View& view, const PixelLattice& lattice, double x0, double y0, CellGroup& g) {
  const Doubles zero{};
  const Doubles one = zero + 1.0;
  const double margin = 0x1p-10;
  const double per_pixel = 1.0 / view.pixel;
  Doubles left, right, top, bottom;
  Ints behind{};
  for (int k = 0; k < 4; ++k) {
    behind |= __builtin_convertvector(g.z[k] <= zero, Ints);
    const Doubles scale = view.perspective ? 1.0 / g.z[k] : one;
    const Doubles column = (g.x[k] * scale - x0) * per_pixel;
    const Doubles row = (y0 - g.y[k] * scale) * per_pixel;
    left = k == 0 ? column : (column < left ? column : left);
    right = k == 0 ? column : (column > right ? column : right);
    top = k == 0 ? row : (row < top ? row : top);
    bottom = k == 0 ? row : (row > bottom ? row : bottom);
  }
  if (!view.perspective) behind = Ints{};
  const auto first = [&](const Doubles& from, int phase, int stride) {
    const Doubles place = (from - (margin + phase)) * (1.0 / stride);
    const double beyond = tile_side;
    const Doubles inside = place > zero ? (place < beyond ? place : zero + beyond) : zero;
    const Ints whole = __builtin_convertvector(inside, Ints);
    return (whole - __builtin_convertvector(__builtin_convertvector(whole, Doubles) < inside, Ints)) & ~behind;
  };
  const auto last = [&](const Doubles& to, int phase, int stride) {
    const Doubles place = (to + (margin - phase)) * (1.0 / stride) + 1.0;
    const double end = static_cast<double>(tile_side / stride);
    const Doubles inside = place > zero ? (place < end ? place : zero + end) : zero;
    return ((__builtin_convertvector(inside, Ints) & ~behind) | (tile_side / stride & behind)) - 1;
  };
  g.first_column = first(left, lattice.column_phase, lattice.column_stride);
  g.last_column = last(right, lattice.column_phase, lattice.column_stride);
  g.first_row = first(top, lattice.row_phase, lattice.row_stride);
  g.last_row = last(bottom, lattice.row_phase, lattice.row_stride);
}

// Bits first … last.
static inline std::uint32_t bits_between(std::int32_t first, std::int32_t last) {
  return (2U << last) - (1U << first);
}

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
  const double reach = (tile_side - 1) * ((a < 0.0 ? -a : a) + (b < 0.0 ? -b : b)) + (c < 0.0 ? -c : c);
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
  const int left = g.first_column[l];
  const int right = g.last_column[l];
  const int top = g.first_row[l];
  const int bottom = g.last_row[l];
  if (left > right || top > bottom) return 0;
  const BlockSet between = bits_between(left / block_side, right / block_side) *
                               row_spread.rows[bits_between(top / block_side, bottom / block_side)] &
                           wanted;
  if (between == 0) return 0;
  const I4 list = face_lists.list[entries];
  const F4 a = __builtin_shuffle(g.cell_a[l], list);
  const F4 b = __builtin_shuffle(g.cell_b[l], list);
  const F4 c = __builtin_shuffle(g.cell_c[l], list);
  const int entry_count = __builtin_popcount(entries);
  const BlockSet blocks = entries == 0 ? between : test.blocks(a, b, c, entry_count, between);
  if (blocks == 0) return 0;
  store4(plane.a, a);
  store4(plane.b, b);
  store4(plane.c, c);
  plane.columns = bits_between(left, right);
  plane.rows = bits_between(top, bottom);
  const bool refined = g.steep[l] != 0 || entries == 0;
  const float far = refined ? refined_far : plain_far;
  plane.enters[0] = entry_count >= 2 ? far : -far;
  plane.enters[1] = entry_count >= 3 ? far : -far;
  if (refined) {
    refinement = {};
    refinement.eye_inside = entries == 0 ? 1 : 0;
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
