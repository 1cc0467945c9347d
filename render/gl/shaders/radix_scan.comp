// Counts become places: the sum of all before. One work group.
layout(local_size_x = 1024) in;

layout(std430, binding = 2) buffer Places { uint places[]; };
uniform uint count;  // of places

shared uint sums[1024];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint each = (count + 1023u) / 1024u;
  uint begin = min(thread * each, count);
  uint end = min(begin + each, count);
  uint own = 0u;
  for (uint i = begin; i < end; ++i) own += places[i];
  sums[thread] = own;
  barrier();
  for (uint step = 1u; step < 1024u; step *= 2u) {
    uint before = thread >= step ? sums[thread - step] : 0u;
    barrier();
    sums[thread] += before;
    barrier();
  }
  uint sum = sums[thread] - own;
  for (uint i = begin; i < end; ++i) {
    uint here = places[i];
    places[i] = sum;
    sum += here;
  }
}
