// The program as a window.
#pragma once

#include <string>
#include <vector>

namespace atomesh::gui {

struct WindowArguments {
  std::vector<std::string> files;  // at most one data file, at most one .crf
  std::string parameters;          // a .crf, or ""
  // Closes once the picture is complete, after printing how long the program took to the first picture and to that one,
  // from the start of its process: "first picture after 310 ms, complete after 450 ms". Needs a file.
  bool until_shown = false;
};

// Opens the window and returns its exit code when it is closed. Throws UnavailableError, naming the headless
// subcommands, where there is no display or no OpenGL 3.2 (or ends the process so, where Qt leaves no choice), and
// UsageError for more files than one can show.
int run_window(const WindowArguments& arguments);

// The OpenGL that windows ask for; before the application is made.
void set_surface_format();

}  // namespace atomesh::gui
