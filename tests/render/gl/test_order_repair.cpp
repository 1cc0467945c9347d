// Rectangles that are drawn in a wrong order, repaired, against the CPU's sorting of each pixel.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "core/geometry.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/order_repair.h"

using namespace atomesh;
using namespace atomesh::gl;

namespace {

constexpr int width = 150;  // no multiple of a tile's
constexpr int height = 91;

// Of pixels [left, right) × [bottom, top), with premultiplied light.
struct Layer {
  int left, right, bottom, top;
  float depth;
  Vec4f light;
};

// `disorder`: by how many places about a layer stands before or behind its place; 0: front to back.
std::vector<Layer> make_layers(int count, double disorder, float opacity) {
  std::mt19937 random(11);
  const auto uniform = [&random] { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random); };
  std::vector<Layer> layers;
  for (int i = 0; i < count; ++i) {
    const auto edges = [&](int size) {
      const int a = static_cast<int>(uniform() * static_cast<float>(size));
      const int b = static_cast<int>(uniform() * static_cast<float>(size));
      return std::pair(std::min(a, b), std::max(a, b) + 1);
    };
    const auto [left, right] = edges(width);
    const auto [bottom, top] = edges(height);
    const float alpha = opacity * uniform();
    layers.push_back({left, right, bottom, top, (static_cast<float>(i) + 1.0F) / static_cast<float>(count + 1),
                      Vec4f(alpha * uniform(), alpha * uniform(), alpha * uniform(), alpha)});
  }
  std::vector<std::pair<double, Layer>> placed;
  for (int i = 0; i < count; ++i) placed.emplace_back(i + disorder * uniform(), layers[static_cast<std::size_t>(i)]);
  std::ranges::stable_sort(placed, {}, &std::pair<double, Layer>::first);
  std::ranges::transform(placed, layers.begin(), &std::pair<double, Layer>::second);
  return layers;
}

// The layers over each pixel in the order in which they are drawn.
template <class Visit>
void for_each_pixel(const std::vector<Layer>& layers, Visit&& visit) {
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      std::vector<Layer> over;
      for (const Layer& l : layers) {
        if (l.left <= column && column < l.right && l.bottom <= row && row < l.top) over.push_back(l);
      }
      visit(static_cast<std::size_t>(row * width + column), over);
    }
  }
}

Vec4f composed(const std::vector<Layer>& over) {
  Vec4f light(0.0F);
  for (const Layer& l : over) light += (1.0F - light.a) * l.light;
  return light;
}

bool in_order(const std::vector<Layer>& over) {
  return std::ranges::is_sorted(over, {}, &Layer::depth);
}

// What comes out of a buffer that keeps k.
std::vector<Layer> through_k_buffer(const std::vector<Layer>& over, std::size_t k) {
  std::vector<Layer> kept;
  std::vector<Layer> out;
  const auto pass_on = [&] {
    const auto nearest = std::ranges::min_element(kept, {}, &Layer::depth);
    out.push_back(*nearest);
    kept.erase(nearest);
  };
  for (const Layer& l : over) {
    kept.push_back(l);
    if (kept.size() > k) pass_on();
  }
  while (!kept.empty()) pass_on();
  return out;
}

struct RawProgram {
  GLuint name = glCreateProgram();
  RawProgram(const std::string& vertex, const std::string& fragment) {
    for (const auto& [stage, text] : {std::pair(GL_VERTEX_SHADER, vertex), std::pair(GL_FRAGMENT_SHADER, fragment)}) {
      const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
      const std::string source = "#version 430 core\n" + text;
      const char* start = source.c_str();
      glShaderSource(shader, 1, &start, nullptr);
      glCompileShader(shader);
      std::array<char, 4096> log{};
      glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
      GLint compiled = GL_FALSE;
      glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
      EXPECT_EQ(compiled, GL_TRUE) << log.data();
      glAttachShader(name, shader);
      glDeleteShader(shader);
    }
    glLinkProgram(name);
    GLint linked = GL_FALSE;
    glGetProgramiv(name, GL_LINK_STATUS, &linked);
    EXPECT_EQ(linked, GL_TRUE);
  }
  ~RawProgram() { glDeleteProgram(name); }
  RawProgram(const RawProgram&) = delete;
  RawProgram& operator=(const RawProgram&) = delete;
};

