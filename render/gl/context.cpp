#include "render/gl/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.h"

namespace atomesh::gl {

namespace {

std::string text(GLenum name) {
  const GLubyte* s = glGetString(name);
  return s != nullptr ? reinterpret_cast<const char*>(s) : "";
}

std::vector<std::string>& messages() {
  thread_local std::vector<std::string> list;
  return list;
}

void heard(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* message, const void*) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  messages().emplace_back(message, length >= 0 ? static_cast<std::size_t>(length) : std::string_view(message).size());
}

std::string_view error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return "unknown error";
  }
}

// libepoxy ends the program where libEGL is missing, so it is looked for first.
void require_egl() {
  static const bool found = [] {
    void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);  // stays open: EGL does not like to be unloaded
    return library != nullptr;
  }();
  if (!found) throw UnavailableError("OpenGL without a window: there is no libEGL.so.1 here (Debian: libegl1)");
}

bool has_extension(EGLDisplay display, std::string_view name) {
  const char* all = eglQueryString(display, EGL_EXTENSIONS);
  if (all == nullptr) return false;
  const std::string padded = " " + std::string(all) + " ";
  return padded.find(" " + std::string(name) + " ") != std::string::npos;
}

EGLContext make_context(EGLDisplay display, bool debug) {
  EGLint major = 0;
  EGLint minor = 0;
  if (eglInitialize(display, &major, &minor) == EGL_FALSE) return EGL_NO_CONTEXT;
  const bool bare =
      has_extension(display, "EGL_KHR_surfaceless_context") &&
      (has_extension(display, "EGL_KHR_no_config_context") || has_extension(display, "EGL_MESA_configless_context"));
  if (!bare || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return EGL_NO_CONTEXT;
  const std::array<EGLint, 9> wanted{EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_CONTEXT_OPENGL_DEBUG,
                                     debug ? EGL_TRUE : EGL_FALSE,
                                     EGL_NONE};
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
}

// Cards first, software last.
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> cards;
  std::vector<EGLDisplay> software;
  if (has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      (has_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
       has_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base"))) {
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const char* extensions = eglQueryDeviceStringEXT(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS);
      const bool slow =
          extensions != nullptr && std::string_view(extensions).find("EGL_MESA_device_software") != std::string::npos;
      EGLDisplay display =
          eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr);
      if (display != EGL_NO_DISPLAY) (slow ? software : cards).push_back(display);
    }
  }
  if (has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display != EGL_NO_DISPLAY) cards.push_back(display);
  }
  cards.insert(cards.end(), software.begin(), software.end());
  return cards;
}

}  // namespace

Driver current_driver() {
  Driver driver;
  driver.renderer = text(GL_RENDERER);
  driver.vendor = text(GL_VENDOR);
  driver.version = text(GL_VERSION);
  if (driver.version.rfind("OpenGL ES", 0) != 0) {
    const int version = epoxy_gl_version();
    driver.major = version / 10;
    driver.minor = version % 10;
  }
  constexpr std::array<std::string_view, 6> slow{"llvmpipe", "softpipe", "swrast", "SwiftShader", "SWR", "Software"};
  driver.software = std::any_of(slow.begin(), slow.end(),
                                [&](std::string_view name) { return driver.renderer.find(name) != std::string::npos; });
  driver.interlock = epoxy_has_gl_extension("GL_ARB_fragment_shader_interlock") ||
                     epoxy_has_gl_extension("GL_NV_fragment_shader_interlock");
  return driver;
}

void require_sufficient_driver() {
  const Driver driver = current_driver();
  if (driver.sufficient()) return;
  throw UnavailableError("OpenGL 4.3 is needed for the volume; the driver \"" + driver.renderer + "\" has " +
                         driver.version);
}

void collect_messages() {
  messages().clear();
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(heard, nullptr);
}

std::vector<std::string> take_messages() {
  std::vector<std::string> list;
  list.swap(messages());
  return list;
}

void check_errors(const char* doing) {
  std::string all;
  bool unavailable = false;
  // A lost context would report itself for ever.
  for (int i = 0; i < 8; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    all += (all.empty() ? "" : ", ") + std::string(error_name(error));
    unavailable = unavailable || error == GL_OUT_OF_MEMORY || error == GL_CONTEXT_LOST;
  }
  for (const std::string& message : take_messages()) all += (all.empty() ? "" : "; ") + message;
  if (all.empty()) return;
  const std::string what = std::string("OpenGL, ") + doing + ": " + all + " (" + text(GL_RENDERER) + ")";
  if (unavailable) throw UnavailableError(what);
  throw Error(what);
}

HeadlessContext::HeadlessContext(bool debug) {
  require_egl();
  for (EGLDisplay display : displays()) {
    EGLContext context = make_context(display, debug);
    if (context == EGL_NO_CONTEXT) continue;
    display_ = display;
    context_ = context;
    break;
  }
  if (context_ == nullptr) {
    throw UnavailableError(
        "OpenGL without a window: EGL has no device with OpenGL 4.3 (Debian: libegl1 libgl1-mesa-dri draw in "
        "software)");
  }
  if (debug) {
    const Current current(*this);
    collect_messages();
  }
}

HeadlessContext::~HeadlessContext() {
  // The display is shared with whoever else uses EGL in this process: it is not terminated.
  eglDestroyContext(display_, context_);
}

HeadlessContext::Current::Current(HeadlessContext& context)
    : lock_(context.mutex_),
      display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)),
      own_display_(context.display_) {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_) == EGL_FALSE) {
    throw UnavailableError("OpenGL without a window: the context cannot be made current");
  }
}

HeadlessContext::Current::~Current() {
  if (context_ != EGL_NO_CONTEXT) {
    eglMakeCurrent(display_, draw_, read_, context_);
  } else {
    eglMakeCurrent(own_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

}  // namespace atomesh::gl
