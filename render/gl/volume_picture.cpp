#include "render/gl/volume_picture.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/finish.h"
#include "render/gl/objects.h"
#include "render/gl/solid_rays.h"
#include "render/gl/state_guard.h"
#include "render/gl/volume.h"

namespace atomesh::gl {

namespace {

// Solids of a view that is drawn again are kept up to so many bytes.
constexpr std::size_t kept_bytes = std::size_t{512} << 20;

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

namespace {

// What stands in the volume, on the card: of the parts of one picture, or of the one that is drawn.
class SolidLayer {
 public:
  // Of a part's rays.
  struct Part {
    SolidView view;
    Texture colors;  // RGBA32F, larger than the part where it was used before
    std::vector<float> ends;
  };

  // Before the parts of a picture: `rays` of them all.
  void begin(std::size_t parts, std::size_t rays) {
    keep_ = rays * (sizeof(Vec4f) + sizeof(float)) <= kept_bytes;
    if (!keep_) parts = 1;
    if (parts_.size() > parts) parts_.resize(parts);
    while (parts_.size() < parts) parts_.emplace_back();
  }
  // Part `number` of the picture, the one before no longer where they are not kept. Goes on for about so many
  // milliseconds; false where it is not there yet. Adds to `times`.
  bool make(std::size_t number, const std::shared_ptr<const Scene>& solids, const SolidView& view, double milliseconds,
            VolumePicture::Times& times, Progress& progress) {
    Part& part = parts_[keep_ ? number : 0];
    if (!part.ends.empty() && same_solids(part.view, view)) return true;
    part.ends.clear();
    std::optional<SolidRays> rays = drawing_.proceed(solids, view, milliseconds, progress);
    if (!rays) return false;
    const auto start = std::chrono::steady_clock::now();
    upload(rays->colors, LatticeGrid(view.lattice, view.window), part.colors);
    part.view = view;
    part.ends = std::move(rays->ends);
    times.solids += rays->setup_ms;
    times.pixels += rays->render_ms + ms_since(start);
    return true;
  }
  // As it was made.
  const Part& part(std::size_t number) const { return parts_[keep_ ? number : 0]; }
  void cancel() { drawing_.cancel(); }
  void forget() {
    parts_.clear();
    drawing_.forget();
  }

 private:
  static void upload(const std::vector<Vec4f>& colors, const LatticeGrid& grid, Texture& to) {
    if (to.width() < grid.columns() || to.height() < grid.rows()) {
      const int width = std::max(grid.columns(), to.width());
      const int height = std::max(grid.rows(), to.height());
      to = Texture();
      to = Texture::make_2d(GL_RGBA32F, width, height);
    }
    to.bind(0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, grid.columns(), grid.rows(), GL_RGBA, GL_FLOAT, colors.data());
    check_errors("what stands in the volume");
  }

  SolidDrawing drawing_;
  std::vector<Part> parts_;
  bool keep_ = false;
};

}  // namespace

class VolumePicture::Pipeline {
 public:
  explicit Pipeline(int part_side)
      : finish_(Program::draw("whole_window.vert", "finish.frag")),
        vertex_array_(make_vertex_array()),
        part_side_(std::min(part_side, volume_.largest_side())) {}

  Volume& volume() { return volume_; }
  // Pictures of few rays leave what is kept of the whole one alone.
  SolidLayer& solids(const PictureDetail& detail) { return detail.stride == 1 ? whole_solids_ : coarse_solids_; }
  void cancel_solids() {
    whole_solids_.cancel();
    coarse_solids_.cancel();
  }
  void forget_solids() {
    whole_solids_.forget();
    coarse_solids_.forget();
  }
  int part_side() const { return part_side_; }

  // Lays the volume's texture over what stands in it, where that is not null, and the background: `n` × `n` of its
  // pixels for each of the target's, or one for `stride` × `stride`.
  void lay_over_background(const Camera& camera, const PixelWindow& pixels, const Texture* solids,
                           const Vec4f& background, int n, int stride, GLuint target) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    // OpenGL counts rows from below.
    const int bottom = camera.height - pixels.top - pixels.height;
    glViewport(pixels.left, bottom, pixels.width, pixels.height);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (const GLenum off : {GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) glDisable(off);
    finish_.use();
    volume_.texture().bind(0);
    glUniform1i(finish_.uniform("rays"), 0);
    if (solids != nullptr) solids->bind(1);
    glUniform1i(finish_.uniform("solids"), solids != nullptr ? 1 : 0);
    glUniform1i(finish_.uniform("with_solids"), solids != nullptr ? 1 : 0);
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
  SolidLayer whole_solids_;
  SolidLayer coarse_solids_;
  Program finish_;
  VertexArray vertex_array_;
  int part_side_;
};

// A picture in parts.
struct VolumePicture::Layout {
  Layout(const Begun& begun, int part_side)
      : picture(begun.camera),
        stride(begun.detail.stride),
        n(stride == 1 ? begun.parameters.supersampling : 1),
        side(std::max(1, part_side / n) * stride),
        rays(ray_camera(begun.camera, n)),
        lattice{stride, stride} {}

