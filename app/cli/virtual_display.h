// Where OpenGL windows of a peer open: the display that DISPLAY names, or a virtual one of our own.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace atomesh::cli {

// While it lives, DISPLAY names an X server with GLX, if there can be one: the user's, else an Xvfb started here, which
// ends with this object or with the process, however that ends. Windows must be closed before. One at a time: it
// changes the environment.
class VirtualDisplay {
 public:
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  bool available() const { return why_not_.empty(); }
  // "no display: DISPLAY is not set and Xvfb is not installed"; "" when there is one.
  const std::string& why_not() const { return why_not_; }
  // "the display :0", "Xvfb".
  const std::string& name() const { return name_; }

 private:
  void start_server();
  void end_server();

  std::string name_;
  std::string why_not_;
  std::optional<std::string> users_;  // what DISPLAY was
  pid_t server_ = -1;
};

}  // namespace atomesh::cli