// The layers on the card, and what a first pass makes of them.
class Picture {
 public:
  explicit Picture(const std::vector<Layer>& layers)
      : color_(Texture::make_2d(GL_RGBA32F, width, height)),
        depth_(Texture::make_2d(GL_DEPTH32F_STENCIL8, width, height)),
        framebuffer_(make_framebuffer()),
        array_(make_vertex_array()),
        layers_(layers),
        blend_(vertex_shader(), "in vec4 layer; out vec4 light; void main() { light = layer; }") {
    std::vector<float> vertices;
    for (const Layer& l : layers) {
      for (const auto& [x, y] :
           {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 0), std::pair(1, 1), std::pair(0, 1)}) {
        const int column = x == 0 ? l.left : l.right;
        const int row = y == 0 ? l.bottom : l.top;
        for (const float value :
             {2.0F * static_cast<float>(column) / width - 1.0F, 2.0F * static_cast<float>(row) / height - 1.0F,
              2.0F * l.depth - 1.0F, 1.0F, l.light.r, l.light.g, l.light.b, l.light.a}) {
          vertices.push_back(value);
        }
      }
    }
    buffer_.write(std::span<const float>(vertices));
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    for (GLuint i = 0; i < 2; ++i) {
      glEnableVertexAttribArray(i);
      glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, 32, reinterpret_cast<const void*>(std::size_t{16} * i));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
  }

  GLuint framebuffer() const { return framebuffer_.name(); }

  void draw_blended() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 0);
    glClearDepth(0.0);
    glDepthMask(GL_TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, 0xFF);
    glStencilOp(GL_KEEP, GL_INCR, GL_KEEP);
    draw(blend_.name);
  }

  void draw(GLuint program) {
    glUseProgram(program);
    glBindVertexArray(array_.name());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * layers_.size()));
  }

  // Those alone that meet the tiles.
  void draw(GLuint program, const MarkedTiles& tiles) {
    glUseProgram(program);
    glBindVertexArray(array_.name());
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const Layer& l = layers_[i];
      if (!tiles.meets(l.left, l.right - 1, l.bottom, l.top - 1)) continue;
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(6 * i), 6);
      ++drawn_again_;
    }
  }
  std::size_t drawn_again() const { return drawn_again_; }

  RepairStats repair(OrderRepair& order_repair) {
    std::string source;
    for (const std::string& define : order_repair.defines()) source += "#define " + define + "\n";
    // The product's fragment shaders with the layer's light for a cell's.
    source += "layout(early_fragment_tests) in;\nin vec4 layer;\n";
    source += order_repair.settings().method == RepairMethod::keep
                  ? shader_source("kept_fragments.glsl") +
                        "void main() { BEGIN_IN_ORDER; keep(gl_FragCoord.z, layer); END_IN_ORDER; }"
                  : shader_source("list.glsl") + "void main() { add_to_list(gl_FragCoord.z, layer); }";
    const RawProgram program(vertex_shader(), source);
    RepairStats stats;
    order_repair.repair(
        framebuffer_.name(), width, height, [&] { draw(program.name, order_repair.tiles()); }, stats);
    check_errors("repairing");
    return stats;
  }

  std::vector<Vec4f> read() const {
    std::vector<Vec4f> pixels(static_cast<std::size_t>(width) * height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
  }

 private:
  static std::string vertex_shader() {
    return "layout(location = 0) in vec4 place; layout(location = 1) in vec4 light; out vec4 layer;"
           "void main() { gl_Position = place; layer = light; }";
  }

  Texture color_;
  Texture depth_;
  Framebuffer framebuffer_;
  VertexArray array_;
  Buffer buffer_;
  std::vector<Layer> layers_;
  std::size_t drawn_again_ = 0;
  RawProgram blend_;
};

class OrderRepairTest : public testing::Test {
 protected:
  HeadlessContext context_{true};
  HeadlessContext::Current current_{context_};

  // Half floats, and 32-bit sums of a few hundred.
  static constexpr float tolerance = 5e-4F;

  // Draws and repairs; every pixel must be what the CPU makes of it, wrong ones counted.
  RepairStats compare(const std::vector<Layer>& layers, const RepairSettings& settings) {
    Picture picture(layers);
    picture.draw_blended();
    const std::vector<Vec4f> before = picture.read();
    OrderRepair order_repair(settings);
    const RepairStats stats = picture.repair(order_repair);
    const std::vector<Vec4f> after = picture.read();
    std::uint64_t marked = 0;
    std::uint64_t wrong = 0;
    std::uint64_t changed = 0;
    std::uint64_t off = 0;
    for_each_pixel(layers, [&](std::size_t pixel, std::vector<Layer>& over) {
      const bool mark = !in_order(over);
      marked += mark ? 1 : 0;
      if (!mark) {
        changed += before[pixel] != after[pixel] ? 1 : 0;
        return;
      }
      if (settings.method == RepairMethod::sort) {
        std::ranges::sort(over, {}, &Layer::depth);
      } else {
        over = through_k_buffer(over, static_cast<std::size_t>(settings.k));
      }
      wrong += in_order(over) ? 0 : 1;
      const Vec4f expected = composed(over);
      for (int c = 0; c < 4; ++c) off += std::abs(expected[c] - after[pixel][c]) > tolerance ? 1 : 0;
    });
    EXPECT_EQ(stats.pixels, marked);
    EXPECT_EQ(stats.wrong_pixels, wrong);
    EXPECT_EQ(changed, 0U) << "pixels that were right";
    EXPECT_EQ(off, 0U);
    return stats;
  }
};

