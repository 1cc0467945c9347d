#include "app/cli/hard_case_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/renderer.h"

namespace atomesh::cli {

Parameters constant_density(Mode mode, double extinction) {
  const Vec4f color(1.0F, 0.5F, 0.25F, 1.0F);
  Parameters p;
  p.mode = mode;
  p.volume_surface.base_color = color;
  p.volume_surface.positional_multiplier = p.volume_surface.extra_multiplier = p.volume_surface.vacancy_multiplier =
      0.0;
  p.volume_surface.face_alpha = 0.0;
  p.volume_surface.alpha_length = p.volume.alpha_length = p.xray.alpha_length = extinction;
  p.volume.color_map.entries = {{0.0, color}, {1.0, color}};
  return p;
}

Parameters varying_density(Mode mode, const HardCase& hard) {
  const double size = bounds_of(hard.material.mesh.vertices).diagonal();
  Parameters p;
  p.mode = mode;
  p.volume_surface.alpha_length = p.volume.alpha_length = p.xray.alpha_length = 4.0 / size;
  p.volume_surface.base_color.a = 0.1F;
  p.volume_surface.face_alpha = 0.0;
  p.volume.color_map.entries = {{0.0, {0.1F, 0.2F, 0.9F, 0.1F}},
                                {0.3, {0.9F, 0.8F, 0.1F, 0.9F}},
                                {0.35, {0.1F, 0.9F, 0.2F, 0.0F}},
                                {0.6, {0.2F, 0.9F, 0.2F, 0.3F}},
                                {1.0, {1.0F, 0.1F, 0.0F, 1.0F}}};
  return p;
}

double granted_length(const HardCase& hard, Projection projection) {
  const double roundings = (projection == Projection::perspective ? 2.0 : 1.0) * granted_roundings;
  return roundings * 0x1p-24 * 0.5 * bounds_of(hard.material.mesh.vertices).diagonal();
}

// Of `known(ray)` over nine rays about the pixel's centre.
template <class Known>
KnownLengths::Range KnownLengths::around(int column, int row, Known known) const {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double right : {-beside_, 0.0, beside_}) {
    for (const double down : {-beside_, 0.0, beside_}) {
      const double value = known(ray(camera_, camera_.x_of(column + right), camera_.y_of(row + down)));
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  return range;
}

KnownLengths::KnownLengths(const HardCase& hard, const Camera& camera, double beside)
    : hard_(hard), camera_(camera), beside_(beside), granted_(granted_length(hard, camera.projection)) {
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      chords_.push_back(around(column, row, [&](const Ray& r) { return hard.solid.chord(r); }));
    }
  }
}

// A length of which `off` is wrong.
void KnownLengths::enter(std::size_t pixel, const Range& range, double found, double off, LengthError& error) const {
  if (range.high - range.low > 1e-3 * range.high) ++error.outline;
  if (range.high > 0.0) ++error.pixels;
  const bool counts = range.high >= 1e5 * granted_;
  double& worst = counts ? error.relative : error.granted;
  double measured = counts ? off / range.high : off / granted_;
  if (!std::isfinite(measured)) measured = std::numeric_limits<double>::infinity();
  if (measured <= worst) return;
  worst = measured;
  error.column = static_cast<int>(pixel) % camera_.width;
  error.row = static_cast<int>(pixel) / camera_.width;
  error.expected = found < range.low ? range.low : range.high;
  error.found = found;
}

LengthError KnownLengths::of_optical_depth(double extinction, const Image& image) const {
  LengthError error;
  for (std::size_t pixel = 0; pixel < chords_.size(); ++pixel) {
    const Range& chord = chords_[pixel];
    const Vec4f color = image.pixels[pixel];
    const double red = color.r;
    for (const double off : {red - static_cast<double>(color.a), 0.5 * red - static_cast<double>(color.g),
                             0.25 * red - static_cast<double>(color.b)}) {
      // What is not a number is as wrong as can be.
      error.color = std::max(error.color, std::isfinite(off) ? std::abs(off) : 1.0);
    }
    if (extinction * chord.low <= 3.0) {
      const double depth = -std::log1p(-std::min(red, 1.0));
      // Half a unit in the last place of the float that the picture holds is not the renderer's.
      const double rounding = 0x1p-24 * red / (1.0 - std::min(red, 0.99));
      const double off = chord.off(depth / extinction) - rounding / extinction;
      enter(pixel, chord, depth / extinction, off < 0.0 ? 0.0 : off, error);
    } else {
      const Range reds{-std::expm1(-extinction * chord.low), -std::expm1(-extinction * chord.high)};
      enter(pixel, chord, red, reds.off(red) * chord.high, error);
    }
  }
  return error;
}

