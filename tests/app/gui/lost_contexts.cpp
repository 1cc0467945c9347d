#include "tests/app/gui/lost_contexts.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/render/gl/instead.h"

// What programs define takes the place of what libraries have: Qt's plugin finds these.
#undef glXMakeCurrent
#undef glXMakeContextCurrent
#undef glXDestroyContext
#undef glXGetProcAddress
#undef glXQueryExtensionsString

namespace atomesh::test {

namespace {

struct Deletions {
  std::size_t all = 0;
  std::size_t stray = 0;
  std::set<GLXContext> others;
};

struct State {
  std::set<GLXContext> known;  // were current, and are not destroyed
  std::optional<Loss> loss;
  GLXContext lost = nullptr;
  std::set<GLXContext> others;  // known when it was lost
  std::size_t noticed = 0;
  bool asked = false;  // Qt asks whether contexts are lost
  Deletions deletions;
};

State& state() {
  static State all;
  return all;
}

template <class Function>
Function real(const char* name) {
  static void* library = dlopen("libGLX.so.0", RTLD_LAZY | RTLD_LOCAL);
  return reinterpret_cast<Function>(dlsym(library, name));
}

GLXContext current() {
  return real<GLXContext (*)()>("glXGetCurrentContext")();
}

bool refused(GLXContext context) {
  State& all = state();
  if (context == nullptr) return false;
  bool refuse = (all.loss == Loss::refused || all.loss == Loss::all) && context == all.lost;
  refuse = refuse || (all.loss == Loss::all && !all.others.contains(context));
  if (refuse) {
    ++all.noticed;
  } else {
    all.known.insert(context);
  }
  return refuse;
}

GLenum reset_status() {
  State& all = state();
  if (all.loss != Loss::reset || all.lost == nullptr || current() != all.lost) return GL_NO_ERROR;
  ++all.noticed;
  return GL_GUILTY_CONTEXT_RESET;
}

// Where the driver knows nothing of resets Qt asks for a context that tells of them nevertheless: it gets one that does
// not.
constexpr const char* robustness = "GLX_ARB_create_context_robustness";
bool drivers_own_robustness = false;

GLXContext create_context(Display* display, GLXFBConfig config, GLXContext share, Bool direct, const int* attributes) {
  std::vector<int> taken;
  for (; *attributes != None; attributes += 2) {
    const int name = attributes[0];
    if (name == GLX_CONTEXT_RESET_NOTIFICATION_STRATEGY_ARB && !drivers_own_robustness) continue;
    const int unknown =
        name == GLX_CONTEXT_FLAGS_ARB && !drivers_own_robustness ? GLX_CONTEXT_ROBUST_ACCESS_BIT_ARB : 0;
    taken.insert(taken.end(), {name, attributes[1] & ~unknown});
  }
  taken.push_back(None);
  const auto create = real<__GLXextFuncPtr (*)(const char*)>("glXGetProcAddress")("glXCreateContextAttribsARB");
  return reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(create)(display, config, share, direct, taken.data());
}

}  // namespace
}  // namespace atomesh::test

extern "C" {

__attribute__((visibility("default"))) const char* glXQueryExtensionsString(Display* display, int screen) {
  using namespace atomesh::test;
  static std::string names;
  names = real<decltype(&glXQueryExtensionsString)>("glXQueryExtensionsString")(display, screen);
  drivers_own_robustness = names.find(robustness) != std::string::npos;
  if (!drivers_own_robustness) names += std::string(" ") + robustness;
  return names.c_str();
}

__attribute__((visibility("default"))) Bool glXMakeCurrent(Display* display, GLXDrawable drawable, GLXContext context) {
  using namespace atomesh::test;
  if (refused(context)) return False;
  return real<decltype(&glXMakeCurrent)>("glXMakeCurrent")(display, drawable, context);
}

__attribute__((visibility("default"))) Bool glXMakeContextCurrent(Display* display, GLXDrawable draw, GLXDrawable read,
                                                                  GLXContext context) {
  using namespace atomesh::test;
  if (refused(context)) return False;
  return real<decltype(&glXMakeContextCurrent)>("glXMakeContextCurrent")(display, draw, read, context);
}

__attribute__((visibility("default"))) void glXDestroyContext(Display* display, GLXContext context) {
  using namespace atomesh::test;
  // Its address may be another's next.
  State& all = state();
  for (auto* contexts : {&all.known, &all.others, &all.deletions.others}) contexts->erase(context);
  if (all.lost == context) all.lost = nullptr;
  real<decltype(&glXDestroyContext)>("glXDestroyContext")(display, context);
}

__attribute__((visibility("default"))) __GLXextFuncPtr glXGetProcAddress(const GLubyte* name) {
  using namespace atomesh::test;
  const std::string_view text(reinterpret_cast<const char*>(name));
  if (text == "glXCreateContextAttribsARB") return reinterpret_cast<__GLXextFuncPtr>(create_context);
  if (text == "glGetGraphicsResetStatusARB") {
    state().asked = true;
    return reinterpret_cast<__GLXextFuncPtr>(reset_status);
  }
  return real<decltype(&glXGetProcAddress)>("glXGetProcAddress")(name);
}

}  // extern "C"

namespace atomesh::test {

LostContext::LostContext(Loss loss) {
  State& all = state();
  all.loss = loss;
  all.lost = current();
  all.others = all.known;
  all.others.erase(all.lost);
  all.noticed = 0;
}

LostContext::~LostContext() {
  State& all = state();
  all.loss.reset();
  all.lost = nullptr;
}

std::size_t LostContext::noticed() {
  return state().noticed;
}

bool contexts_can_be_lost() {
  return state().asked && current() != nullptr;
}

namespace {

void note_deletion() {
  Deletions& deletions = state().deletions;
  ++deletions.all;
  if (current() == nullptr || deletions.others.contains(current())) ++deletions.stray;
}

// Notes that `function`, which deletes, is called.
template <auto& function, class... Arguments>
class Noted {
 public:
  Noted() : real_(function), instead_(function, note) { real() = real_; }

 private:
  using Function = void (*)(Arguments...);
  static Function& real() {
    static Function found = nullptr;
    return found;
  }
  static void note(Arguments... arguments) {
    note_deletion();
    real()(arguments...);
  }
  Function real_;
  Instead<std::remove_reference_t<decltype(function)>> instead_;
};

struct AllNoted {
  Noted<epoxy_glDeleteBuffers, GLsizei, const GLuint*> buffers;
  Noted<epoxy_glDeleteTextures, GLsizei, const GLuint*> textures;
  Noted<epoxy_glDeleteFramebuffers, GLsizei, const GLuint*> framebuffers;
  Noted<epoxy_glDeleteVertexArrays, GLsizei, const GLuint*> vertex_arrays;
  Noted<epoxy_glDeleteQueries, GLsizei, const GLuint*> queries;
  Noted<epoxy_glDeleteProgram, GLuint> programs;
};
std::optional<AllNoted> noted;

}  // namespace

StrayDeletions::StrayDeletions() {
  State& all = state();
  all.deletions = {};
  all.deletions.others = all.known;
  all.deletions.others.erase(current());
  noted.emplace();
}

StrayDeletions::~StrayDeletions() {
  noted.reset();
}

std::size_t StrayDeletions::all() {
  return state().deletions.all;
}

std::size_t StrayDeletions::stray() {
  return state().deletions.stray;
}

}  // namespace atomesh::test