TEST_F(OrderRepairTest, LeavesARightOrderAlone) {
  const RepairStats stats = compare(make_layers(60, 0.0, 0.3F), {});
  EXPECT_EQ(stats.pixels, 0U);
  EXPECT_EQ(stats.draws, 0);
}

TEST_F(OrderRepairTest, SortsListsWhole) {
  for (const double disorder : {1.5, 6.0, 400.0}) {
    const RepairStats stats = compare(make_layers(200, disorder, 0.1F), {});
    EXPECT_GT(stats.pixels, disorder > 2.0 ? 1000U : 0U);
    EXPECT_EQ(stats.wrong_pixels, 0U);
    EXPECT_GT(stats.longest, 30U);
  }
}

// Far beyond the steps that one draw may take (65,535 rounds of all loops on llvmpipe).
TEST_F(OrderRepairTest, SortsLongListsInAnyOrder) {
  for (const int layers : {2000, 10000}) {
    for (const bool turned : {true, false}) {
      std::vector<Layer> over;
      for (int i = 0; i < layers; ++i) {
        const float depth = 1.0F - static_cast<float>(i) / static_cast<float>(layers + 1);
        over.push_back({3, 9, 5, 8, depth, 3.0F / static_cast<float>(layers) * Vec4f(depth, 0.1F, 1.0F - depth, 1.0F)});
      }
      if (!turned) std::ranges::shuffle(over, std::mt19937(3));
      const RepairStats stats = compare(over, {});
      EXPECT_EQ(stats.pixels, 18U);
      EXPECT_EQ(stats.longest, static_cast<std::uint64_t>(layers));
    }
  }
}

TEST_F(OrderRepairTest, KeepsTheLightOfThinSegments) {
  compare(make_layers(300, 400.0, 1e-4F), {});
}

TEST_F(OrderRepairTest, ReplaysListsThroughKBuffers) {
  std::vector<std::uint64_t> wrong;
  for (const int k : {1, 2, 4, 8, 16, 64}) {
    wrong.push_back(compare(make_layers(200, 12.0, 0.1F), {.method = RepairMethod::replay, .k = k}).wrong_pixels);
  }
  EXPECT_GT(wrong.front(), 1000U);
  EXPECT_TRUE(std::ranges::is_sorted(wrong, std::greater<>())) << testing::PrintToString(wrong);
  EXPECT_EQ(wrong.back(), 0U);
}

// Depths a little before the first one, which rounding makes of what begins there: clamped for the depth test, they are
// less than nothing elsewhere. They come first, as they were drawn.
TEST_F(OrderRepairTest, WhatRoundingPutsBeforeTheFirstDepthComesFirst) {
  glEnable(GL_DEPTH_CLAMP);
  const Vec4f red(0.4F, 0.0F, 0.0F, 0.5F);
  const Vec4f green(0.0F, 0.4F, 0.0F, 0.5F);
  const Vec4f blue(0.0F, 0.0F, 0.4F, 0.5F);
  const std::vector<Layer> layers{// the first one first, two others turned round
                                  {0, 30, 0, 30, -1e-3F, red},
                                  {0, 30, 0, 30, 0.5F, green},
                                  {0, 30, 0, 30, 0.25F, blue},
                                  // the first one last, and next to last
                                  {40, 70, 0, 30, 0.5F, green},
                                  {40, 70, 0, 30, -1e-7F, red},
                                  {50, 70, 0, 30, 0.75F, blue},
                                  // two first ones
                                  {80, 90, 0, 30, -2e-3F, red},
                                  {80, 90, 0, 30, -1e-3F, green},
                                  {80, 90, 0, 30, 0.5F, green},
                                  {80, 90, 0, 30, 0.25F, blue}};
  std::vector<RepairMethod> methods{RepairMethod::sort, RepairMethod::replay};
  if (current_driver().interlock || current_driver().software) methods.push_back(RepairMethod::keep);
  for (const RepairMethod method : methods) {
    const RepairStats stats = compare(layers, {.method = method, .k = 4});
    EXPECT_EQ(stats.pixels, 30U * (30 + 30 + 10));
    EXPECT_EQ(stats.wrong_pixels, 0U);
  }
}

// llvmpipe runs a pixel's fragments in the order of drawing without being asked.
TEST_F(OrderRepairTest, KeepsFragmentsInOrder) {
  const Driver driver = current_driver();
  if (!driver.interlock && driver.renderer.find("llvmpipe") == std::string::npos) {
    GTEST_SKIP() << driver.renderer << " promises no order of a pixel's fragments";
  }
  for (const int k : {1, 2, 4, 8, 64}) {
    compare(make_layers(200, 12.0, 0.1F), {.method = RepairMethod::keep, .k = k});
  }
}

