#include "app/gui/job.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <QMetaObject>
#include <QTimer>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <new>
#include <utility>

#include "core/error.h"

namespace atomesh::gui {

namespace {

std::atomic<int> left{0};

// The scheduler then serves the window first, however many threads compute. What this thread starts inherits it.
void stand_back() {
  constexpr int niceness = 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness);
}

}  // namespace

void Courier::post(std::function<void()> message) {
  const std::lock_guard lock(mutex_);
  if (to_ != nullptr) QMetaObject::invokeMethod(to_, std::move(message), Qt::QueuedConnection);
}

void Courier::close() {
  const std::lock_guard lock(mutex_);
  to_ = nullptr;
}

struct Job::Run {
  Run(Job* to, Work work_to_do)
      : job(to), courier(to), work(std::move(work_to_do)), progress([this](std::string_view stage, double fraction) {
          const QString name = QString::fromUtf8(stage.data(), static_cast<qsizetype>(stage.size()));
          courier.post([to = job, name, fraction] {
            if (!to->ended_) emit to->progressed(name, fraction);
          });
        }) {}

  // The end of the work, for who waits for it.
  void set_over() {
    const std::lock_guard lock(mutex);
    is_over = true;
    over.notify_all();
  }
  bool wait_until_over(int ms) {
    std::unique_lock lock(mutex);
    return over.wait_for(lock, std::chrono::milliseconds(ms), [this] { return is_over; });
  }

  Job* job;  // only in what the courier brings
  Courier courier;
  Work work;
  Progress progress;
  std::mutex mutex;
  std::condition_variable over;
  bool is_over = false;
};

Job::Job(QString title, Work work, QObject* parent, Unheeded unheeded)
    : QObject(parent), title_(std::move(title)), unheeded_(unheeded) {
  run_ = std::make_shared<Run>(this, std::move(work));
}

Job::~Job() {
  ended_ = true;
  run_->courier.close();
  run_->progress.request_cancel();
  if (!thread_.joinable()) return;
  if (unheeded_ == Unheeded::wait || run_->wait_until_over(patience_ms)) {
    thread_.join();
  } else {
    leave();
  }
}

void Job::start() {
  if (thread_.joinable() || ended_) return;
  thread_ = std::thread([shared = run_]() mutable {
    run(shared);
    // In this order: who has seen that it is over finds nothing of it alive.
    const std::shared_ptr<Run> last = std::move(shared);
    last->set_over();
  });
}

void Job::cancel() {
  run_->progress.request_cancel();
  if (unheeded_ == Unheeded::wait || !running()) return;
  QTimer::singleShot(patience_ms, this, [this] {
    if (ended_) return;
    ended_ = true;
    run_->courier.close();
    leave();
    emit cancelled();
  });
}

bool Job::running() const {
  return thread_.joinable() && !ended_;
}

bool Job::any_left() {
  return left.load() > 0;
}

void Job::leave() {
  ++left;
  // Another thread sees it to its end, so that it counts as left until nothing of it is there.
  std::thread([thread = std::move(thread_)]() mutable {
    thread.join();
    --left;
  }).detach();
}

void Job::end_with(const std::function<void()>& signal) {
  if (ended_) return;
  ended_ = true;
  thread_.join();
  signal();
}

void Job::run(const std::shared_ptr<Run>& run) {
  stand_back();
  Job* const job = run->job;
  const auto end_with = [&](std::function<void()> signal) {
    run->courier.post([job, signal = std::move(signal)] { job->end_with(signal); });
  };
  try {
    run->work(run->progress);
    end_with([job] { emit job->done(); });
  } catch (const CancelledError&) {
    end_with([job] { emit job->cancelled(); });
  } catch (const std::bad_alloc&) {
    end_with([job] { emit job->failed(tr("not enough memory; close other programs or open a smaller file")); });
  } catch (const std::exception& error) {
    end_with([job, message = QString::fromUtf8(error.what())] { emit job->failed(message); });
  }
}

}  // namespace atomesh::gui
