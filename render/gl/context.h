// An OpenGL context without a window, and what is known of the one that is current.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace atomesh::gl {

// The current context's OpenGL, as it names itself.
struct Driver {
  std::string renderer;  // GL_RENDERER
  std::string vendor;    // GL_VENDOR
  std::string version;   // GL_VERSION
  int major = 0;
  int minor = 0;
  bool software = false;   // llvmpipe, softpipe, swrast, SwiftShader, …
  bool interlock = false;  // GL_ARB_fragment_shader_interlock or GL_NV_…
  // What render/gl needs: OpenGL 4.3 (compute shaders, storage buffers, image load/store), not OpenGL ES.
  bool sufficient() const { return major > 4 || (major == 4 && minor >= 3); }
};
Driver current_driver();

// Throws UnavailableError, naming the driver and what is missing, unless the current context is sufficient().
void require_sufficient_driver();

// What the driver's debug output said since the last call, and glGetError()'s errors; only errors and undefined
// behaviour, in the driver's words. Needs collect_messages() in the same context before.
void collect_messages();
std::vector<std::string> take_messages();

// Throws Error with take_messages() where there are any and with glGetError()'s code: after each frame. `doing` says
// what was tried ("drawing the volume"). GL_OUT_OF_MEMORY and a lost context become UnavailableError.
void check_errors(const char* doing);

// OpenGL 4.3 or later (core) on EGL, without a surface: a graphics card where EGL finds one, else software. Needs
// neither a display nor VTK.
class HeadlessContext {
 public:
  // `debug`: the driver checks every call and reports (slower; tests). Throws UnavailableError saying what is missing:
  // libEGL, a device, a context of that version.
  explicit HeadlessContext(bool debug = false);
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  // Makes the context current in this thread as long as it lives; other threads wait. What was current before is
  // current again afterwards.
  class Current {
   public:
    explicit Current(HeadlessContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    std::unique_lock<std::recursive_mutex> lock_;
    void* display_;
    void* context_;
    void* draw_;
    void* read_;
    void* own_display_;
  };

 private:
  friend class Current;
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::recursive_mutex mutex_;
};

}  // namespace atomesh::gl
