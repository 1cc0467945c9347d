// ScreenVertex of render/gl/screen_mesh.h.
struct ScreenVertex {
  ivec2 place;  // column and row in subpixels from the grid's middle
  float w;
  float u;
};
