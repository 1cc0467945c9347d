// The OpenGL context without a window, and OpenGL's objects.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <thread>

#include "core/error.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "tests/render/gl/shader_harness.h"

using namespace atomesh;
using namespace atomesh::gl;

namespace {

TEST(GlContext, DrivesOpenGl43WithoutDisplay) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  const Driver driver = current_driver();
  EXPECT_TRUE(driver.sufficient()) << driver.version;
  EXPECT_FALSE(driver.renderer.empty());
  EXPECT_NO_THROW(require_sufficient_driver());
  EXPECT_NO_THROW(check_errors("nothing"));
}

TEST(GlContext, IsLeftAsItWasFound) {
  HeadlessContext outer;
  HeadlessContext inner;
  const HeadlessContext::Current current(outer);
  Buffer buffer;
  buffer.write(std::span<const int>(std::array{1, 2, 3}));
  {
    const HeadlessContext::Current other(inner);
    EXPECT_EQ(glIsBuffer(buffer.name()), GL_FALSE);
  }
  EXPECT_EQ(glIsBuffer(buffer.name()), GL_TRUE);
}

TEST(GlContext, GoesFromThreadToThread) {
  HeadlessContext context;
  Buffer buffer;
  std::vector<int> numbers(1000);
  std::iota(numbers.begin(), numbers.end(), 0);
  {
    const HeadlessContext::Current current(context);
    buffer.write(std::span<const int>(numbers));
  }
  std::vector<int> read;
  std::thread([&] {
    const HeadlessContext::Current current(context);
    read = buffer.read<int>(numbers.size());
  }).join();
  EXPECT_EQ(read, numbers);
  const HeadlessContext::Current current(context);
  buffer = Buffer();
}

TEST(GlContext, ReportsWhatTheDriverFindsWrong) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  glBindTexture(GL_POINTS, 0);
  try {
    check_errors("testing");
    FAIL() << "an invalid enum went by";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("testing"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("invalid enum"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(check_errors("again"));
}

TEST(GlObjects, AShaderThatIsNotThereIsNamed) {
  EXPECT_THROW(shader_source("nowhere.frag"), Error);
}

TEST(GlObjects, ShadersFetchTheTexelsThatWereWrittenLast) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  const ShaderFunction fetch(R"glsl(
layout(binding = 3) uniform samplerBuffer texels;
vec4 result_of(vec4 given) { return texelFetch(texels, int(given.x)); })glsl");
  BufferTexture texture;
  EXPECT_FALSE(texture);
  // It grows, and stays as large as it was.
  for (const int count : {3, 5000, 20}) {
    std::vector<Vec4f> texels;
    std::vector<Vec4f> numbers;
    for (int i = 0; i < count; ++i) {
      texels.emplace_back(i, 0.5 * i, count, -1.0);
      numbers.emplace_back(i, 0.0, 0.0, 0.0);
    }
    texture.write(std::span<const Vec4f>(texels));
    EXPECT_TRUE(texture);
    texture.bind(3);
    EXPECT_EQ(fetch(numbers), texels) << count;
  }
  EXPECT_NO_THROW(check_errors("fetching texels"));
}

}  // namespace