  // The first that is not finished.
  PixelWindow part(const Begun& begun) const {
    return {begun.left, begun.top, std::min(side, picture.width - begun.left),
            std::min(side, picture.height - begun.top)};
  }
  std::size_t parts() const {
    const auto along = [this](int length) { return static_cast<std::size_t>((length + side - 1) / side); };
    return along(picture.width) * along(picture.height);
  }
  std::size_t all_rays() const { return LatticeGrid(lattice, whole_picture(rays)).pixels(); }

  const Camera& picture;
  int stride;
  int n;  // × n rays a pixel
  // Of a part, in pixels: whole ones, and such that a part's rays begin with a pixel that the lattice has.
  int side;
  Camera rays;
  PixelLattice lattice;
};

VolumePicture::VolumePicture(int part_side) : pipeline_(std::make_unique<Pipeline>(part_side)) {}
// A thread of its may still look at the scene.
VolumePicture::~VolumePicture() {
  pipeline_.reset();
}

void VolumePicture::set_scene(std::shared_ptr<const Scene> scene) {
  if (scene->mode != Mode::volume) {
    throw UsageError("a volume's picture: mode " + std::string(mode_name(scene->mode)) + " is not drawn here");
  }
  if (scene == scene_) return;
  begun_.reset();
  pipeline_->forget_solids();
  pipeline_->volume().set_scene(*scene);
  scene_ = std::move(scene);
}

void VolumePicture::begin(const Camera& camera, const Parameters& parameters, const PictureDetail& detail) {
  check_picture(camera, parameters);
  give_up();
  last_ = {};
  begun_ = Begun{.camera = camera, .parameters = parameters, .detail = detail};
}

// False where what stands in the volume is not ready yet.
bool VolumePicture::begin_part(const Begun& begun, const Layout& layout, double milliseconds, Progress& progress) {
  const PixelWindow window = ray_window(layout.part(begun), layout.n);
  std::span<const float> ray_ends;
  if (scene_->solids != nullptr) {
    SolidLayer& layer = pipeline_->solids(begun.detail);
    if (begun.number == 0) layer.begin(layout.parts(), layout.all_rays());
    // They borrow of the material, as the volume's scene does, which therefore stays with them.
    const std::shared_ptr<const Scene> solids(scene_, scene_->solids.get());
    const SolidView view{layout.rays, begun.parameters, window, layout.lattice};
    if (!layer.make(begun.number, solids, view, milliseconds, last_, progress)) return false;
    ray_ends = layer.part(begun.number).ends;
  }
  pipeline_->volume().begin(layout.rays, begun.parameters, window, layout.lattice, ray_ends);
  return true;
}

// Lays what is drawn over what stands in the volume and the background.
void VolumePicture::finish_part(const Begun& begun, const Layout& layout, unsigned target) {
  const VolumeStats& times = pipeline_->volume().last();
  last_.cells += times.project_ms + times.order_ms + times.faces_ms;
  last_.pixels += times.draw_ms + times.repair.ms;
  const auto start = std::chrono::steady_clock::now();
  const Texture* solids =
      scene_->solids != nullptr ? &pipeline_->solids(begun.detail).part(begun.number).colors : nullptr;
  pipeline_->lay_over_background(begun.camera, layout.part(begun), solids, begun.parameters.background, layout.n,
                                 layout.stride, target);
  glFinish();
  last_.pixels += ms_since(start);
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
  const Layout layout(begun, pipeline_->part_side());
  while (begun.top < begun.camera.height) {
    const auto rest = [&] { return std::max(milliseconds - ms_since(start), 0.0); };
    if (!begun.in_part) begun.in_part = begin_part(begun, layout, rest(), progress);
    RenderStats stats;
    if (!begun.in_part || !pipeline_->volume().proceed(rest(), stats, progress)) {
      require_living_context();
      begun_ = std::move(begun);
      return false;
    }
    finish_part(begun, layout, static_cast<GLuint>(target));
    begun.in_part = false;
    ++begun.number;
    begun.left += layout.side;
    if (begun.left >= begun.camera.width) {
      begun.left = 0;
      begun.top += layout.side;
    }
  }
  require_living_context();
  check_errors("finishing the picture");
  return true;
}

void VolumePicture::give_up() {
  begun_.reset();
  pipeline_->volume().give_up();
  pipeline_->cancel_solids();
}

void VolumePicture::draw(const Camera& camera, const Parameters& parameters, const PictureDetail& detail,
                         Progress& progress) {
  begin(camera, parameters, detail);
  proceed(std::numeric_limits<double>::infinity(), progress);
}

}  // namespace atomesh::gl
