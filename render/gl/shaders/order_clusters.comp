// Cells of a cluster (render/gl/cell_clusters.h) one behind another, an invocation each cluster: always the first of
// those before which no other has to come.
layout(local_size_x = 64) in;

uniform uint count;
uniform vec4 eye;     // about Scene::center, 1; of parallel projection where it is looked from, 0
uniform float least;  // what is nearer to the eye's own plane is seen from the side: either order will do

struct Block {
  uint start;    // of the cluster's cells among those that are drawn
  uint visible;  // which of its cells are, as bits
};
layout(std430, binding = 0) readonly buffer Starts { uvec2 starts[]; };  // first cell, first face
layout(std430, binding = 1) readonly buffer Members { uint members[]; };
layout(std430, binding = 2) readonly buffer Planes { vec4 planes[]; };
layout(std430, binding = 3) readonly buffer Pairs { uint pairs[]; };
layout(std430, binding = 4) readonly buffer Blocks { Block blocks[]; };
layout(std430, binding = 5) writeonly buffer Cells { uint cells[]; };

void main() {
  // more than the groups of one dimension may be
  uint cluster = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (cluster >= count) return;
  uvec2 start = starts[cluster];
  uvec2 end = starts[cluster + 1u];
  uint size = end.x - start.x;
  uint before[32];  // which have to come before each, as bits
  for (uint i = 0u; i < size; ++i) before[i] = 0u;
  for (uint face = start.y; face < end.y; ++face) {
    float way = dot(planes[face], eye);
    uint near = pairs[face] & 0xFFFFu;
    uint far = pairs[face] >> 16;
    if (way > least) {
      before[near] |= 1u << far;
    } else if (way < -least) {
      before[far] |= 1u << near;
    }
  }
  uint rest = size == 32u ? 0xFFFFFFFFu : (1u << size) - 1u;
  uint visible = blocks[cluster].visible;
  uint at = blocks[cluster].start;
  while (rest != 0u) {
    uint next = uint(findLSB(rest));  // of a circle
    for (uint i = next; i < size; ++i) {
      if ((rest >> i & 1u) != 0u && (before[i] & rest) == 0u) {
        next = i;
        break;
      }
    }
    rest &= ~(1u << next);
    if ((visible >> next & 1u) != 0u) {
      cells[at] = members[start.x + next];
      ++at;
    }
  }
}
