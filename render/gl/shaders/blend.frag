// Cells front to back, composed by blending: what is behind shows through what is there.
#ifdef RAMPS
#include "ramp_segment.glsl"
#else
#include "cell_segment.glsl"
#endif

out vec4 light;

void main() {
  light = cell_light();
}
