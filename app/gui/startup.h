// Before the first window: whether there can be one here, and if not, why, and what works without.
#pragma once

#include <functional>
#include <string>

namespace atomesh::gui {

// Everything that runs without a window, as the end of a message.
std::string without_window(const std::string& reason);

// Why no window system can be reached, as far as the environment says; "" when it may be. `variable` gives the value of
// an environment variable or nullptr (std::getenv).
std::string missing_display(const std::function<const char*(const char*)>& variable);

// Qt ends the process where it cannot start on the window system. From here to the end of the object's life it is
// ended with exit code 3, our message and Qt's reason.
class PlatformGuard {
 public:
  PlatformGuard();
  ~PlatformGuard();
  PlatformGuard(const PlatformGuard&) = delete;
  PlatformGuard& operator=(const PlatformGuard&) = delete;
};

// VTK draws through GLX: where X can be had beside Wayland, and the user has not chosen, Qt is told to take X.
void prefer_x();

// Once there is a QGuiApplication: why its OpenGL is not enough for the view, or "".
std::string missing_opengl();

// At the end of main, after the window is gone: returns the code, or ends the process with it at once when work that
// did not heed its cancel still runs.
int end_process(int exit_code);

}  // namespace atomesh::gui
