#include "app/cli/bench_judge.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"

namespace atomesh::cli {

namespace {

bool same_camera(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.forward == b.forward &&
         a.projection == b.projection && a.width == b.width && a.height == b.height && a.pixel == b.pixel;
}

// The judge knows no integrators.
Parameters judged(Parameters parameters) {
  parameters.integrator = Integrator::exact;
  parameters.samples_per_cell = 1;
  return parameters;
}

std::vector<PixelLattice> lattices_of(int stride) {
  if (stride == 1) return {{1, 1, 0, 0}};
  // Different lanes of a block of 4×4, and for larger strides different blocks.
  return {{stride, stride, stride - 1, 0}, {stride, stride, stride / 4, stride - 1 - stride / 4}};
}

template <class Difference>
PictureError judge(const std::vector<PixelLattice>& lattices, const Image& picture, int channels,
                   Difference difference) {
  PictureError error;
  double squares = 0.0;
  for (const PixelLattice& lattice : lattices) {
    for (int row = lattice.row_phase; row < picture.height; row += lattice.row_stride) {
      for (int column = lattice.column_phase; column < picture.width; column += lattice.column_stride) {
        const Vec4f d = difference(column, row);
        for (int k = 0; k < channels; ++k) {
          // What is not a number is as wrong as can be.
          const double off = std::isfinite(d[k]) ? std::abs(static_cast<double>(d[k])) : 1.0;
          squares += off * off;
          if (off <= error.max) continue;
          error.max = off;
          error.column = column;
          error.row = row;
        }
        ++error.pixels;
      }
    }
  }
  if (error.pixels == 0) return error;
  error.rmse = std::sqrt(squares / (static_cast<double>(channels) * static_cast<double>(error.pixels)));
  if (error.rmse > 0.0) error.psnr = -20.0 * std::log10(error.rmse);
  return error;
}

void check_size(const Camera& camera, const Image& picture) {
  if (picture.width == camera.width && picture.height == camera.height) return;
  throw Error("the judge was given a picture of " + std::to_string(picture.width) + "x" +
              std::to_string(picture.height) + " pixels for a camera of " + std::to_string(camera.width) + "x" +
              std::to_string(camera.height));
}

}  // namespace

const BenchJudge::Verdict& BenchJudge::verdict(const std::string& scene_name, const Scene& scene, const Camera& camera,
                                               const Parameters& parameters, Progress& progress) {
  const Parameters wanted = judged(parameters);
  const auto known = std::find_if(verdicts_.begin(), verdicts_.end(), [&](const Verdict& v) {
    return v.scene_name == scene_name && same_camera(v.camera, camera) && v.parameters == wanted;
  });
  if (known != verdicts_.end()) return *known;
  const auto start = std::chrono::steady_clock::now();
  Verdict fresh{scene_name, camera, wanted, lattices_of(stride_), Image(camera.width, camera.height)};
  RenderStats stats;
  const auto frame = find_renderer("reference").prepare(scene, camera, wanted, whole_picture(camera), stats, progress);
  for (const PixelLattice& lattice : fresh.lattices) frame->draw(lattice, fresh.image, stats, {}, progress);
  ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (verdicts_.size() == kept) verdicts_.pop_front();
  return verdicts_.emplace_back(std::move(fresh));
}

PictureError BenchJudge::error(const std::string& scene_name, const Scene& scene, const Camera& camera,
                               const Parameters& parameters, const Image& picture, Progress& progress) {
  check_size(camera, picture);
  const Verdict& right = verdict(scene_name, scene, camera, parameters, progress);
  return judge(right.lattices, picture, 4,
               [&](int column, int row) { return picture.at(column, row) - right.image.at(column, row); });
}

PictureError BenchJudge::error_over(const Vec3f& background, const std::string& scene_name, const Scene& scene,
                                    const Camera& camera, const Parameters& parameters, const Image& picture,
                                    Progress& progress) {
  check_size(camera, picture);
  const Verdict& right = verdict(scene_name, scene, camera, parameters, progress);
  return judge(right.lattices, picture, 3, [&](int column, int row) {
    const Vec4f seen = right.image.at(column, row);
    return picture.at(column, row) - (seen + (1.0F - seen.a) * Vec4f(background, 0.0F));
  });
}

}  // namespace atomesh::cli
