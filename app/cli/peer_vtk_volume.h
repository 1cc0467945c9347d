// VTK's volume mappers of tetrahedra, peers of our renderers for the bench: the same cells, scalars, colour map,
// optical model, camera and pixels.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "render/scene.h"

namespace atomesh::cli {

enum class VtkMapper {
  ray_cast,         // Bunyk's, as it comes: a table of 128 × 128 × 256 integrals, entries not interpolated
  ray_cast_linear,  // Bunyk's with VTK's most exact integrator, the closed form between the knots of the colour map
  z_sweep,          // Farias' sweep, with the same closed form
  projected_tetrahedra,  // Shirley and Tuchman's on OpenGL: colours of the vertices in 8 bits, cells by their centres
};
inline constexpr std::array vtk_mappers{VtkMapper::ray_cast, VtkMapper::ray_cast_linear, VtkMapper::z_sweep,
                                        VtkMapper::projected_tetrahedra};

// "VTK ray cast", "VTK ray cast, closed form", "VTK Z sweep", "VTK projected tetrahedra".
std::string_view vtk_mapper_name(VtkMapper mapper);

// How VTK is made to draw what we draw (VTK 9.1's sources):
//   - All its integrators take opacity(scalar) / ScalarOpacityUnitDistance for the extinction per length, so that the
//     unit distance is 1 / alpha_length. Where colour and opacity have knots their cells are cut there, projected
//     tetrahedra excepted, which know the colours of the vertices only.
//   - The window is cleared to transparent black, and what is read is premultiplied RGB and coverage.
//   - One ray a pixel (image sample distance 1, not adjusted). Ray cast casts it through the pixel's lower left corner:
//     the camera is moved by half a pixel so that it is our centre. Z sweep moves vertices to whole pixels, and its
//     camera is ours. On the window the pictures of both are stretched by half a pixel and thereby blurred; what is
//     taken is the mapper's own picture, before that.
//   - Near and far plane stand close about the sample.
// What remains is VTK's own: ray cast ends a ray at opacity 0.99 and cuts channels off to 8 bits; projected tetrahedra
// blend in float and hand over 8 bits; Z sweep's are float.
class VtkVolumeScene {
 public:
  // Copies a scene of mode volume into VTK's form. Needs a display (virtual_display.h). Throws UnavailableError without
  // one.
  VtkVolumeScene(const Scene& scene, const Parameters& parameters);
  ~VtkVolumeScene();
  VtkVolumeScene(const VtkVolumeScene&) = delete;
  VtkVolumeScene& operator=(const VtkVolumeScene&) = delete;

  // Draws the camera's picture and waits until it is done. The first drawing of a mapper builds what it keeps for the
  // later ones. Cannot be cancelled.
  void draw(VtkMapper mapper, const Camera& camera);
  // What was drawn last.
  Image image() const;
  // Who runs the projected tetrahedra, as OpenGL names it: "llvmpipe (LLVM 15.0.6, 256 bits)", a GPU. Once drawn.
  std::string driver() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace atomesh::cli
