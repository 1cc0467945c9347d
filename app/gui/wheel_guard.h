// Keeps the mouse wheel from changing values by accident.
#pragma once

class QWidget;

namespace atomesh::gui {

// The wheel turns the widget's value only while it has the focus, which it no longer takes by the wheel; else what is
// around it scrolls.
void guard_wheel(QWidget* widget);

}  // namespace atomesh::gui
