// How far a picture is off the judge's (renderer "reference", double precision).
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::cli {

struct PictureError {
  double max = 0.0;  // largest absolute channel difference, channels in [0,1]
  double rmse = 0.0;
  double psnr = std::numeric_limits<double>::infinity();  // dB, -20 log10(rmse); infinity when equal
  std::size_t pixels = 0;                                 // judged
  int column = 0, row = 0;                                // of the largest difference
};

// The judge is slow, so of a picture he sees two lattices of pixels, which stand at different places of the blocks that
// the fast renderers work in: pixels/32 of it at stride 8. What he saw is kept: one scene, camera and set of parameters
// is judged once, whatever integrator (the judge has his own) and however many pictures are compared with it.
class BenchJudge {
 public:
  // `stride` 1, 2, 4 or 8; 1 judges every pixel.
  explicit BenchJudge(int stride = 8) : stride_(stride) {}

  // `picture` as Renderer::draw() returns it (premultiplied RGB and coverage, no background): RGBA is compared.
  // `scene_name` tells scenes apart; everything else about the view is in camera and parameters.
  PictureError error(const std::string& scene_name, const Scene& scene, const Camera& camera,
                     const Parameters& parameters, const Image& picture, Progress& progress = no_progress());
  // `picture` over an opaque background, as others draw it: RGB is compared.
  PictureError error_over(const Vec3f& background, const std::string& scene_name, const Scene& scene,
                          const Camera& camera, const Parameters& parameters, const Image& picture,
                          Progress& progress = no_progress());
  // Time the judge took so far, ms.
  double ms() const { return ms_; }

 private:
  struct Verdict {
    std::string scene_name;
    Camera camera;
    Parameters parameters;
    std::vector<PixelLattice> lattices;
    Image image;
  };
  const Verdict& verdict(const std::string& scene_name, const Scene& scene, const Camera& camera,
                         const Parameters& parameters, Progress& progress);

  int stride_;
  double ms_ = 0.0;
  std::deque<Verdict> verdicts_;  // the newest last, at most `kept`
  static constexpr std::size_t kept = 8;
};

}  // namespace atomesh::cli
