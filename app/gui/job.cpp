#include "app/gui/job.h"

#include <QMetaObject>
#include <exception>
#include <new>
#include <utility>

#include "core/error.h"

namespace atomesh::gui {

Job::Job(QString title, Work work, QObject* parent)
    : QObject(parent), title_(std::move(title)), work_(std::move(work)) {
  progress_ = std::make_unique<Progress>([this](std::string_view stage, double fraction) {
    const QString name = QString::fromUtf8(stage.data(), static_cast<qsizetype>(stage.size()));
    QMetaObject::invokeMethod(
        this,
        [this, name, fraction] {
          if (!ended_) emit progressed(name, fraction);
        },
        Qt::QueuedConnection);
  });
}

Job::~Job() {
  ended_ = true;
  progress_->request_cancel();
  if (thread_.joinable()) thread_.join();
}

void Job::start() {
  if (!thread_.joinable() && !ended_) thread_ = std::thread([this] { run(); });
}

void Job::cancel() {
  progress_->request_cancel();
}

bool Job::running() const {
  return thread_.joinable() && !ended_;
}

void Job::run() {
  // What is posted is delivered by the thread of the window, and not at all once the job is gone.
  const auto end_with = [this](auto signal) {
    QMetaObject::invokeMethod(
        this,
        [this, signal] {
          if (ended_) return;
          ended_ = true;
          thread_.join();
          signal();
        },
        Qt::QueuedConnection);
  };
  try {
    work_(*progress_);
    end_with([this] { emit done(); });
  } catch (const CancelledError&) {
    end_with([this] { emit cancelled(); });
  } catch (const std::bad_alloc&) {
    end_with([this] { emit failed(tr("not enough memory; close other programs or open a smaller file")); });
  } catch (const std::exception& error) {
    end_with([this, message = QString::fromUtf8(error.what())] { emit failed(message); });
  }
}

}  // namespace atomesh::gui
