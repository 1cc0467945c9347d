// Cells' segments into lists, one a pixel.
layout(early_fragment_tests) in;

#include "cell_segment.glsl"
#include "list.glsl"

void main() {
  add_to_list(gl_FragCoord.z, cell_light());
}
