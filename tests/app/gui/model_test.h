// For tests of what is under the window: an event loop without a display, and waiting for what must come.
#pragma once

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QTimer>
#include <functional>

namespace atomesh::test {

// One for the process; made at the first use.
inline QCoreApplication& core_application() {
  static int count = 1;
  static char name[] = "atomesh";
  static char* words[] = {name, nullptr};
  static QCoreApplication application(count, words);
  return application;
}

// Handles events until `condition` holds, or, and then it is false, for so long.
inline bool wait_until(const std::function<bool()>& condition, int deadline_ms = 60000) {
  if (QCoreApplication::instance() == nullptr) core_application();
  QElapsedTimer watch;
  watch.start();
  QTimer wake;  // a condition may change without an event
  wake.start(5);
  while (!condition()) {
    if (watch.elapsed() > deadline_ms) return false;
    QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents);
  }
  return true;
}

}  // namespace atomesh::test
