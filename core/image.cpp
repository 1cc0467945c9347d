#include "core/image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace atomesh {

namespace {

void check_same_size(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw Error("the pictures differ in size: " + std::to_string(a.width) + "x" + std::to_string(a.height) + " and " +
              std::to_string(b.width) + "x" + std::to_string(b.height));
}

// A channel that is not a number differs from everything, so that a broken picture never passes as equal.
double channel_difference(float a, float b) {
  const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(difference) ? 1.0 : difference;
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, double tolerance) {
  check_same_size(a, b);
  ImageDifference result;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    double largest = 0.0;
    for (int c = 0; c < 4; ++c) {
      const double difference = channel_difference(a.pixels[i][c], b.pixels[i][c]);
      largest = std::max(largest, difference);
      sum += difference * difference;
    }
    result.max = std::max(result.max, largest);
    if (largest > tolerance) ++result.pixels_over;
  }
  const double channels = 4.0 * static_cast<double>(a.pixels.size());
  result.rmse = channels > 0.0 ? std::sqrt(sum / channels) : 0.0;
  result.psnr = result.rmse > 0.0 ? -20.0 * std::log10(result.rmse) : std::numeric_limits<double>::infinity();
  return result;
}

Image difference_picture(const Image& a, const Image& b, double gain) {
  check_same_size(a, b);
  Image picture(a.width, a.height);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    // A difference in opacity alone must be seen too: it shows in all three channels.
    const double opacity = channel_difference(a.pixels[i][3], b.pixels[i][3]);
    for (int c = 0; c < 3; ++c) {
      const double difference = std::max(channel_difference(a.pixels[i][c], b.pixels[i][c]), opacity);
      picture.pixels[i][c] = static_cast<float>(std::min(1.0, gain * difference));
    }
    picture.pixels[i][3] = 1.0F;
  }
  return picture;
}

}  // namespace atomesh
