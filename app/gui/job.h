// Long work on a thread of its own, followed and cancelled from the window's.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <thread>

#include "core/progress.h"

namespace atomesh::gui {

// Starts with start(); the signals come on the thread that made the job, each of the last three at most once and
// nothing after it. Deleting a job cancels it and waits for it to end, without signals.
class Job : public QObject {
  Q_OBJECT

 public:
  // Runs beside the window; throws what it throws. What it makes it hands over through what it captured; `done` says
  // that it is there.
  using Work = std::function<void(Progress&)>;
  Job(QString title, Work work, QObject* parent = nullptr);
  ~Job() override;

  void start();
  void cancel();
  bool running() const;
  const QString& title() const { return title_; }

 signals:
  void progressed(const QString& stage, double fraction);
  void done();
  void cancelled();
  void failed(const QString& message);

 private:
  void run();

  QString title_;
  Work work_;
  std::unique_ptr<Progress> progress_;
  std::thread thread_;
  bool ended_ = false;
};

}  // namespace atomesh::gui
