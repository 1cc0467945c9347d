// What is said of a graphics card by its names.
#include <gtest/gtest.h>

#include "app/gui/gpu_scene.h"

namespace atomesh {
namespace {

TEST(GpuInfo, KnowsVersionsAndRenderers) {
  static const char* renderer = nullptr;
  static const char* version = nullptr;
  static const auto get_string = [](unsigned name) -> const unsigned char* {
    // NOLINTNEXTLINE: as OpenGL has it
    return reinterpret_cast<const unsigned char*>(name == 0x1F01U ? renderer : name == 0x1F02U ? version : nullptr);
  };
  static constexpr const unsigned char* (*function)(unsigned) = get_string;
  const auto info = [&](const char* r, const char* v) {
    renderer = r;
    version = v;
    // NOLINTNEXTLINE: as OpenGL has it
    return gui::gpu_info([](const char*) { return reinterpret_cast<void*>(function); });
  };
  EXPECT_TRUE(info("NVIDIA H100/PCIe/SSE2", "4.6.0 NVIDIA 535.54").sufficient);
  EXPECT_FALSE(info("NVIDIA H100/PCIe/SSE2", "4.6.0 NVIDIA 535.54").software);
  EXPECT_TRUE(info("Mesa DRI Intel(R)", "3.2 (Core Profile) Mesa 20.1").sufficient);
  EXPECT_FALSE(info("Mesa DRI Intel(R)", "3.1 Mesa 20.1").sufficient);
  EXPECT_FALSE(info("GeForce", "2.1 NVIDIA").sufficient);
  EXPECT_TRUE(info("x", "10.0").sufficient);
  EXPECT_FALSE(info("V3D", "4.2 Mesa").volumes);
  EXPECT_TRUE(info("V3D", "4.2 Mesa").sufficient);
  EXPECT_TRUE(info("x", "4.3").volumes);
  EXPECT_TRUE(info("x", "5.0").volumes);
  EXPECT_FALSE(info("V3D", "OpenGL ES 4.3 Mesa").volumes);
  EXPECT_FALSE(info("V3D", "OpenGL ES 3.2 Mesa").sufficient);
  EXPECT_FALSE(info(nullptr, nullptr).sufficient);
  EXPECT_FALSE(info("x", "").sufficient);
  EXPECT_TRUE(info("llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6").software);
  EXPECT_TRUE(info("Google SwiftShader", "4.5").software);
  EXPECT_TRUE(info("softpipe", "3.3").software);
  EXPECT_FALSE(gui::gpu_info([](const char*) { return static_cast<void*>(nullptr); }).sufficient);
}

}  // namespace
}  // namespace atomesh
