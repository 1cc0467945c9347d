// Long work on a thread of its own, followed and cancelled from the window's.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "core/progress.h"

namespace atomesh::gui {

// Brings messages from other threads to that of an object, and none once it is closed. May outlive the object.
class Courier {
 public:
  explicit Courier(QObject* to) : to_(to) {}
  // Runs `message` on the object's thread, later; drops it when the courier, or the object, is gone before.
  void post(std::function<void()> message);
  // By the object's thread, before the object goes.
  void close();

 private:
  std::mutex mutex_;
  QObject* to_;
};

// Starts with start(); the signals come on the thread that made the job, each of the last three at most once and
// nothing after it. The thread, with all the threads of its parallel loops, stands back behind the window's (nice).
// Deleting a job cancels it and waits for it to end, without signals.
class Job : public QObject {
  Q_OBJECT

 public:
  // Runs beside the window; throws what it throws. What it makes it hands over through what it captured; `done` says
  // that it is there.
  using Work = std::function<void(Progress&)>;
  // What becomes of work that does not heed a cancel within patience_ms: a library that knows none, a disk that does
  // not answer. leave: it is cancelled all the same, and goes on by itself until it notices; it must own all it
  // touches.
  enum class Unheeded { wait, leave };
  static constexpr int patience_ms = 120;

  Job(QString title, Work work, QObject* parent = nullptr, Unheeded unheeded = Unheeded::wait);
  ~Job() override;

  void start();
  void cancel();
  bool running() const;
  const QString& title() const { return title_; }

  // Whether any work was left to itself and is not over: the program must then end without destroying what it may use
  // (std::_Exit).
  static bool any_left();

 signals:
  void progressed(const QString& stage, double fraction);
  void done();
  void cancelled();
  void failed(const QString& message);

 private:
  struct Run;  // what the thread uses
  static void run(const std::shared_ptr<Run>& run);
  void end_with(const std::function<void()>& signal);
  void leave();

  QString title_;
  Unheeded unheeded_;
  std::shared_ptr<Run> run_;
  std::thread thread_;
  bool ended_ = false;
};

}  // namespace atomesh::gui
