// The images of a place through the periodic boundaries of a box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/atoms.h"

namespace atomesh::gui {

// Made once for a box. Axes that are not periodic, and those of a box without volume, have no images.
class PeriodicImages {
 public:
  explicit PeriodicImages(const Box& box);

  // The shortest of `difference` and its images, whatever the shape of the box; itself where another is as short.
  Vec3 shortest(const Vec3& difference) const;

  // Calls visit(image) for every image of `difference`, itself included, that is no longer than `radius`.
  template <class Visit>
  void for_each_within(const Vec3& difference, double radius, Visit&& visit) const {
    if (rank_ == 0) {
      if (glm::dot(difference, difference) <= radius * radius) visit(difference);
      return;
    }
    // A vector of length r has at most r · |dual| of each of the lattice's vectors.
    std::array<double, 3> first{};
    std::array<double, 3> last{};
    for (std::size_t k = 0; k < rank_; ++k) {
      const double part = glm::dot(dual_[k], difference);
      const double reach = radius * dual_length_[k] + rounding;
      first[k] = std::ceil(-part - reach);
      last[k] = std::floor(-part + reach);
    }
    for (double i = first[0]; i <= last[0]; ++i) {
      for (double j = first[1]; j <= last[1]; ++j) {
        for (double k = first[2]; k <= last[2]; ++k) {
          const Vec3 image = difference + i * vectors_[0] + j * vectors_[1] + k * vectors_[2];
          if (glm::dot(image, image) <= radius * radius) visit(image);
        }
      }
    }
  }

 private:
  static constexpr double rounding = 1e-9;

  std::size_t rank_ = 0;           // periodic axes
  std::array<Vec3, 3> vectors_{};  // reduced: short, and as near to right angles as can be; zero from rank_ on
  std::array<Vec3, 3> dual_{};     // dot(dual[i], vectors[j]) = 1 where i = j, else 0
  std::array<double, 3> dual_length_{};
};

}  // namespace atomesh::gui
