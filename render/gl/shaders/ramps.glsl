// The light of a ray's segment along which the scalar goes linearly, as the sum of ramps of a row of
// render/gl/map_ramps.h, that is in piece, piece_slope, piece_square, knot, knot_square, next_knot and
// next_knot_square; `zero`: the scalar from which the row counts. Scalars in [0,1] where the ray enters and where it
// leaves, `length` in Å: premultiplied RGB and opacity of what lies in the row's pieces.
// ONE_PIECE: all segments lie in the row's first piece, and its highest scalar is in `highest`.

// min() and max() ask for NaN.
float least(float a, float b) {
  return a < b ? a : b;
}
float most(float a, float b) {
  return a > b ? a : b;
}

vec4 ramps_light(float near_scalar, float far_scalar, float zero, float length) {
#ifdef ONE_PIECE
  // Of thin triangles rounding may make anything of them.
  float from = least(most(near_scalar - zero, piece_square.a), highest);
  float to = least(most(far_scalar - zero, piece_square.a), highest);
  float sum = from + to;
  vec4 linear = piece + sum * piece_slope;
  vec3 square = (sum * sum - from * to) * piece_square.rgb;
  float scale = length;
#else
  // A segment's scalars are taken for 2^-13 apart where they are closer: what is divided by is not 0.
  float middle = 0.5 * (near_scalar + far_scalar) - zero;
  float half_width = most(0.5 * abs(far_scalar - near_scalar), 1.0 / 16384.0);
  float low = most(middle - half_width, piece_square.a);
  float high = most(least(middle + half_width, knot_square.a), low);
  // Integrals over the scalar, of the pieces' part and of what begins at each knot.
  float across = high - low;
  float sum = low + high;
  vec4 linear = across * (piece + sum * piece_slope);
  vec3 square = (across * (sum * sum - low * high)) * piece_square.rgb;
  low = most(low, 0.0);
  high = most(high, 0.0);
  across = high - low;
  sum = low + high;
  linear += (across * sum) * knot;
  square += (across * (sum * sum - low * high)) * knot_square.rgb;
  low = most(low - next_knot_square.a, 0.0);
  high = most(high - next_knot_square.a, 0.0);
  across = high - low;
  sum = low + high;
  linear += (across * sum) * next_knot;
  square += (across * (sum * sum - low * high)) * next_knot_square.rgb;
  float scale = length * (0.5 / half_width);
#endif
  // (1 - e^-depth) / depth, by its series: to 2e-4 where depth <= 1, and it is no more but for rounding
  float depth = scale * linear.a;
  float depth_square = depth * depth;
  float through = (1.0 - depth * (1.0 / 2.0)) +
                  depth_square * ((1.0 / 6.0 - depth * (1.0 / 24.0)) +
                                  depth_square * (1.0 / 120.0 - depth * (1.0 / 720.0)));
  return vec4((linear.rgb + square) * (scale * through), depth * through);
}
