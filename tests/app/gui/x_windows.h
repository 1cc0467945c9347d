// The windows of other processes on the display, as a window manager sees them.
#pragma once

#include <string>
#include <vector>

namespace atomesh::test {

// Titles of the top-level windows that are on the screen; empty where there is no X.
std::vector<std::string> window_titles();

// Waits until there is one of this title; false when it does not come in time.
bool wait_for_window(const std::string& title, int deadline_ms);

// Asks them to close, as a click on their cross does; how many there were.
int close_windows(const std::string& title);

}  // namespace atomesh::test
