// A sum of doubles whose rounding error does not grow with the number of terms (Neumaier 1974).
#pragma once

#include <cmath>

namespace atomesh {

class CompensatedSum {
 public:
  void add(double term) {
    const double next = sum_ + term;
    if (std::abs(sum_) >= std::abs(term)) {
      tail_ += (sum_ - next) + term;
    } else {
      tail_ += (term - next) + sum_;
    }
    sum_ = next;
  }
  double value() const { return sum_ + tail_; }

 private:
  double sum_ = 0.0;
  double tail_ = 0.0;
};

}  // namespace atomesh
