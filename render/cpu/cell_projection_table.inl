// The rule that looks its integral up. Included by the kernels' sources after cell_projection_segment.inl.

namespace atomesh::ATOMESH_ISA {

// Bilinear interpolation in a table of size × size floats, x the outer and y the inner index, both from 0 to size - 1.
static inline Lanes interpolate(const float* table, int size, const Lanes& x, const Lanes& y) {
  // The last place is reached from the one before it.
  const Lanes last(static_cast<float>(size - 1) * (1.0F - 0x1p-23F));
  const Lanes bounded_x = max(min(x, last), Lanes(0.0F));
  const Lanes bounded_y = max(min(y, last), Lanes(0.0F));
#if defined(__AVX512F__)
  const __m512i column = _mm512_cvttps_epi32(bounded_y.v);
  const __m512i row = _mm512_cvttps_epi32(bounded_x.v);
  const __m512i place = _mm512_add_epi32(_mm512_mullo_epi32(row, _mm512_set1_epi32(size)), column);
  const Lanes x0 = _mm512_cvtepi32_ps(row);
  const Lanes y0 = _mm512_cvtepi32_ps(column);
  const Lanes a00 = _mm512_i32gather_ps(place, table, 4);
  const Lanes a01 = _mm512_i32gather_ps(place, table + 1, 4);
  const Lanes a10 = _mm512_i32gather_ps(place, table + size, 4);
  const Lanes a11 = _mm512_i32gather_ps(place, table + size + 1, 4);
#else
  float at[6][lane_count];
  store(at[0], bounded_x);
  store(at[1], bounded_y);
  for (int i = 0; i < lane_count; ++i) {
    const int row = static_cast<int>(at[0][i]);
    const int column = static_cast<int>(at[1][i]);
    at[0][i] = static_cast<float>(row);
    at[1][i] = static_cast<float>(column);
    const float* const place = table + row * size + column;
    at[2][i] = place[0];
    at[3][i] = place[1];
    at[4][i] = place[size];
    at[5][i] = place[size + 1];
  }
  const Lanes x0 = load(at[0]);
  const Lanes y0 = load(at[1]);
  const Lanes a00 = load(at[2]);
  const Lanes a01 = load(at[3]);
  const Lanes a10 = load(at[4]);
  const Lanes a11 = load(at[5]);
#endif
  const Lanes beyond_x = bounded_x - x0;
  const Lanes beyond_y = bounded_y - y0;
  const Lanes near = multiply_add(beyond_y, a01 - a00, a00);
  const Lanes far = multiply_add(beyond_y, a11 - a10, a10);
  return multiply_add(beyond_x, far - near, near);
}

// Partial pre-integration: see render/shared/preintegration.h.
class Preintegrated {
 public:
  explicit Preintegrated(const CellOptics& optics) : psi_(optics.psi) {}

  void add(const Rgba& near_end, const Rgba& far_end, const Lanes& length, Light& light) const {
    const Lanes density_near = near_end.channel[3] * length;
    const Lanes density_far = far_end.channel[3] * length;
    if (any(density_near + density_far > Lanes(optics::psi_deepest))) {
      light = add_deep(near_end, far_end, density_near, density_far, light);
    } else {
      ATOMESH_ISA::add(near_end, far_end, look_up(density_near, density_far), light);
    }
  }

 private:
  static Lanes place(const Lanes& density) {
    constexpr float scale =
        static_cast<float>(optics::psi_size - 1) * (optics::psi_bend + optics::psi_deepest) / optics::psi_deepest;
    return density * Lanes(scale) * reciprocal(density + Lanes(optics::psi_bend));
  }

  optics::Piece<Lanes> look_up(const Lanes& density_near, const Lanes& density_far) const {
    const Lanes opacity = opacity_of(Lanes(0.5F) * (density_near + density_far));
    const Lanes psi = interpolate(psi_, optics::psi_size, place(density_near), place(density_far));
    return {opacity, psi - (Lanes(1.0F) - opacity)};
  }

  // Of deeper segments the part as deep as the table goes.
  __attribute__((noinline, flatten)) Light add_deep(Rgba near_end, Rgba far_end, Lanes density_near, Lanes density_far,
                                                    Light light) const {
    const Mask deep = density_near + density_far > Lanes(optics::psi_deepest);
    const Lanes limit(0.5F * optics::psi_deepest);
    const Lanes half_difference = Lanes(0.5F) * (density_far - density_near);
    const Lanes root =
        sqrt(max(multiply_add(density_near, density_near, Lanes(4.0F) * limit * half_difference), Lanes(0.0F)));
    const Lanes reach = Lanes(2.0F) * limit / max(density_near + root, Lanes(1e-30F));
    const Lanes u = select(deep, min(reach, Lanes(1.0F)), Lanes(1.0F));
    const Rgba cut = mix(near_end, far_end, u);
    Rgba end;
    for (int k = 0; k < 4; ++k) end.channel[k] = select(deep, cut.channel[k], far_end.channel[k]);
    const Lanes near_depth = min(density_near * u, Lanes(optics::psi_deepest));
    const Lanes far_depth = select(deep, Lanes(optics::psi_deepest) - near_depth, density_far);
    ATOMESH_ISA::add(near_end, end, look_up(near_depth, far_depth), light);
    return light;
  }

  const float* psi_;
};

}  // namespace atomesh::ATOMESH_ISA
