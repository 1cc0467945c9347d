#include "app/cli/simplify_pictures.h"

#include <array>

#include "core/camera.h"
#include "core/parameters.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::cli {

namespace {

constexpr std::array modes{Mode::volume_surface, Mode::volume};
// None along an axis of the crystal's cell alone, where a change could hide behind itself.
constexpr std::array<std::string_view, 6> views{"front", "left", "top", "iso", "200,-35", "110,65"};

template <class Use>
void for_each_picture(const Material& material, Progress& progress, Use&& use) {
  const Renderer& renderer = find_renderer("auto");
  for (const Mode mode : modes) {
    Parameters parameters;
    parameters.mode = mode;
    const Scene scene = make_scene(material, parameters, progress);
    for (const std::string_view view : views) {
      set_view(parameters, view);
      const Camera camera = make_camera(parameters, scene.bounds, SimplifyPictures::size, SimplifyPictures::size);
      RenderStats stats;
      use(mode, view, render(renderer, scene, camera, parameters, stats, {}, progress));
    }
  }
}

}  // namespace

void SimplifyPictures::draw(const Material& material, Progress& progress) {
  pictures_.clear();
  for_each_picture(material, progress,
                   [&](Mode, std::string_view, Image picture) { pictures_.push_back(std::move(picture)); });
}

SimplifyPictures::Difference SimplifyPictures::compare(const Material& material, Progress& progress) const {
  Difference worst;
  std::size_t next = 0;
  for_each_picture(material, progress, [&](Mode mode, std::string_view view, const Image& picture) {
    const double difference = compare_images(pictures_[next++], picture).max;
    if (difference <= worst.max) return;
    worst.max = difference;
    worst.where = std::string(mode_name(mode)) + " " + std::string(view);
  });
  return worst;
}

}  // namespace atomesh::cli
