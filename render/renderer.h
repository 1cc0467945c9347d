// The renderers by name, and the one function that draws a picture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/pixel_lattice.h"
#include "render/scene.h"

namespace atomesh {

struct RenderStats {
  double setup_ms = 0.0;   // acceleration structures, projection, sorting
  double render_ms = 0.0;  // the pixels
  std::uint64_t steps = 0;  // ray–primitive intersections that contributed (ray–tetrahedron steps in the volume modes)
};

// Optional per-pixel outputs beside the colour, row-major like the image; filled when the caller sets the pointer.
struct Channels {
  std::vector<float>* thickness = nullptr;  // xray: Å of the ray inside the sample
  std::vector<float>* depth =
      nullptr;  // surface, atoms: depth along Camera::forward of the nearest hit, infinity where none
  std::vector<Index>* id =
      nullptr;  // surface: triangle, atoms: atom (Ball::atom) of the nearest hit; no_index where none
  // Not an output: mode volume, of the window's size: depth at which each pixel's ray ends, because something opaque
  // stands there (with_solids()); infinity where nothing does.
  const std::vector<float>* ray_end = nullptr;
};

// A window of one view of one scene, prepared: projected, sorted into tiles, whatever the renderer needs to draw any of
// its pixels, as often as asked and in any portions. Keeps references to scene, camera and parameters.
//
// The value of a pixel is the same to the last bit whichever window it was prepared in, whichever lattice it is drawn
// with, and for any number of threads: pictures drawn progressively or in passes are the direct one.
class Frame {
 public:
  virtual ~Frame() = default;
  // Sets the lattice's pixels in `image`, which has the window's size (its first pixel is the window's), and leaves the
  // others as they are. Premultiplied RGB and coverage A, 0 where the ray meets nothing. A channel the mode does not
  // have is left empty; one it has and that is not of the window's size yet is first filled with "nothing there".
  // Progress goes from 0 to 1 in each call; times and steps are added to `stats`. Throws CancelledError, and then the
  // lattice's pixels are partly drawn.
  virtual void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
                    Progress& progress) const = 0;
};

// A renderer draws all five modes of a Scene ("havs": volume, and throws UsageError for the others). It returns the
// picture over a transparent background: premultiplied RGB and coverage A (0 where the ray meets nothing), so that the
// background is laid under it in one place.
class Renderer {
 public:
  virtual ~Renderer() = default;
  virtual std::string_view name() const = 0;
  // Time is added to stats.setup_ms. The window lies within the picture. Throws CancelledError.
  virtual std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                         const PixelWindow& window, RenderStats& stats, Progress& progress) const = 0;
  // Prepares and draws the camera's width × height.
  Image draw(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
             const Channels& channels, Progress& progress) const;
};

// "reference", "cpu", "havs"; "auto" picks the first of cpu, reference that this build has. Throws UsageError listing
// the names, UnavailableError (listing them too) for "cuda".
const Renderer& find_renderer(std::string_view name);
// Of those that draw every mode.
std::vector<std::string> renderer_names();

// The final picture: draws with n×n rays a pixel where asked (Parameters::supersampling; the rays stand on a regular
// grid in the pixel) and averages premultiplied colours, lays the background under, and divides by the coverage (Image
// is not premultiplied). With supersampling the channel thickness is the mean of the pixel's rays; depth and id are
// those of the ray at the pixel's centre (the one right and below of it where n is even). Throws UsageError for a
// picture without pixels.
Image render(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
             RenderStats& stats, const Channels& channels = {}, Progress& progress = no_progress());

}  // namespace atomesh
