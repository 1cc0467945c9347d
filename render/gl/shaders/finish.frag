// From rays to pixels: the mean of n × n of them, or between rays that stand `stride` pixels apart the mean by
// distance; behind each ray what stands in the volume, and the background under it all. Colours are premultiplied.
uniform sampler2D rays;    // the upper row first
uniform sampler2D solids;  // what each ray ends at
uniform bool with_solids;
uniform ivec2 size;      // of what is drawn of it
uniform ivec2 corner;    // the first of the target's pixels that is drawn, as OpenGL counts
uniform int rows;        // of the target that are drawn
uniform int n;
uniform int stride;
uniform vec4 background;

out vec4 color;

vec4 ray(ivec2 at) {
  at = clamp(at, ivec2(0), size - 1);
  vec4 front = texelFetch(rays, at, 0);
  return with_solids ? front + (1.0 - front.a) * texelFetch(solids, at, 0) : front;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
  pixel.y = rows - 1 - pixel.y;
  vec4 sum = vec4(0.0);
  if (stride == 1) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) sum += ray(n * pixel + ivec2(i, j));
    }
    sum /= float(n * n);
  } else {
    ivec2 at = pixel / stride;
    vec2 part = vec2(pixel - stride * at) / float(stride);
    sum = mix(mix(ray(at), ray(at + ivec2(1, 0)), part.x), mix(ray(at + ivec2(0, 1)), ray(at + 1), part.x), part.y);
  }
  color = sum + (1.0 - sum.a) * background;
}
