// Cut planes in the view: the outline of each enabled one and an arrow to drag it by.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"

namespace atomesh::gui {

struct CutHandle {
  std::size_t plane = 0;      // index into Parameters::cut_planes
  std::vector<Vec3> outline;  // plane ∩ bounds, Å, a convex polygon; empty where the plane misses the bounds
  Vec3 foot{0.0};  // of the arrow: the outline's middle, or the point of the plane next to the bounds' centre
  Vec3 tip{0.0};   // along the normal, towards what is cut away; as long at every zoom
};

// Of every enabled plane.
std::vector<CutHandle> cut_handles(const Parameters& parameters, const Bounds& bounds, const Camera& camera);

// The handle whose arrow is nearest to the place (canvas coordinates: the centre of the first pixel is (0.5, 0.5)), by
// which it can be gripped; index into `handles`.
std::optional<std::size_t> handle_at(const std::vector<CutHandle>& handles, const Camera& camera, double x, double y);

// The plane moved along its normal by what the mouse went, from one place of the picture to another: where the arrow
// was gripped follows the mouse along the arrow. (Seen along the arrow, upwards is outwards.) It stays within reach of
// the sample; the distance is rounded to 1/10,000 of the power of ten below the sample's size.
CutPlane moved_plane(const CutPlane& plane, const CutHandle& handle, const Bounds& bounds, const Camera& camera,
                     const glm::dvec2& from, const glm::dvec2& to);
// The plane turned about the handle's foot, the arrow's tip going with the mouse. The normal keeps its length; its
// components are rounded to 1/10,000 of it.
CutPlane tilted_plane(const CutPlane& plane, const CutHandle& handle, const Bounds& bounds, const Camera& camera,
                      const glm::dvec2& from, const glm::dvec2& to);

// Outlines and arrows, over `image` as draw_overlay() has it. `hot_plane` (CutHandle::plane) is the one whose handle is
// under the mouse, or dragged.
void draw_cut_handles(Image& image, int first_row, const Camera& camera, const Vec4f& background,
                      const std::vector<CutHandle>& handles, std::optional<std::size_t> hot_plane = std::nullopt);

}  // namespace atomesh::gui
