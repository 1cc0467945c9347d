// Rules by which a segment is integrated along which RGBA is linear from end to end; siblings of one shape:
//   add(near_end, far_end, length, light)  lays the segment behind what is in `light`; `length` is alpha_length times
//   the way, so that the optical depth of opacity 1 is `length`.
// Included by the kernels' sources after cell_projection_light.inl.

namespace atomesh::ATOMESH_ISA {

// Optical depths above piece_limit: cut into pieces of that depth, as many as light survives.
static inline optics::Piece<Lanes> integrate_dense(const Lanes& dense, const Lanes& density_near,
                                                   const Lanes& half_difference) {
  const Lanes zero(0.0F);
  const Lanes one(1.0F);
  const Lanes limit(optics::piece_limit);
  const Lanes density_far = density_near + half_difference + half_difference;
  Lanes u(0.0F);
  Lanes through = dense;
  Lanes far_weight(0.0F);
  for (;;) {
    const Mask active = (u < one) & (through > Lanes(optics::nothing_left));
    if (!any(active)) break;
    const Lanes density = multiply_add(half_difference + half_difference, u, density_near);
    const Lanes rest = one - u;
    const Mask cut = Lanes(0.5F) * rest * (density + density_far) > limit;
    const Lanes root = sqrt(max(multiply_add(density, density, half_difference * Lanes(4.0F)), zero));
    const Lanes reach = min(Lanes(2.0F) / max(density + root, Lanes(1e-30F)), rest);
    const Lanes h = select(active, select(cut, reach, rest), zero);
    const Lanes bend = half_difference * h * h;
    const optics::Piece<Lanes> piece = optics::integrate_piece(min(multiply_add(density, h, bend), limit), bend);
    far_weight = multiply_add(through, multiply_add(u, piece.opacity, h * piece.ramp), far_weight);
    through = through - through * piece.opacity;
    u = select(active, select(cut & (reach < rest), u + reach, one), u);
  }
  return {dense - through, far_weight};
}

// What is seldom needed is not inlined, and takes and returns values: so what is common may stay in registers.
static __attribute__((noinline, flatten)) optics::Piece<Lanes> with_dense(Lanes mean, Lanes density_near,
                                                                          Lanes half_difference,
                                                                          optics::Piece<Lanes> other) {
  const Mask dense = mean > Lanes(optics::piece_limit);
  const optics::Piece<Lanes> pieces =
      integrate_dense(select(dense, Lanes(1.0F), Lanes(0.0F)), density_near, half_difference);
  return {select(dense, pieces.opacity, other.opacity), select(dense, pieces.ramp, other.ramp)};
}

// The closed form, of any optical depth.
static inline optics::Piece<Lanes> integrate(const Lanes& mean, const Lanes& density_near,
                                             const Lanes& half_difference) {
  const optics::Piece<Lanes> thin = optics::integrate_thin_piece(mean, half_difference);
  Lanes opacity = thin.opacity;
  Lanes ramp = thin.ramp;
  const Mask thick = mean > Lanes(optics::thin_limit);
  if (any(thick)) {
    const optics::Piece<Lanes> piece = optics::integrate_piece(mean, half_difference);
    opacity = select(thick, piece.opacity, opacity);
    ramp = select(thick, piece.ramp, ramp);
    if (any(mean > Lanes(optics::piece_limit))) {
      const optics::Piece<Lanes> pieces = with_dense(mean, density_near, half_difference, {opacity, ramp});
      opacity = pieces.opacity;
      ramp = pieces.ramp;
    }
  }
  return {opacity, ramp};
}

// The same, of what optics::centered() makes of it.
static inline optics::CenteredPiece<Lanes> integrate_centered(const Lanes& mean, const Lanes& half_difference) {
  const optics::CenteredPiece<Lanes> thin = optics::integrate_thin_centered(mean, half_difference);
  Lanes opacity = thin.opacity;
  Lanes skew = thin.skew;
  const Mask thick = mean > Lanes(optics::thin_limit);
  if (any(thick)) {
    // However small, an opacity that is negative at an end would shine where extinction is large.
    const Lanes bounded = max(min(half_difference, mean), Lanes(0.0F) - mean);
    optics::Piece<Lanes> piece = optics::integrate_piece(mean, bounded);
    if (any(mean > Lanes(optics::piece_limit))) piece = with_dense(mean, mean - bounded, bounded, piece);
    const optics::CenteredPiece<Lanes> whole = optics::centered(piece);
    opacity = select(thick, whole.opacity, opacity);
    skew = select(thick, whole.skew, skew);
  }
  return {opacity, skew};
}

class ClosedForm {
 public:
  explicit ClosedForm(const CellOptics&) {}

  void add(const Rgba& near_end, const Rgba& far_end, const Lanes& length, Light& light) const {
    const Lanes density_near = near_end.channel[3] * length;
    const Lanes density_far = far_end.channel[3] * length;
    const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
    const Lanes mean = density_near + half_difference;
    ATOMESH_ISA::add(near_end, far_end, integrate(mean, density_near, half_difference), light);
  }
  // The same where what RGB changes by from end to end is known.
  void add_change(const Rgba& near_end, const Rgba& change, const Lanes& far_opacity, const Lanes& length,
                  Light& light) const {
    const Lanes density_near = near_end.channel[3] * length;
    const Lanes density_far = far_opacity * length;
    const Lanes half_difference = (density_far - density_near) * Lanes(0.5F);
    const Lanes mean = density_near + half_difference;
    ATOMESH_ISA::add_change(near_end, change, integrate(mean, density_near, half_difference), light);
  }
};

// 1 - e^{-x} for x >= 0, to float's relative precision where x is small.
static inline Lanes opacity_of(const Lanes& x) {
  const Lanes thin = optics::integrate_thin_piece(min(x, Lanes(optics::thin_limit)), Lanes(0.0F)).opacity;
  return select(x > Lanes(optics::thin_limit), Lanes(1.0F) - exp_minus(x), thin);
}

// Lays what was gathered apart, from nothing, behind what is in `light`. Of many small terms that are added one by one
// each loses what a float loses of the whole.
static inline void add_gathered(const Light& gathered, Light& light) {
  light.red = multiply_add(light.through, gathered.red, light.red);
  light.green = multiply_add(light.through, gathered.green, light.green);
  light.blue = multiply_add(light.through, gathered.blue, light.blue);
  take(light.through * gathered.covered, light);
}

// Samples in the middle of equal steps, each of its own colour and opacity.
class Samples {
 public:
  explicit Samples(const CellOptics& optics) : count_(optics.samples) {}

  void add(const Rgba& near_end, const Rgba& far_end, const Lanes& length, Light& light) const {
    light = add_all(near_end, far_end, length, light);
  }

 private:
  __attribute__((noinline, flatten)) Light add_all(Rgba near_end, Rgba far_end, Lanes length, Light light) const {
    const float step = 1.0F / static_cast<float>(count_);
    const Lanes step_length = length * Lanes(step);
    Light gathered;
    for (int i = 0; i < count_; ++i) {
      const Rgba color = mix(near_end, far_end, Lanes((static_cast<float>(i) + 0.5F) * step));
      absorb(color, opacity_of(color.channel[3] * step_length), gathered);
    }
    add_gathered(gathered, light);
    return light;
  }

  int count_;
};

}  // namespace atomesh::ATOMESH_ISA
