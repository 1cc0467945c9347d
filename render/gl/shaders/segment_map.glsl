// The colour map in linear pieces, as PreintegrationTable lays it out: three texels each,
//   RGB and extinction (1/Å) where the piece begins; what they change by for each unit of the scalar;
//   scalar where the piece begins, where it ends, and the place of its first texel in the list of pieces.
// First, for each of segment_cells + 1 scalars i / segment_cells, the piece in which it lies; then the list of pieces.
// The list is reached from the cells by the place, and 3 texels further is the next piece up.

layout(binding = 8) uniform samplerBuffer segment_pieces;
const int segment_cells = 1024;

// Where the first texel is of a piece at or before the one in which a segment begins that goes `up` or down: those
// between come out empty.
int segment_first_piece(float scalar, bool up) {
  int cell = int(clamp(scalar, 0.0, 1.0) * float(segment_cells));
  return 3 * min(up ? cell : cell + 1, segment_cells);
}

// A segment's share up to where it leaves the piece of this range, at least `u`. A scalar at a knot belongs to the piece
// above it.
float segment_knot(vec2 range, float scalar_near, float scalar_far, float u) {
  float change = scalar_far - scalar_near;
  bool up = change >= 0.0;
  bool last = up ? range.y >= scalar_far && range.y > scalar_near : range.x <= scalar_far;
  float knot = ((up ? range.y : range.x) - scalar_near) / (abs(change) < 1e-30 ? 1e-30 : change);
  return last ? 1.0 : clamp(knot, u, 1.0);
}
