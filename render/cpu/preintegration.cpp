#include "render/shared/preintegration.h"

#include <vector>

#include "render/shared/segment.h"

namespace atomesh::optics {

const float* psi_table() {
  static const std::vector<float> table = [] {
    std::vector<float> entries;
    const auto density = [](int i) {
      const double gamma = i / (psi_size - 1.0) * double{psi_deepest} / (double{psi_bend} + double{psi_deepest});
      return static_cast<float>(double{psi_bend} * gamma / (1.0 - gamma));
    };
    for (int i = 0; i < psi_size; ++i) {
      for (int j = 0; j < psi_size; ++j) {
        const SegmentLight segment = integrate_segment(density(i), density(j));
        entries.push_back(segment.far_weight + segment.transmittance);
      }
    }
    return entries;
  }();
  return table.data();
}

}  // namespace atomesh::optics
