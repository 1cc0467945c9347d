// For tests of widgets and of the whole window: a display, an application, waiting for what must come.
//
// window_test.cpp brings main(): link atomesh_window_test. Settings go into a folder that is removed at the end.
#pragma once

#include <QImage>
#include <QPalette>
#include <QString>
#include <QWidget>
#include <functional>
#include <string>

#include "app/gui/document.h"
#include "core/image.h"
#include "core/parameters.h"

namespace atomesh::test {

// Handles events until `condition` holds, or, and then it is false, for so long.
bool wait_for(const std::function<bool()>& condition, int deadline_ms = 60000);

// The child of that object name, of a hidden one too; fails the test and throws where there is none.
template <class Widget>
Widget& child(const QObject& parent, const QString& name) {
  Widget* const found = parent.findChild<Widget*>(name);
  if (found == nullptr) throw std::runtime_error("no " + name.toStdString() + " in the window");
  return *found;
}

// Shows the widget and waits until it is on the screen.
void show(QWidget& widget);

// A small crystal with a crack, preprocessed with everything: some 1,800 atoms of NaCl.
std::string cracked_salt_crb(const std::string& folder);
// Its file of atoms.
std::string cracked_salt_dat(const std::string& folder);

// As compare_images() has it.
Image to_image(const QImage& image);
// Into $ATOMESH_SCREENSHOTS where that is set, for people to look at.
void keep_screenshot(const QImage& image, const std::string& name);

// As a desktop's dark theme has it.
QPalette dark_palette();

// Whether the test has a real display (Xvfb or the user's) with OpenGL; tests of the viewport say visibly when not.
bool has_opengl();

}  // namespace atomesh::test
