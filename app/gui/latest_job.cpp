#include "app/gui/latest_job.h"

#include <utility>

namespace atomesh::gui {

LatestJob::LatestJob(QObject* parent) : QObject(parent) {}

void LatestJob::run(QString title, Job::Work work, std::function<void()> done,
                    std::function<void(const QString&)> failed) {
  current_ = Request{std::move(title), std::move(work), std::move(done), std::move(failed)};
  if (job_) {
    superseded_ = true;
    job_->cancel();
  } else {
    start();
  }
}

void LatestJob::cancel() {
  current_.reset();
  if (!job_) return;
  superseded_ = true;
  job_->cancel();
}

void LatestJob::start() {
  superseded_ = false;
  job_ = std::make_unique<Job>(current_->title, current_->work, nullptr, Job::Unheeded::leave);
  connect(job_.get(), &Job::done, this, [this] {
    if (const auto request = end()) request->done();
  });
  connect(job_.get(), &Job::failed, this, [this](const QString& message) {
    if (const auto request = end()) request->failed(message);
  });
  connect(job_.get(), &Job::cancelled, this, [this] { end(); });
  job_->start();
}

std::optional<LatestJob::Request> LatestJob::end() {
  job_.release()->deleteLater();
  if (!superseded_) return std::exchange(current_, std::nullopt);
  if (current_) start();
  return std::nullopt;
}

}  // namespace atomesh::gui
