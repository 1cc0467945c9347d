// Front faces of the cells of a slab: front_faces() of render/gl/front_faces.cpp, in the same steps. A work group has
// cells_of_group places of the order and as many cells' vertices of the slab, which it fills from the first on, in the
// order of the places; and one command to draw them.
//
// MARKED: only of cells that lie where pixels are marked (MarkedTiles::meets()).
layout(local_size_x = 256) in;

#include "screen_vertex.glsl"

const uint cells_of_group = 1024u;
const uint vertices_per_cell = 9u;
const float not_behind = 1e30;
const ivec3 face_corners[4] = ivec3[4](ivec3(1, 2, 3), ivec3(0, 3, 2), ivec3(0, 1, 3), ivec3(0, 2, 1));

uniform uint first;  // place of the order, of the slab
uniform uint end;    // of the slab
uniform uint first_command;
uniform ivec2 pixels;  // columns and rows of the grid
#ifdef MARKED
uniform ivec4 window;    // left, right, bottom and top of what counts
uniform int tile_shift;  // pixels of a tile's side as a power of two
uniform uint line;       // sums of a row of tiles' corners
#endif

struct FaceVertex {
  vec4 entry;   // column, row, w, u
  vec4 behind;  // ways to the planes behind; slope
};
struct Command {
  uint count, instances, first_vertex, first_instance;
  uint cells;  // that meet a pixel
};

layout(std430, binding = 0) readonly buffer Order { uvec2 order[]; };  // key, cell
layout(std430, binding = 1) readonly buffer Tetrahedra { uvec4 tetrahedra[]; };
layout(std430, binding = 2) readonly buffer Projected { ScreenVertex projected[]; };
layout(std430, binding = 3) writeonly buffer Faces { FaceVertex faces[]; };
layout(std430, binding = 4) writeonly buffer Commands { Command commands[]; };
#ifdef MARKED
layout(std430, binding = 5) readonly buffer Tiles { uint sums[]; };  // marked tiles left of and below each corner
#endif

shared uint triangles_of_threads[256];
shared uint cells_of_command;

// pixels_between() of render/gl/screen_mesh.h: left, right, top, bottom of those within the box.
ivec4 pixels_between(ivec2 low, ivec2 high) {
  ivec2 middle = pixels / 2 * 256;
  ivec2 from = max((low + middle + 127) >> 8, ivec2(0));
  ivec2 to = min((high + middle - 128) >> 8, pixels - 1);
  return ivec4(from.x, to.x, from.y, to.y);
}

bool is_empty(ivec4 box) {
  return box.x > box.y || box.z > box.w;
}

#ifdef MARKED
bool meets_marked(ivec4 box) {
  box.xz = max(box.xz, window.xz);
  box.yw = min(box.yw, window.yw);
  if (is_empty(box)) return false;
  uvec4 tiles = uvec4(box >> tile_shift);
  tiles.yw += 1u;
  return sums[tiles.w * line + tiles.y] + sums[tiles.z * line + tiles.x] !=
         sums[tiles.w * line + tiles.x] + sums[tiles.z * line + tiles.y];
}
#endif

// Twice the area in squared subpixels: products of differences of 23 bits, which double holds exactly.
double area(ivec2 a, ivec2 b, ivec2 c) {
  dvec2 ab = dvec2(b - a);
  dvec2 ac = dvec2(c - a);
  return ab.x * ac.y - ab.y * ac.x;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint first_vertex = gl_WorkGroupID.x * cells_of_group * vertices_per_cell;
  uint vertices = 0u;  // of the group so far
  if (thread == 0u) cells_of_command = 0u;
  barrier();
  for (uint begin = 0u; begin < cells_of_group; begin += 256u) {
    uint place = first + gl_WorkGroupID.x * cells_of_group + begin + thread;
    ScreenVertex corners[4];
    float behind[4];  // of each vertex's opposite face, at the vertex; below 0 where it is a front face to be drawn
    float slope = 0.0;
    uint count = 0u;
    for (int k = 0; k < 4; ++k) behind[k] = 0.0;
    bool front[4] = bool[4](false, false, false, false);
    if (place < end) {
      uvec4 cell = tetrahedra[order[place].y];
      for (int k = 0; k < 4; ++k) corners[k] = projected[cell[k]];
      ivec4 box = pixels_between(
          min(min(corners[0].place, corners[1].place), min(corners[2].place, corners[3].place)),
          max(max(corners[0].place, corners[1].place), max(corners[2].place, corners[3].place)));
      bool wanted = !is_empty(box);
#ifdef MARKED
      wanted = wanted && meets_marked(box);
#endif
      if (wanted) {
        atomicAdd(cells_of_command, 1u);
        double areas[4];
        precise double volume = 0.0lf;
        precise double excess = 0.0lf;
        double largest = 0.0lf;
        for (int k = 0; k < 4; ++k) {
          ivec3 f = face_corners[k];
          areas[k] = area(corners[f.x].place, corners[f.y].place, corners[f.z].place);
          precise double weighted = areas[k] * double(corners[k].w);
          volume += weighted;
          precise double weighted_u = areas[k] * double(corners[k].u);
          excess += weighted_u;
          largest = max(largest, abs(weighted));
        }
        // What rounding alone would make; a segment that short adds nothing.
        if (abs(volume) > 1e-15lf * largest) {
          slope = float(excess / volume);
          for (int k = 0; k < 4; ++k) behind[k] = areas[k] == 0.0lf ? 0.0 : float(-volume / areas[k]);
          for (int k = 0; k < 4; ++k) {
            if (!(behind[k] < 0.0)) continue;
            ivec3 f = face_corners[k];
            ivec2 a = corners[f.x].place, b = corners[f.y].place, c = corners[f.z].place;
            front[k] = !is_empty(pixels_between(min(min(a, b), c), max(max(a, b), c)));
            count += front[k] ? 1u : 0u;
          }
        }
      }
    }
    // Triangles of the threads up to this one.
    triangles_of_threads[thread] = count;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
      uint before = thread >= step ? triangles_of_threads[thread - step] : 0u;
      barrier();
      triangles_of_threads[thread] += before;
      barrier();
    }
    uint at = first_vertex + vertices + 3u * (triangles_of_threads[thread] - count);
    vertices += 3u * triangles_of_threads[255];
    barrier();
    for (int k = 0; k < 4; ++k) {
      if (!front[k]) continue;
      ivec3 f = face_corners[k];
      for (int n = 0; n < 3; ++n) {
        ScreenVertex corner = corners[f[n]];
        vec3 ways;
        for (int m = 0; m < 3; ++m) {
          float way = behind[f[m]];
          ways[m] = !(way > 0.0) ? not_behind : (n == m ? way : 0.0);
        }
        faces[at] = FaceVertex(vec4(vec2(corner.place) / 256.0, corner.w, corner.u), vec4(ways, slope));
        ++at;
      }
    }
  }
  if (thread == 0u) {
    commands[first_command + gl_WorkGroupID.x] = Command(vertices, 1u, first_vertex, 0u, cells_of_command);
  }
}
