#include "render/renderer.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "render/finish.h"
#include "render/gl/havs_renderer.h"

namespace atomesh {

namespace {

struct Entry {
  std::string_view name;
  const Renderer& (*get)();
};

// In the order `auto` prefers them.
const std::vector<Entry>& registry() {
  static const std::vector<Entry> entries{{"cpu", cpu_renderer}, {"reference", reference_renderer}};
  return entries;
}

// Those of some modes only, asked for by name.
const std::vector<Entry>& special_registry() {
  static const std::vector<Entry> entries{{"havs", havs_renderer}};
  return entries;
}

// Renderers with a name of their own that other builds may have.
constexpr std::array<std::string_view, 1> elsewhere{"cuda"};

std::string listed_names() {
  std::string list = "auto";
  for (const Entry& entry : registry()) list += ", " + std::string(entry.name);
  for (const Entry& entry : special_registry()) list += ", " + std::string(entry.name);
  return list;
}

}  // namespace

Image Renderer::draw(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                     const Channels& channels, Progress& progress) const {
  Image image(camera.width, camera.height);
  prepare(scene, camera, parameters, whole_picture(camera), stats, progress)
      ->draw({}, image, stats, channels, progress);
  return image;
}

const Renderer& find_renderer(std::string_view name) {
  for (const Entry& entry : registry()) {
    if (entry.name == name || name == "auto") return entry.get();
  }
  for (const Entry& entry : special_registry()) {
    if (entry.name == name) return entry.get();
  }
  if (name == "auto" || std::find(elsewhere.begin(), elsewhere.end(), name) != elsewhere.end()) {
    throw UnavailableError("renderer \"" + std::string(name) + "\": not in this build; there is " + listed_names());
  }
  std::vector<std::string> names = renderer_names();
  for (const Entry& entry : special_registry()) names.emplace_back(entry.name);
  const std::string nearest = nearest_name(name, names);
  throw UsageError("renderer \"" + std::string(name) + "\": there is " + listed_names() +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

std::vector<std::string> renderer_names() {
  std::vector<std::string> names;
  for (const Entry& entry : registry()) names.emplace_back(entry.name);
  return names;
}

Image render(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
             RenderStats& stats, const Channels& channels, Progress& progress) {
  check_picture(camera, parameters);
  return render_window(renderer, scene, camera, parameters, whole_picture(camera), stats, channels, progress);
}

}  // namespace atomesh
