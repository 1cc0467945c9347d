// Each cell of a tile to its place: those of one digit stay in the order in which they stood.
layout(local_size_x = 256) in;

#include "radix.glsl"

// How many of each digit the threads have, and those before them: digits d and d + 8 in the halves of one number.
const uint columns = digit_values / 2u;
shared uint digits_of_threads[columns * group_size];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint first = gl_WorkGroupID.x * tile_size + thread * cells_each;
  for (uint c = 0u; c < columns; ++c) digits_of_threads[c * group_size + thread] = 0u;
  uvec2 cells[cells_each];
  uint ranks[cells_each];  // among the thread's own of the same digit
  for (uint i = 0u; i < cells_each; ++i) {
    if (first + i >= count) break;
    cells[i] = from[first + i];
    uint digit = digit_of(cells[i].x);
    uint half_shift = digit < columns ? 0u : 16u;
    uint place = digit % columns * group_size + thread;
    ranks[i] = digits_of_threads[place] >> half_shift & 0xFFFFu;
    digits_of_threads[place] += 1u << half_shift;
  }
  uint own[columns];
  for (uint c = 0u; c < columns; ++c) own[c] = digits_of_threads[c * group_size + thread];
  barrier();
  for (uint step = 1u; step < group_size; step *= 2u) {
    uint before[columns];
    for (uint c = 0u; c < columns; ++c) {
      before[c] = thread >= step ? digits_of_threads[c * group_size + thread - step] : 0u;
    }
    barrier();
    for (uint c = 0u; c < columns; ++c) digits_of_threads[c * group_size + thread] += before[c];
    barrier();
  }
  for (uint c = 0u; c < columns; ++c) digits_of_threads[c * group_size + thread] -= own[c];
  for (uint i = 0u; i < cells_each; ++i) {
    if (first + i >= count) break;
    uint digit = digit_of(cells[i].x);
    uint before = digits_of_threads[digit % columns * group_size + thread] >> (digit < columns ? 0u : 16u) & 0xFFFFu;
    to[places[digit * gl_NumWorkGroups.x + gl_WorkGroupID.x] + before + ranks[i]] = cells[i];
  }
}
