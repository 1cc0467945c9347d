#include "render/finish.h"

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

constexpr std::size_t rows_together = 8;

// Calls row(j) for all rows, in parallel.
template <class Row>
void for_rows(int rows, Row&& row) {
  parallel_for(static_cast<std::size_t>(rows), rows_together, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) row(static_cast<int>(j));
  });
}

// ray(column, row) is a ray's value.
template <class T, class RayAt>
T mean(int column, int row, int n, RayAt&& ray) {
  T sum(0.0F);
  for (int j = row * n; j < (row + 1) * n; ++j) {
    for (int i = column * n; i < (column + 1) * n; ++i) sum += ray(i, j);
  }
  return sum / static_cast<float>(n * n);
}

template <class T, class RayAt>
void set_means(std::vector<T>& to, int width, int height, int n, RayAt&& ray) {
  to.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for_rows(height, [&](int row) {
    T* pixel = &to[static_cast<std::size_t>(row) * static_cast<std::size_t>(width)];
    for (int column = 0; column < width; ++column) *pixel++ = mean<T>(column, row, n, ray);
  });
}

template <class T, class RayAt>
void set_centers(std::vector<T>& to, int width, int height, int n, RayAt&& ray) {
  to.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for_rows(height, [&](int row) {
    T* pixel = &to[static_cast<std::size_t>(row) * static_cast<std::size_t>(width)];
    for (int column = 0; column < width; ++column) *pixel++ = ray(column * n + n / 2, row * n + n / 2);
  });
}

// Calls visit(ray at (column, row)) with a function that looks into the list of rays.
template <class T>
auto rays_of(const std::vector<T>& list, int width) {
  return [&list, width](int column, int row) -> const T& {
    return list[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
}

// The same where only the pixels of a sub-resolution are drawn.
template <class T>
auto spread_rays_of(const std::vector<T>& list, int width, const SubResolution& drawn) {
  return [&list, width, drawn](int column, int row) -> const T& {
    const SubResolution::Pixel from = drawn.source(column, row, width);
    return list[static_cast<std::size_t>(from.row) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(from.column)];
  };
}

// Over the background, and no longer premultiplied.
Vec4f over(const Vec4f& pixel, const Vec4f& background) {
  const float through = 1.0F - pixel.a;
  const float coverage = pixel.a + through * background.a;
  const Vec3f color = Vec3f(pixel) + through * (Vec3f(background) * background.a);
  return coverage > 0.0F ? glm::clamp(Vec4f(color / coverage, coverage), 0.0F, 1.0F) : Vec4f(0.0F);
}

void lay_background(Image& image, const Vec4f& background) {
  for_rows(image.height, [&](int row) {
    for (int column = 0; column < image.width; ++column)
      image.at(column, row) = over(image.at(column, row), background);
  });
}

}  // namespace

Channels RayPicture::channels(const Channels& wanted) {
  return {wanted.thickness != nullptr ? &thickness : nullptr, wanted.depth != nullptr ? &depth : nullptr,
          wanted.id != nullptr ? &id : nullptr};
}

Camera ray_camera(const Camera& camera, int n) {
  Camera rays = camera;
  rays.width *= n;
  rays.height *= n;
  rays.pixel /= n;
  return rays;
}

PixelWindow ray_window(const PixelWindow& window, int n) {
  return {window.left * n, window.top * n, window.width * n, window.height * n};
}

void check_picture(const Camera& camera, const Parameters& parameters) {
  if (camera.width < 1 || camera.height < 1) {
    throw UsageError("picture of " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                     " pixels: both sides must be at least 1");
  }
  if (parameters.supersampling < 1) {
    throw UsageError("supersampling " + std::to_string(parameters.supersampling) + ": must be at least 1");
  }
}

Image finish(RayPicture&& rays, int n, const Vec4f& background, const Channels& channels) {
  Image image;
  if (n == 1) {
    image = std::move(rays.image);
    if (!rays.thickness.empty()) *channels.thickness = std::move(rays.thickness);
    if (!rays.depth.empty()) *channels.depth = std::move(rays.depth);
    if (!rays.id.empty()) *channels.id = std::move(rays.id);
  } else {
    const int width = rays.image.width;
    const int w = width / n;
    const int h = rays.image.height / n;
    image = Image(w, h);
    set_means(image.pixels, w, h, n, rays_of(rays.image.pixels, width));
    if (!rays.thickness.empty()) set_means(*channels.thickness, w, h, n, rays_of(rays.thickness, width));
    if (!rays.depth.empty()) set_centers(*channels.depth, w, h, n, rays_of(rays.depth, width));
    if (!rays.id.empty()) set_centers(*channels.id, w, h, n, rays_of(rays.id, width));
  }
  lay_background(image, background);
  return image;
}

void finish_spread(const RayPicture& rays, const SubResolution& drawn, int n, const Vec4f& background, Image& image) {
  const int width = rays.image.width;
  const int height = rays.image.height;
  const auto ray = spread_rays_of(rays.image.pixels, width, drawn);
  if (image.width != width / n || image.height != height / n) image = Image(width / n, height / n);
  if (n > 1) {
    set_means(image.pixels, image.width, image.height, n, ray);
    lay_background(image, background);
    return;
  }
  // A block is finished once and copied.
  const int block_width = drawn.block_width();
  const int block_height = drawn.block_height();
  for_rows((image.height + block_height - 1) / block_height, [&](int block_row) {
    const int top = block_row * block_height;
    Vec4f* first = &image.at(0, top);
    for (int left = 0; left < width; left += block_width) {
      std::fill_n(first + left, std::min(block_width, width - left), over(ray(left, top), background));
    }
    for (int row = top + 1; row < std::min(top + block_height, image.height); ++row) {
      std::copy_n(first, width, &image.at(0, row));
    }
  });
}

void spread_channels(const RayPicture& rays, const SubResolution& drawn, int n, const Channels& channels) {
  const int width = rays.image.width;
  const int w = width / n;
  const int h = rays.image.height / n;
  const auto spread = [&](const auto& list) { return spread_rays_of(list, width, drawn); };
  if (!rays.thickness.empty()) set_means(*channels.thickness, w, h, n, spread(rays.thickness));
  if (!rays.depth.empty()) set_centers(*channels.depth, w, h, n, spread(rays.depth));
  if (!rays.id.empty()) set_centers(*channels.id, w, h, n, spread(rays.id));
}

Image render_window(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
                    const PixelWindow& window, RenderStats& stats, const Channels& channels, Progress& progress) {
  const int n = parameters.supersampling;
  const Camera rays_from = ray_camera(camera, n);
  const PixelWindow part = ray_window(window, n);
  RayPicture rays;
  rays.image = Image(part.width, part.height);
  renderer.prepare(scene, rays_from, parameters, part, stats, progress)
      ->draw({}, rays.image, stats, rays.channels(channels), progress);
  const auto start = std::chrono::steady_clock::now();
  Image image = finish(std::move(rays), n, parameters.background, channels);
  stats.render_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return image;
}

}  // namespace atomesh
