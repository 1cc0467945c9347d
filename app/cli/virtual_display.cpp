#include "app/cli/virtual_display.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace atomesh::cli {

namespace {

constexpr int start_ms = 15000;  // a server on a busy machine may take its time

// Whether windows can be opened there: an X server that answers and has GLX. VTK ends the process where this is not so.
bool answers(const char* display) {
  void* library = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return false;
  // NOLINTBEGIN: what dlsym returns is a function
  const auto open = reinterpret_cast<void* (*)(const char*)>(dlsym(library, "XOpenDisplay"));
  const auto query = reinterpret_cast<int (*)(void*, const char*, int*, int*, int*)>(dlsym(library, "XQueryExtension"));
  const auto close = reinterpret_cast<int (*)(void*)>(dlsym(library, "XCloseDisplay"));
  // NOLINTEND
  if (open == nullptr || query == nullptr || close == nullptr) return false;
  void* connection = open(display);
  if (connection == nullptr) return false;
  int opcode = 0;
  int event = 0;
  int error = 0;
  const bool glx = query(connection, "GLX", &opcode, &event, &error) != 0;
  close(connection);
  return glx;
}

// Replaces this process, which is a fork, by a server that writes its number into `number_to`.
[[noreturn]] void become_server(int number_to, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);     // ends with us even if we are killed
  if (getppid() != parent) _exit(127);  // which has happened already
  setsid();                             // Ctrl-C is for us, who then close the windows first
  constexpr int number_fd = 3;
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  if (number_to == number_fd) {
    fcntl(number_fd, F_SETFD, 0);
  } else {
    dup2(number_to, number_fd);
  }
  execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset", nullptr);
  _exit(127);
}

// The line that comes through the pipe within start_ms, without its end; "" where none comes.
std::string read_line(int from) {
  std::string line;
  pollfd waiting{from, POLLIN, 0};
  while (poll(&waiting, 1, start_ms) > 0) {
    char c = 0;
    if (read(from, &c, 1) != 1) return "";
    if (c == '\n') return line;
    line += c;
  }
  return "";
}

}  // namespace

VirtualDisplay::VirtualDisplay() {
  if (const char* display = std::getenv("DISPLAY")) users_ = display;
  if (users_ && answers(users_->c_str())) {
    name_ = "the display " + *users_;
    return;
  }
  start_server();
}

VirtualDisplay::~VirtualDisplay() {
  end_server();
}

void VirtualDisplay::start_server() {
  const std::string before = users_ ? "DISPLAY " + *users_ + " does not answer or has no GLX" : "DISPLAY is not set";
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    why_not_ = "no display: " + before;
    return;
  }
  const pid_t parent = getpid();
  server_ = fork();
  if (server_ == 0) become_server(pipe_ends[1], parent);
  close(pipe_ends[1]);
  const std::string number = server_ > 0 ? read_line(pipe_ends[0]) : "";
  close(pipe_ends[0]);
  const std::string display = ":" + number;
  if (number.empty() || !answers(display.c_str())) {
    end_server();
    why_not_ = "no display: " + before + ", and no Xvfb with GLX could be started";
    return;
  }
  setenv("DISPLAY", display.c_str(), 1);
  name_ = "Xvfb";
}

void VirtualDisplay::end_server() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
  server_ = -1;
  if (users_) {
    setenv("DISPLAY", users_->c_str(), 1);
  } else {
    unsetenv("DISPLAY");
  }
}

}  // namespace atomesh::cli
