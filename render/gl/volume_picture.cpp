#include "render/gl/volume_picture.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/finish.h"
#include "render/gl/objects.h"
#include "render/gl/state_guard.h"
#include "render/gl/volume.h"

namespace atomesh::gl {

namespace {

// Errors that whoever used the context before has left are not ours.
void forget_errors() {
  // A lost context would report itself for ever.
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) {
  }
}

}  // namespace

void require_living_context() {
  GLenum status = GL_NO_ERROR;
  if (epoxy_gl_version() >= 45) {
    status = glGetGraphicsResetStatus();
  } else if (epoxy_has_gl_extension("GL_ARB_robustness")) {
    status = glGetGraphicsResetStatusARB();
  }
  if (status != GL_NO_ERROR) throw UnavailableError("OpenGL: the context is lost, the graphics card was reset");
}

class VolumePicture::Pipeline {
 public:
  explicit Pipeline(int part_side)
      : finish_(Program::draw("whole_window.vert", "finish.frag")),
        vertex_array_(make_vertex_array()),
        part_side_(std::min(part_side, volume_.largest_side())) {}

  Volume& volume() { return volume_; }
  int part_side() const { return part_side_; }

  // Lays the volume's texture over the background: `n` × `n` of its pixels for each of the target's, or one for
  // `stride` × `stride`.
  void lay_over_background(const Camera& camera, const PixelWindow& pixels, const Vec4f& background, int n, int stride,
                           GLuint target) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    // OpenGL counts rows from below.
    const int bottom = camera.height - pixels.top - pixels.height;
    glViewport(pixels.left, bottom, pixels.width, pixels.height);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (const GLenum off : {GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) glDisable(off);
    finish_.use();
    volume_.texture().bind(0);
    glUniform1i(finish_.uniform("rays"), 0);
    glUniform2i(finish_.uniform("size"), volume_.columns(), volume_.rows());
    glUniform2i(finish_.uniform("corner"), pixels.left, bottom);
    glUniform1i(finish_.uniform("rows"), pixels.height);
    glUniform1i(finish_.uniform("n"), n);
    glUniform1i(finish_.uniform("stride"), stride);
    const float a = background.a;
    glUniform4f(finish_.uniform("background"), background.r * a, background.g * a, background.b * a, a);
    glBindVertexArray(vertex_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  Volume volume_;
  Program finish_;
  VertexArray vertex_array_;
  int part_side_;
};

VolumePicture::VolumePicture(int part_side) : pipeline_(std::make_unique<Pipeline>(part_side)) {}
VolumePicture::~VolumePicture() = default;

void VolumePicture::set_scene(std::shared_ptr<const Scene> scene) {
  if (scene->mode != Mode::volume || scene->solids != nullptr) {
    throw UsageError("a volume's picture: mode " + std::string(mode_name(scene->mode)) +
                     (scene->solids != nullptr ? " with something in it" : "") + " is not drawn here");
  }
  if (scene == scene_) return;
  begun_.reset();
  pipeline_->volume().set_scene(*scene);
  scene_ = std::move(scene);
}

void VolumePicture::begin(const Camera& camera, const Parameters& parameters, const PictureDetail& detail) {
  check_picture(camera, parameters);
  last_ = {};
  begun_ = Begun{.camera = camera, .parameters = parameters, .detail = detail};
}

bool VolumePicture::proceed(double milliseconds, Progress& progress) {
  if (!begun_) return true;
  const auto start = std::chrono::steady_clock::now();
  forget_errors();
  const StateGuard guard;
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  // Dropped where something is thrown.
  Begun begun = std::move(*begun_);
  begun_.reset();
  const Camera& camera = begun.camera;
  const int stride = begun.detail.stride;
  const int n = stride == 1 ? begun.parameters.supersampling : 1;
  // Of whole pixels, and such that a part's rays begin with a pixel that the lattice has.
  const int side = std::max(1, pipeline_->part_side() / n) * stride;
  Volume& volume = pipeline_->volume();
  while (begun.top < camera.height) {
    const PixelWindow part{begun.left, begun.top, std::min(side, camera.width - begun.left),
                           std::min(side, camera.height - begun.top)};
    if (!begun.in_part) volume.begin(ray_camera(camera, n), begun.parameters, ray_window(part, n), {stride, stride});
    begun.in_part = true;
    RenderStats stats;
    const double rest = std::max(milliseconds - ms_since(start), 0.0);
    if (!volume.proceed(rest, stats, progress)) {
      require_living_context();
      begun_ = std::move(begun);
      return false;
    }
    const VolumeStats& times = volume.last();
    last_.cells += times.project_ms + times.order_ms + times.faces_ms;
    last_.pixels += times.draw_ms + times.repair.ms;
    const auto finishing = std::chrono::steady_clock::now();
    pipeline_->lay_over_background(camera, part, begun.parameters.background, n, stride, static_cast<GLuint>(target));
    glFinish();
    last_.pixels += ms_since(finishing);
    begun.in_part = false;
    begun.left += side;
    if (begun.left >= camera.width) {
      begun.left = 0;
      begun.top += side;
    }
  }
  require_living_context();
  check_errors("finishing the picture");
  return true;
}

void VolumePicture::draw(const Camera& camera, const Parameters& parameters, const PictureDetail& detail,
                         Progress& progress) {
  begin(camera, parameters, detail);
  proceed(std::numeric_limits<double>::infinity(), progress);
}

}  // namespace atomesh::gl
