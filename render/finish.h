// From what a renderer draws to finished pixels: the mean of a pixel's rays, and the background.
#pragma once

#include "render/renderer.h"
#include "render/sub_resolution.h"

namespace atomesh {

// A window of the picture whose pixels are rays, n × n for each pixel of the finished one: subsamples of pixel
// (column, row) stand in columns column·n … column·n+n-1, rows alike.
struct RayPicture {
  Image image;
  std::vector<float> thickness;
  std::vector<float> depth;
  std::vector<Index> id;

  // Those of its own that `wanted` asks for.
  Channels channels(const Channels& wanted);
};

// The camera whose pixels are the rays of `camera`'s.
Camera ray_camera(const Camera& camera, int n);
PixelWindow ray_window(const PixelWindow& window, int n);

// Throws UsageError for a picture without pixels, or without rays in them.
void check_picture(const Camera& camera, const Parameters& parameters);

// The finished picture; what the rays hold is used up. Channels the mode does not have are left as they are.
Image finish(RayPicture&& rays, int n, const Vec4f& background, const Channels& channels);

// The same of rays that are drawn as far as `drawn` says: the picture of rays starts at the picture's first pixel. An
// `image` of the right size is written over, which saves the system's handing out of memory.
void finish_spread(const RayPicture& rays, const SubResolution& drawn, int n, const Vec4f& background, Image& image);
void spread_channels(const RayPicture& rays, const SubResolution& drawn, int n, const Channels& channels);

// A window of the finished picture, see render().
Image render_window(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
                    const PixelWindow& window, RenderStats& stats, const Channels& channels, Progress& progress);

}  // namespace atomesh
