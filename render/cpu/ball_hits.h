// The balls one ray meets, nearest first, as far as the eye reaches.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "render/scene.h"

namespace atomesh {

// Hits in any order in, the visible ones in order out. Two balls at one length are in order of their index.
class BallHits {
 public:
  struct Hit {
    double length;
    Index ball;
    double opacity;
  };

  // Behind the hit at which less than `least_light` of the light is left, nothing is kept.
  explicit BallHits(double least_light) : least_light_(least_light) {}

  void clear() {
    hits_.clear();
    reach_ = std::numeric_limits<double>::infinity();
  }
  // Length beyond which no hit can be seen any more.
  double reach() const { return reach_; }
  const std::vector<Hit>& hits() const { return hits_; }

  // A ball already there is not taken twice.
  void add(const Hit& hit) {
    if (hit.length > reach_) return;
    const auto place = std::lower_bound(hits_.begin(), hits_.end(), hit, [](const Hit& a, const Hit& b) {
      return std::tie(a.length, a.ball) < std::tie(b.length, b.ball);
    });
    if (place != hits_.end() && place->length == hit.length && place->ball == hit.ball) return;
    hits_.insert(place, hit);
    double left = 1.0;
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      left *= 1.0 - hits_[i].opacity;
      if (left > least_light_) continue;
      hits_.resize(i + 1);
      reach_ = hits_[i].length;
    }
  }

 private:
  double least_light_;
  double reach_ = std::numeric_limits<double>::infinity();
  std::vector<Hit> hits_;
};

}  // namespace atomesh
