#include "render/gl/preintegration_table.h"

#include <array>
#include <chrono>
#include <vector>

namespace atomesh::gl {

namespace {

// One unit for both: a shader reads either the buffer or the table.
constexpr GLuint unit = 8;
constexpr GLuint scales_block = 8;
constexpr int cells = 1024;  // segment_cells of segment_map.glsl

// As segment_map.glsl reads them.
std::vector<Vec4f> texels_of(const std::vector<MapPiece>& pieces) {
  std::vector<Vec4f> texels;
  const auto add = [&](std::size_t i) {
    const MapPiece& piece = pieces[i];
    texels.emplace_back(piece.first);
    texels.emplace_back(piece.slope);
    texels.emplace_back(piece.begin, piece.end, 3 * (cells + 1 + i), 0.0F);
  };
  std::size_t at = 0;
  for (int cell = 0; cell <= cells; ++cell) {
    while (static_cast<double>(cell) / cells >= pieces[at].end) ++at;
    add(at);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) add(i);
  return texels;
}

// Uniform block SegmentTable of segment.glsl.
struct Scales {
  std::array<float, 2> scalars;
  std::array<float, 2> layers;
  float bend;
  std::array<float, 3> unused{};
};

// Places lie in the middle of texels.
std::array<float, 2> scale(double whole, int count) {
  return {static_cast<float>(whole * (count - 1) / count), 0.5F / static_cast<float>(count)};
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void PreintegrationTable::update(const ColorMap& color_map, double alpha_length) {
  if (pieces_texture_ && color_map == color_map_ && alpha_length == alpha_length_) return;
  check_color_map(color_map);
  color_map_ = color_map;
  alpha_length_ = alpha_length;
  pieces_ = map_pieces(color_map, alpha_length);
  longest_ = -1.0;
  pieces_texture_.write(std::span<const Vec4f>(texels_of(pieces_)));
}

bool PreintegrationTable::make_table(double longest, double error) {
  if (longest == longest_ && error == error_) return static_cast<bool>(stats_.bytes);
  const auto start = std::chrono::steady_clock::now();
  stats_ = {};
  stats_.size = choose_size(pieces_, longest, error);
  stats_.choose_ms = milliseconds_since(start);
  longest_ = longest;
  error_ = error;
  if (stats_.size.scalars == 0) return false;
  const auto filling = std::chrono::steady_clock::now();
  fill(stats_.size);
  stats_.build_ms = milliseconds_since(filling);
  return true;
}

void PreintegrationTable::fill(const TableSize& size) {
  if (!program_) program_ = Program::compute("preintegrate.comp");
  if (table_.width() != size.scalars || table_.depth() != size.layers) {
    table_ = Texture::make_3d(GL_RGBA32F, size.scalars, size.scalars, size.layers);
  }
  stats_.bytes = sizeof(Vec4f) * static_cast<std::size_t>(size.scalars) * static_cast<std::size_t>(size.scalars) *
                 static_cast<std::size_t>(size.layers);
  const Scales scales{scale(1.0, size.scalars), scale((size.longest + size.bend) / size.longest, size.layers),
                      static_cast<float>(size.bend)};
  scales_.write(std::span<const Scales>(&scales, 1));
  bind();
  program_.use();
  glUniform1f(0, static_cast<float>(size.longest));
  glUniform1f(1, static_cast<float>(size.bend));
  glBindImageTexture(0, table_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  const auto groups = static_cast<GLuint>((size.scalars + 7) / 8);
  glDispatchCompute(groups, groups, static_cast<GLuint>(size.layers));
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32F);
  glFinish();
}

void PreintegrationTable::bind() const {
  pieces_texture_.bind(unit);
  if (stats_.bytes == 0) return;
  table_.bind(unit);
  scales_.bind_uniform(scales_block);
}

std::vector<Vec4f> PreintegrationTable::read() const {
  std::vector<Vec4f> entries(stats_.bytes / sizeof(Vec4f));
  if (entries.empty()) return entries;
  table_.bind(unit);
  glGetTexImage(GL_TEXTURE_3D, 0, GL_RGBA, GL_FLOAT, entries.data());
  return entries;
}

}  // namespace atomesh::gl
