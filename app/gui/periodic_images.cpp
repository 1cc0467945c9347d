#include "app/gui/periodic_images.h"

#include "core/unit_cell.h"

namespace atomesh::gui {

namespace {

// Volume over the product of lengths below which a box is flat.
constexpr double flatness = 1e-9;

bool spans(const std::array<Vec3, 3>& v) {
  const double volume = std::abs(glm::dot(v[0], glm::cross(v[1], v[2])));
  const double product = glm::length(v[0]) * glm::length(v[1]) * glm::length(v[2]);
  return std::isfinite(product) && product > 0.0 && volume > flatness * product;
}

Vec3 across(const Vec3& v) {
  const Vec3 axis = std::abs(v.x) <= std::abs(v.y) && std::abs(v.x) <= std::abs(v.z) ? Vec3(1, 0, 0)
                    : std::abs(v.y) <= std::abs(v.z)                                 ? Vec3(0, 1, 0)
                                                                                     : Vec3(0, 0, 1);
  return glm::normalize(glm::cross(v, axis)) * glm::length(v);
}

}  // namespace

PeriodicImages::PeriodicImages(const Box& box) {
  std::array<Vec3, 3> basis{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (box.periodic[k] && glm::length(box.vectors[k]) > 0.0) basis[count++] = box.vectors[k];
  }
  if (count == 0) return;
  // Vectors at right angles to the others take the places of those that are missing: reducing leaves them alone.
  if (count == 1) basis[1] = across(basis[0]);
  if (count <= 2) {
    const Vec3 normal = glm::cross(basis[0], basis[1]);
    if (!(glm::length(normal) > 0.0)) return;
    basis[2] = glm::normalize(normal) * glm::length(basis[0]);
  }
  if (!spans(basis)) return;
  const std::array<Vec3, 3> fillers{count < 2 ? basis[1] : Vec3(0.0), count < 3 ? basis[2] : Vec3(0.0), Vec3(0.0)};
  const std::array<Vec3, 3> reduced = reduce_lattice(basis);
  const Mat3 inverse = glm::inverse(Mat3(reduced[0], reduced[1], reduced[2]));
  for (std::size_t k = 0; k < 3; ++k) {
    const bool filler = std::any_of(fillers.begin(), fillers.end(), [&](const Vec3& f) {
      return std::abs(glm::dot(f, reduced[k])) > 0.5 * glm::dot(f, f) && glm::dot(f, f) > 0.0;
    });
    if (filler) continue;
    vectors_[rank_] = reduced[k];
    const int row = static_cast<int>(k);
    dual_[rank_] = Vec3(inverse[0][row], inverse[1][row], inverse[2][row]);
    dual_length_[rank_] = glm::length(dual_[rank_]);
    ++rank_;
  }
}

Vec3 PeriodicImages::shortest(const Vec3& difference) const {
  if (rank_ == 0) return difference;
  // A short one, by rounding; none shorter differs from the true one in anything but the part within the lattice.
  Vec3 within(0.0);
  for (std::size_t k = 0; k < rank_; ++k) {
    const double part = glm::dot(dual_[k], difference);
    within += (part - std::round(part)) * vectors_[k];
  }
  Vec3 lattice_part(0.0);
  for (std::size_t k = 0; k < rank_; ++k) lattice_part += glm::dot(dual_[k], difference) * vectors_[k];
  const Vec3 apart = difference - lattice_part;  // at right angles to the lattice
  Vec3 best = lattice_part;
  for_each_within(lattice_part, glm::length(within) * (1.0 + rounding), [&best](const Vec3& image) {
    if (glm::dot(image, image) < glm::dot(best, best) * (1.0 - rounding)) best = image;
  });
  return best == lattice_part ? difference : best + apart;
}

}  // namespace atomesh::gui