LengthError KnownLengths::of_thickness(const std::vector<float>& thickness) const {
  LengthError error;
  for (std::size_t pixel = 0; pixel < chords_.size(); ++pixel) {
    const double found = thickness[pixel];
    enter(pixel, chords_[pixel], found, chords_[pixel].off(found), error);
  }
  return error;
}

LengthError KnownLengths::of_crossing(const std::vector<float>& depth) const {
  LengthError error;
  if (hard_.solid.bodies.size() != 1) return error;
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
    const int column = static_cast<int>(pixel) % camera_.width;
    const int row = static_cast<int>(pixel) / camera_.width;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;  // of the rays that meet something
    bool missed = false;
    // An eye in the boundary may see it or not: the ray is let begin a little earlier and later.
    for (const double later : {-granted_, 0.0, granted_}) {
      around(column, row, [&](Ray r) {
        r.origin += later * r.direction;
        const double found = hard_.solid.first_crossing(r) + later;
        nearest = std::min(nearest, found);
        if (std::isfinite(found)) farthest = std::max(farthest, found);
        missed = missed || !std::isfinite(found);
        return found;
      });
    }
    const double found = depth[pixel];
    if (std::isinf(found)) {
      if (!missed) enter(pixel, {nearest, farthest}, found, found, error);
    } else if (std::isinf(nearest)) {
      enter(pixel, {0.0, 0.0}, found, found, error);
    } else {
      const Range range{nearest, farthest};
      enter(pixel, range, found, range.off(found), error);
    }
  }
  return error;
}

double outside_of_colors(const Image& image) {
  double most = 0.0;
  for (const Vec4f& pixel : image.pixels) {
    for (int k = 0; k < 4; ++k) {
      const double value = pixel[k];
      most = std::max(most, std::isfinite(value) ? std::max(-value, value - 1.0) : 1.0);
    }
  }
  return most;
}

namespace {

Image judged(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  RenderStats stats;
  return find_renderer("reference").draw(scene, camera, parameters, stats, {}, no_progress());
}

}  // namespace

JudgedRays::JudgedRays(const Scene& scene, const Camera& camera, const Parameters& parameters, double beside)
    : scene_(scene),
      camera_(camera),
      parameters_(parameters),
      beside_(beside),
      centre_(judged(scene, camera, parameters)),
      low_(centre_),
      high_(centre_) {}

// Eight more pictures: only where the first does not settle it.
void JudgedRays::look_around() {
  around_ = true;
  for (const double right : {-1.0, 0.0, 1.0}) {
    for (const double up : {-1.0, 0.0, 1.0}) {
      const Image image = judged(scene_, moved_beside(camera_, right * beside_, up * beside_), parameters_);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        low_.pixels[i] = glm::min(low_.pixels[i], image.pixels[i]);
        high_.pixels[i] = glm::max(high_.pixels[i], image.pixels[i]);
      }
    }
  }
}

VariedError JudgedRays::error(const Image& image) {
  VariedError error;
  const auto largest = [](const Vec4f& d) {
    const double value = std::max({d.r, d.g, d.b, d.a});
    return std::isfinite(d.r + d.g + d.b + d.a) ? value : 1.0;
  };
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    error.centre = std::max(error.centre, largest(glm::abs(image.pixels[i] - centre_.pixels[i])));
  }
  if (!around_ && error.centre > 1e-6) look_around();
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const Vec4f pixel = image.at(column, row);
      const double off = largest(glm::max(low_.at(column, row) - pixel, pixel - high_.at(column, row)));
      if (off <= error.nearest) continue;
      error.nearest = off;
      error.column = column;
      error.row = row;
    }
  }
  return error;
}

}  // namespace atomesh::cli
