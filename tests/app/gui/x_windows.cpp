#include "tests/app/gui/x_windows.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

namespace atomesh::test {

namespace {

// Windows may go while one looks at them.
int pass_over(Display*, XErrorEvent*) {
  return 0;
}

std::string title_of(Display* display, Window window) {
  std::string title;
  XTextProperty text{};
  const Atom utf8_name = XInternAtom(display, "_NET_WM_NAME", False);
  if (XGetTextProperty(display, window, &text, utf8_name) != 0 && text.value != nullptr) {
    title.assign(text.value, text.value + text.nitems);
    XFree(text.value);
  }
  return title;
}

void visit(Display* display, Window window, const std::function<void(Window, const std::string&)>& see) {
  XWindowAttributes attributes{};
  if (XGetWindowAttributes(display, window, &attributes) != 0 && attributes.map_state == IsViewable) {
    const std::string title = title_of(display, window);
    if (!title.empty()) {
      see(window, title);
      return;
    }
  }
  Window root = 0;
  Window parent = 0;
  Window* children = nullptr;
  unsigned count = 0;
  if (XQueryTree(display, window, &root, &parent, &children, &count) == 0) return;
  for (unsigned i = 0; i < count; ++i) visit(display, children[i], see);
  if (children != nullptr) XFree(children);
}

void visit_all(const std::function<void(Display*, Window, const std::string&)>& see) {
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr) return;
  const auto before = XSetErrorHandler(pass_over);
  visit(display, DefaultRootWindow(display),
        [&](Window window, const std::string& title) { see(display, window, title); });
  XSync(display, False);
  XSetErrorHandler(before);
  XCloseDisplay(display);
}

}  // namespace

std::vector<std::string> window_titles() {
  std::vector<std::string> titles;
  visit_all([&](Display*, Window, const std::string& title) { titles.push_back(title); });
  return titles;
}

bool wait_for_window(const std::string& title, int deadline_ms) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(deadline_ms);
  while (std::chrono::steady_clock::now() < deadline) {
    const std::vector<std::string> titles = window_titles();
    if (std::find(titles.begin(), titles.end(), title) != titles.end()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

int close_windows(const std::string& title) {
  int closed = 0;
  visit_all([&](Display* display, Window window, const std::string& its_title) {
    if (its_title != title) return;
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    event.xclient.data.l[1] = CurrentTime;
    XSendEvent(display, window, False, NoEventMask, &event);
    ++closed;
  });
  return closed;
}

}  // namespace atomesh::test
