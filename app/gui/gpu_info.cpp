#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include "app/gui/gpu_scene.h"

namespace atomesh::gui {

namespace {

// "4.5 (Core Profile) Mesa …" is at least 3.2; "OpenGL ES 3.2 …" is another OpenGL.
bool at_least(int wanted_major, int wanted_minor, std::string_view version) {
  int major = 0;
  int minor = 0;
  const char* end = version.data() + version.size();
  const auto [point, bad] = std::from_chars(version.data(), end, major);
  if (bad != std::errc() || point == end || *point != '.') return false;
  if (std::from_chars(point + 1, end, minor).ec != std::errc()) return false;
  return major > wanted_major || (major == wanted_major && minor >= wanted_minor);
}

bool draws_in_software(std::string_view renderer) {
  constexpr std::array<std::string_view, 6> names{"llvmpipe",    "softpipe", "swrast",
                                                  "SwiftShader", "Software", "GDI Generic"};
  for (const std::string_view name : names) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

GpuInfo gpu_info(const std::function<void*(const char*)>& proc) {
  constexpr unsigned gl_renderer = 0x1F01;
  constexpr unsigned gl_version = 0x1F02;
  using GetString = const unsigned char* (*)(unsigned);
  GetString get_string = nullptr;
  void* address = proc("glGetString");
  if (address == nullptr) return {};
  static_assert(sizeof(address) == sizeof(get_string));
  std::memcpy(&get_string, &address, sizeof(address));
  const auto text = [&](unsigned name) {
    // NOLINTNEXTLINE: OpenGL's strings are of unsigned characters
    const char* found = reinterpret_cast<const char*>(get_string(name));
    return std::string(found != nullptr ? found : "");
  };
  GpuInfo info;
  info.renderer = text(gl_renderer);
  info.version = text(gl_version);
  info.sufficient = at_least(3, 2, info.version);
  info.volumes = at_least(4, 3, info.version);
  info.software = draws_in_software(info.renderer);
  return info;
}

}  // namespace atomesh::gui
