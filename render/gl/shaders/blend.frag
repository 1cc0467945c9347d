// Cells front to back, composed by blending: what is behind shows through what is there.
#include "cell_segment.glsl"

out vec4 light;

void main() {
  light = cell_light();
}