TEST_F(OrderRepairTest, TakesPartsWhereMemoryIsShort) {
  const std::vector<Layer> layers = make_layers(200, 40.0, 0.1F);
  const RepairStats once = compare(layers, {});
  EXPECT_EQ(once.draws, 1);
  for (const std::size_t kilobytes : {64, 200, 1000}) {
    const RepairStats parts = compare(layers, {.memory = kilobytes << 10});
    EXPECT_GT(parts.draws, 1) << kilobytes;
    EXPECT_EQ(parts.fragments, once.fragments);
    EXPECT_EQ(parts.longest, once.longest);
  }
  compare(layers, {.method = RepairMethod::replay, .k = 4, .memory = 1 << 17});
  EXPECT_GT(compare(layers, {.method = RepairMethod::keep, .k = 4, .memory = 1 << 17}).draws, 1);
}

TEST_F(OrderRepairTest, DrawsAgainWhatMeetsMarkedTiles) {
  std::vector<Layer> layers;
  for (int column = 0; column < 140; column += 10) {
    for (const float depth : {0.3F, 0.6F}) {
      layers.push_back({column, column + 9, 10, 20, column == 50 ? 1.0F - depth : depth, Vec4f(0.2F)});
    }
  }
  compare(layers, {});
  Picture picture(layers);
  picture.draw_blended();
  OrderRepair order_repair(RepairSettings{});
  EXPECT_EQ(picture.repair(order_repair).pixels, 90U);
  EXPECT_LE(picture.drawn_again(), 6U);
  EXPECT_GE(picture.drawn_again(), 2U);
}

TEST(MarkedTiles, AreMetByWhatTouchesThem) {
  constexpr int columns = 37;
  constexpr int rows = 21;
  std::mt19937 random(5);
  std::vector<std::uint8_t> pixels(columns * rows);
  for (const std::size_t place : {3UL, 37UL * 9 + 20, 37UL * 20 + 36}) pixels[place] = 2;
  pixels[37 * 4 + 30] = 1;  // another bit
  MarkedTiles tiles(pixels, columns, rows, 2);
  for (int n = 0; n < 2000; ++n) {
    const auto edge = [&](int size) { return static_cast<int>(random() % static_cast<unsigned>(size + 20)) - 10; };
    const auto [left, right] = std::minmax({edge(columns), edge(columns)});
    const auto [bottom, top] = std::minmax({edge(rows), edge(rows)});
    if (n == 1000) tiles.look_at(8, 0, 16, 21);
    const int first = n < 1000 ? 0 : 8;
    const int last = n < 1000 ? columns - 1 : 23;
    bool expected = false;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        if (pixels[static_cast<std::size_t>(j * columns + i)] != 2) continue;
        const auto touches = [](int low, int high, int pixel) { return low <= (pixel | 7) && high >= (pixel & ~7); };
        expected = expected || (touches(std::max(left, first), std::min(right, last), i) &&
                                touches(std::max(bottom, 0), std::min(top, rows - 1), j));
      }
    }
    const bool empty = std::max(left, first) > std::min(right, last) || std::max(bottom, 0) > std::min(top, rows - 1);
    EXPECT_EQ(tiles.meets(left, right, bottom, top), expected && !empty)
        << left << " " << right << " " << bottom << " " << top;
  }
}

// A list that is longer than was guessed is made once more in more memory.
TEST_F(OrderRepairTest, GrowsWhereMemoryMayGrow) {
  std::vector<Layer> layers = make_layers(2, 0.0, 0.1F);
  for (int i = 0; i < 4000; ++i) {
    layers.push_back({3, 9, 5, 8, 1.0F - static_cast<float>(i) / 4100.0F, Vec4f(3e-4F, 2e-4F, 0.0F, 3e-4F)});
  }
  const RepairStats stats = compare(layers, {});
  EXPECT_EQ(stats.draws, 2);
  EXPECT_GE(stats.longest, 4000U);
}

TEST_F(OrderRepairTest, OneListTooLongForTheMemoryIsCountedWrong) {
  std::vector<Layer> layers;
  for (int i = 0; i < 8000; ++i) {
    layers.push_back({3, 5, 5, 6, 1.0F - static_cast<float>(i) / 9000.0F, Vec4f(1e-4F)});
  }
  Picture picture(layers);
  picture.draw_blended();
  OrderRepair order_repair({.memory = 1 << 16});
  const RepairStats stats = picture.repair(order_repair);
  EXPECT_EQ(stats.pixels, 2U);
  EXPECT_EQ(stats.wrong_pixels, 2U);
}

}  // namespace
