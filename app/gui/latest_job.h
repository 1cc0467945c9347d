// Work that is done anew when what it is about changes: one job at a time, and only the latest one's result counts.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <optional>

#include "app/gui/job.h"

namespace atomesh::gui {

// On the window's thread. run() while a job runs cancels it, and begins when it has ended: the window never waits. The
// work must own all it touches (Job::Unheeded::leave).
class LatestJob : public QObject {
 public:
  explicit LatestJob(QObject* parent = nullptr);

  // One of `done` and `failed` (with the message) is called, unless another run() or cancel() comes before the end.
  void run(QString title, Job::Work work, std::function<void()> done, std::function<void(const QString&)> failed);
  void cancel();
  // Something was asked for that has neither ended nor been cancelled.
  bool running() const { return current_.has_value(); }

 private:
  struct Request {
    QString title;
    Job::Work work;
    std::function<void()> done;
    std::function<void(const QString&)> failed;
  };
  void start();
  // The job is over; tells whether what was asked for is what it did.
  std::optional<Request> end();

  std::optional<Request> current_;  // what is asked for
  std::unique_ptr<Job> job_;        // of current_, or, while superseded_, of an earlier one that is ending
  bool superseded_ = false;
};

}  // namespace atomesh::gui
