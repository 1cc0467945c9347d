#include "render/gl/preintegration_table.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace atomesh::gl {

namespace {

constexpr GLuint pieces_unit = 8;
constexpr int cells = 1024;  // segment_cells of segment.glsl
// Beyond every scalar, and still far from what float overflows at.
constexpr float beyond = 1e30F;

struct MapPiece {
  Vec4f first{0.0F};  // RGB, extinction where it begins
  Vec4f slope{0.0F};  // for each unit of the scalar
  float begin = -beyond;
  float end = beyond;
};

// Ascending. A jump is where one ends at another colour than the next begins with.
std::vector<MapPiece> map_pieces(const ColorMap& map, double alpha_length) {
  const auto optical = [alpha_length](const Vec4f& color) {
    return glm::dvec4(color.r, color.g, color.b, static_cast<double>(color.a) * alpha_length);
  };
  const std::vector<ColorMapEntry>& entries = map.entries;
  std::vector<MapPiece> pieces;
  pieces.push_back(
      {Vec4f(optical(entries.front().color)), Vec4f(0.0F), -beyond, static_cast<float>(entries.front().scalar)});
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    const auto begin = static_cast<float>(entries[i].scalar);
    const auto end = static_cast<float>(entries[i + 1].scalar);
    if (!(begin < end)) continue;
    const glm::dvec4 first = optical(entries[i].color);
    const glm::dvec4 rise = optical(entries[i + 1].color) - first;
    const double width = static_cast<double>(end) - static_cast<double>(begin);
    pieces.push_back({Vec4f(first), Vec4f(rise / width), begin, end});
  }
  pieces.push_back(
      {Vec4f(optical(entries.back().color)), Vec4f(0.0F), static_cast<float>(entries.back().scalar), beyond});
  return pieces;
}

// As segment.glsl reads them.
std::vector<Vec4f> texels_of(const std::vector<MapPiece>& pieces) {
  std::vector<Vec4f> texels;
  const auto add = [&](std::size_t i) {
    const MapPiece& piece = pieces[i];
    texels.push_back(piece.first);
    texels.push_back(piece.slope);
    texels.emplace_back(piece.begin, piece.end, static_cast<float>(3 * (cells + 1 + i)), 0.0F);
  };
  std::size_t at = 0;
  for (int cell = 0; cell <= cells; ++cell) {
    while (static_cast<float>(cell) / cells >= pieces[at].end) ++at;
    add(at);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) add(i);
  return texels;
}

}  // namespace

void PreintegrationTable::update(const ColorMap& color_map, double alpha_length) {
  if (pieces_texture_ && color_map == color_map_ && alpha_length == alpha_length_) return;
  check_color_map(color_map);
  pieces_.write(std::span<const Vec4f>(texels_of(map_pieces(color_map, alpha_length))));
  if (!pieces_texture_) {
    GLuint name = 0;
    glGenTextures(1, &name);
    pieces_texture_ = Handle<detail::destroy_texture>(name);
  }
  glActiveTexture(GL_TEXTURE0 + pieces_unit);
  glBindTexture(GL_TEXTURE_BUFFER, pieces_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, pieces_.name());
  color_map_ = color_map;
  alpha_length_ = alpha_length;
}

void PreintegrationTable::bind() const {
  glActiveTexture(GL_TEXTURE0 + pieces_unit);
  glBindTexture(GL_TEXTURE_BUFFER, pieces_texture_.name());
}

}  // namespace atomesh::gl
