// The balls one ray meets, nearest first, as far as the eye reaches.
#pragma once

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

// Hits in any order in, the visible ones in order out. Two balls at one length are in order of their index.
class BallHits {
 public:
  struct Hit {
    double length;  // Å along the ray
    Index ball;
    double opacity;
    double left = 1.0;  // share of the light from behind that comes through this hit and those before it
  };

  // Behind the hit at which no more than `least_light` is left, nothing is kept.
  explicit BallHits(double least_light) : least_light_(least_light) {}

  void clear() {
    hits_.clear();
    reach_ = std::numeric_limits<double>::infinity();
  }
  // Length beyond which no hit can be seen any more.
  double reach() const { return reach_; }
  const std::vector<Hit>& hits() const { return hits_; }

  // A ball already there is not taken twice. Cheapest for hits that come roughly in order.
  void add(double length, Index ball, double opacity) {
    if (length > reach_) return;
    std::size_t at = hits_.size();
    while (at > 0 && std::tie(length, ball) < std::tie(hits_[at - 1].length, hits_[at - 1].ball)) --at;
    if (at > 0 && hits_[at - 1].length == length && hits_[at - 1].ball == ball) return;
    if (at == hits_.size() && length == reach_) return;  // behind the last at the same length
    hits_.insert(hits_.begin() + static_cast<std::ptrdiff_t>(at), Hit{length, ball, opacity});
    double left = at > 0 ? hits_[at - 1].left : 1.0;
    for (std::size_t i = at; i < hits_.size(); ++i) {
      left *= 1.0 - hits_[i].opacity;
      hits_[i].left = left;
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
