// How far pictures of the hard cases (samples/hard_cases.h) are off what is known about them: the measure of their test
// and of bench error.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/image.h"
#include "core/parameters.h"
#include "render/scene.h"
#include "samples/hard_cases.h"

namespace atomesh::cli {

// Every point of the matter of one colour, (1, 1/2, 1/4), and this extinction (1/Å); no layers.
Parameters constant_density(Mode mode, double extinction);
// Values that differ from vertex to vertex, a colour map with knots; a few optical depths through the sample; no
// layers.
Parameters varying_density(Mode mode, const HardCase& hard);

// Floats about a sample of half-diameter R carry depths to 2⁻²⁴ R each; so many of them are granted to a length, which
// is the difference of two, however short it is. Twice as many in perspective, where floats carry the reciprocal.
inline constexpr double granted_roundings = 8.0;
// Å: what is granted, of a length in this sample.
double granted_length(const HardCase& hard, Projection projection);

// Cell projection's: floats that count the pixels of a tile of 32.
inline constexpr double fast_rays_beside = 0x1p-18;

// Rays of different renderers pass a little beside the pixel's centre. What is known of a pixel is therefore the range
// over rays within `beside` pixels of its centre: a point wherever it is smooth; the outline's pixels, over which it
// jumps, are counted.
struct LengthError {
  double relative = 0.0;   // largest, where the length is at least 1e5 times granted_length()
  double granted = 0.0;    // largest of the other lengths, in units of granted_length()
  double color = 0.0;      // largest difference of A, G and B from what the red channel says they are
  std::size_t pixels = 0;  // that meet matter
  std::size_t outline = 0;
  int column = 0, row = 0;             // of the largest error, relative or granted
  double expected = 0.0, found = 0.0;  // there, Å
};

class KnownLengths {
 public:
  // Keeps a reference to the case.
  KnownLengths(const HardCase& hard, const Camera& camera, double beside);

  // Of a picture of constant_density(), premultiplied without background. The optical depth τ is taken from the red
  // channel, which is 1 - exp(-τ) and for thin matter as precise as floats are; beyond 3 it says little about τ, and
  // then the picture's own error in R counts as `relative`.
  LengthError of_optical_depth(double extinction, const Image& image) const;
  // Of xray's channel, Å.
  LengthError of_thickness(const std::vector<float>& thickness) const;
  // Of the surface mode's channel: Å along forward of the nearest crossing; infinity where there is none. Cases whose
  // bodies touch or overlap have no answer: nothing is measured there.
  LengthError of_crossing(const std::vector<float>& depth) const;

 private:
  struct Range {
    double low;
    double high;
    // Infinity for what is not a number.
    double off(double value) const {
      return std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max({0.0, low - value, value - high});
    }
  };
  template <class Known>
  Range around(int column, int row, Known known) const;
  void enter(std::size_t pixel, const Range& range, double found, double off, LengthError& error) const;

  const HardCase& hard_;
  Camera camera_;
  double beside_;
  double granted_;  // Å
  std::vector<Range> chords_;
};

// How far channels are outside of [0,1], 1 where one is not a number: for cases of which nothing else is known.
double outside_of_colors(const Image& image);

// The judge's picture of varying_density() along rays within `beside` pixels of the centre, as far as needed to say how
// far `image` is off the nearest of them.
struct VariedError {
  double centre = 0.0;      // largest difference from the judge's own ray through the pixel's centre
  double nearest = 0.0;     // largest difference from the range of the judge's rays nearby
  int column = 0, row = 0;  // of `nearest`
};
class JudgedRays {
 public:
  // Keeps references.
  JudgedRays(const Scene& scene, const Camera& camera, const Parameters& parameters, double beside);
  VariedError error(const Image& image);

 private:
  void look_around();

  const Scene& scene_;
  const Camera& camera_;
  Parameters parameters_;
  double beside_;
  bool around_ = false;
  Image centre_, low_, high_;
};

}  // namespace atomesh::cli
