#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"

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

// Renderers with a name of their own that other builds may have.
constexpr std::array<std::string_view, 2> elsewhere{"havs", "cuda"};

std::string listed_names() {
  std::string list = "auto";
  for (const Entry& entry : registry()) list += ", " + std::string(entry.name);
  return list;
}

// Subsamples of pixel (column, row) stand in columns column·n … column·n+n-1 of the fine picture, rows alike.
template <class T, class Combine>
std::vector<T> shrink(const std::vector<T>& fine, int width, int height, int n, Combine combine) {
  std::vector<T> coarse(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto stride = static_cast<std::size_t>(width) * static_cast<std::size_t>(n);
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (int column = 0; column < width; ++column) {
        const T* first = &fine[row * static_cast<std::size_t>(n) * stride + static_cast<std::size_t>(column * n)];
        coarse[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)] = combine(first, stride);
      }
    }
  });
  return coarse;
}

template <class T>
std::vector<T> box_average(const std::vector<T>& fine, int width, int height, int n) {
  return shrink(fine, width, height, n, [n](const T* first, std::size_t stride) {
    T sum(0.0F);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) sum += first[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)];
    }
    return sum / static_cast<float>(n * n);
  });
}

template <class T>
std::vector<T> central_sample(const std::vector<T>& fine, int width, int height, int n) {
  const auto middle = static_cast<std::size_t>(n / 2);
  return shrink(fine, width, height, n,
                [middle](const T* first, std::size_t stride) { return first[middle * stride + middle]; });
}

Image draw_supersampled(const Renderer& renderer, const Scene& scene, const Camera& camera,
                        const Parameters& parameters, RenderStats& stats, const Channels& channels,
                        Progress& progress) {
  const int n = parameters.supersampling;
  if (n == 1) return renderer.draw(scene, camera, parameters, stats, channels, progress);
  Camera fine_camera = camera;
  fine_camera.width *= n;
  fine_camera.height *= n;
  fine_camera.pixel /= n;
  std::vector<float> thickness;
  std::vector<float> depth;
  std::vector<Index> id;
  Channels fine_channels;
  if (channels.thickness != nullptr) fine_channels.thickness = &thickness;
  if (channels.depth != nullptr) fine_channels.depth = &depth;
  if (channels.id != nullptr) fine_channels.id = &id;
  const Image fine = renderer.draw(scene, fine_camera, parameters, stats, fine_channels, progress);

  const int w = camera.width;
  const int h = camera.height;
  Image image(w, h);
  image.pixels = box_average(fine.pixels, w, h, n);
  // A channel the mode does not have stays empty.
  if (!thickness.empty()) *channels.thickness = box_average(thickness, w, h, n);
  if (!depth.empty()) *channels.depth = central_sample(depth, w, h, n);
  if (!id.empty()) *channels.id = central_sample(id, w, h, n);
  return image;
}

void lay_background(Image& image, const Vec4f& background) {
  const Vec3f below = Vec3f(background) * background.a;
  for (Vec4f& pixel : image.pixels) {
    const float through = 1.0F - pixel.a;
    const float coverage = pixel.a + through * background.a;
    const Vec3f color = Vec3f(pixel) + through * below;
    pixel = coverage > 0.0F ? glm::clamp(Vec4f(color / coverage, coverage), 0.0F, 1.0F) : Vec4f(0.0F);
  }
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
  if (name == "auto" || std::find(elsewhere.begin(), elsewhere.end(), name) != elsewhere.end()) {
    throw UnavailableError("renderer \"" + std::string(name) + "\": not in this build; there is " + listed_names());
  }
  const std::string nearest = nearest_name(name, renderer_names());
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
  if (camera.width < 1 || camera.height < 1) {
    throw UsageError("picture of " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                     " pixels: both sides must be at least 1");
  }
  if (parameters.supersampling < 1) {
    throw UsageError("supersampling " + std::to_string(parameters.supersampling) + ": must be at least 1");
  }
  Image image = draw_supersampled(renderer, scene, camera, parameters, stats, channels, progress);
  const auto start = std::chrono::steady_clock::now();
  lay_background(image, parameters.background);
  stats.render_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return image;
}

}  // namespace atomesh
