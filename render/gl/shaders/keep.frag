// Cells' segments into the k-buffer of their pixel.
layout(early_fragment_tests) in;

#include "cell_segment.glsl"
#include "kept_fragments.glsl"

void main() {
  vec4 light = cell_light();
  BEGIN_IN_ORDER;
  keep(gl_FragCoord.z, light);
  END_IN_ORDER;
}
