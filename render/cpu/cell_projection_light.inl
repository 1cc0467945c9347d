// A block's light on its way through the cells, and the rays themselves. Included by the kernels' sources after
// cell_projection_values.inl.
//
// No lane's result depends on the other lanes, to the last bit: where lanes need different formulas each gets the one
// it needs by select(), and any() only passes over work that no lane needs.

namespace atomesh::ATOMESH_ISA {

// Pixels of a block, counted from the middle of its tile.
struct Pixels {
  Lanes column;
  Lanes row;
};

static inline Lanes affine(const Pixels& p, float a, float b, float c) {
  return multiply_add(Lanes(a), p.column, multiply_add(Lanes(b), p.row, Lanes(c)));
}

// Premultiplied light and coverage gathered so far, and what of the rest still gets through. Coverage is 1 - through;
// each is kept by itself, so that both are good to float's relative precision where they are small.
struct Light {
  Lanes red{0.0F};
  Lanes green{0.0F};
  Lanes blue{0.0F};
  Lanes covered{0.0F};
  Lanes through{1.0F};
};

struct Rgba {
  Lanes channel[4];
};

static inline void take(const Lanes& taken, Light& light) {
  light.covered = light.covered + taken;
  light.through = light.through - taken;
}

// Rays that let next to nothing through are finished: what lies behind adds nothing to them, whenever it comes.
static inline void finish_opaque(Light& light) {
  light.through = select(light.through > Lanes(opaque_enough), light.through, Lanes(0.0F));
}

static inline void absorb(const Rgba& color, const Lanes& opacity, Light& light) {
  const Lanes taken = light.through * opacity;
  light.red = multiply_add(taken, color.channel[0], light.red);
  light.green = multiply_add(taken, color.channel[1], light.green);
  light.blue = multiply_add(taken, color.channel[2], light.blue);
  take(taken, light);
}

static inline Rgba mix(const Rgba& a, const Rgba& b, const Lanes& t) {
  Rgba color;
  for (int k = 0; k < 4; ++k) color.channel[k] = multiply_add(t, b.channel[k] - a.channel[k], a.channel[k]);
  return color;
}

// A piece along which colours go linearly from `near_end` by `change`.
static inline void add_change(const Rgba& near_end, const Rgba& change, const optics::Piece<Lanes>& piece,
                              Light& light) {
  const Lanes first = light.through * piece.opacity;
  const Lanes second = light.through * piece.ramp;
  Lanes* const gathered[3] = {&light.red, &light.green, &light.blue};
  for (int k = 0; k < 3; ++k) {
    *gathered[k] = multiply_add(first, near_end.channel[k], multiply_add(second, change.channel[k], *gathered[k]));
  }
  take(first, light);
}

// The same of what they are at both ends.
static inline void add(const Rgba& near_end, const Rgba& far_end, const optics::Piece<Lanes>& piece, Light& light) {
  Rgba change;
  for (int k = 0; k < 3; ++k) change.channel[k] = far_end.channel[k] - near_end.channel[k];
  add_change(near_end, change, piece, light);
}

}  // namespace atomesh::ATOMESH_ISA
