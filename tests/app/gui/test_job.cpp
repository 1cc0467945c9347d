// Work beside the window: which signals come, in which order, and none after the end; cancelling; deleting.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <QStringList>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "app/gui/job.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tests/app/gui/model_test.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::wait_until;

// Everything a job says, in order.
class Listener : public QObject {
 public:
  explicit Listener(Job& job) {
    connect(&job, &Job::progressed, this,
            [this](const QString& stage, double fraction) { said << stage + QString(" %1").arg(fraction); });
    connect(&job, &Job::done, this, [this] { said << "done"; });
    connect(&job, &Job::cancelled, this, [this] { said << "cancelled"; });
    connect(&job, &Job::failed, this, [this](const QString& message) { said << "failed: " + message; });
  }
  bool ended() const {
    return !said.isEmpty() && (said.last() == "done" || said.last() == "cancelled" || said.last().startsWith("failed"));
  }
  QStringList said;
};

// A gate that work waits at until the test opens it.
class Gate {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    arrived_ = true;
    changed_.wait(lock, [this] { return open_; });
  }
  bool arrived() {
    const std::lock_guard lock(mutex_);
    return arrived_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  bool arrived_ = false;
};

TEST(Job, TellsItsProgressInOrderAndThenThatItIsDone) {
  test::core_application();
  Job job("count", [](Progress& progress) {
    progress.stage("one");
    progress.update(0.5);
    progress.stage("two");
    progress.update(1.0);
  });
  const Listener listener(job);
  EXPECT_FALSE(job.running());
  job.start();
  EXPECT_TRUE(job.running());
  EXPECT_TRUE(listener.said.isEmpty()) << "a signal within start()";
  ASSERT_TRUE(wait_until([&] { return listener.ended(); }));
  EXPECT_EQ(listener.said, (QStringList{"one 0", "one 0.5", "two 0", "two 1", "done"}));
  EXPECT_FALSE(job.running());
  job.cancel();
  job.start();  // once is all
  EXPECT_FALSE(job.running());
}

TEST(Job, SaysWhatWentWrong) {
  test::core_application();
  Job usage("fail", [](Progress&) { throw InputError("a.dat", 7, "expected \"x\""); });
  Job memory("fail", [](Progress&) { throw std::bad_alloc(); });
  const Listener of_usage(usage);
  const Listener of_memory(memory);
  usage.start();
  memory.start();
  ASSERT_TRUE(wait_until([&] { return of_usage.ended() && of_memory.ended(); }));
  EXPECT_EQ(of_usage.said, QStringList{"failed: a.dat:7: expected \"x\""});
  EXPECT_TRUE(of_memory.said.first().contains("memory"));
}

TEST(Job, CancelledIsTheLastThatIsHeard) {
  test::core_application();
  Gate gate;
  Job job("wait", [&gate](Progress& progress) {
    progress.stage("waiting");
    gate.wait();
    progress.update(0.5);
  });
  const Listener listener(job);
  job.start();
  ASSERT_TRUE(wait_until([&] { return gate.arrived(); }));
  job.cancel();
  gate.open();
  ASSERT_TRUE(wait_until([&] { return listener.ended(); }));
  EXPECT_EQ(listener.said, (QStringList{"waiting 0", "cancelled"}));
}

TEST(Job, DeletedWhileItRunsItEndsInSilenceAndItsWorkIsOver) {
  test::core_application();
  std::atomic<bool> over{false};
  auto job = std::make_unique<Job>("run", [&over](Progress& progress) {
    struct AtEnd {
      std::atomic<bool>& flag;
      ~AtEnd() { flag = true; }
    } const at_end{over};
    progress.stage("running");
    while (true) progress.check();
  });
  const Listener listener(*job);
  job->start();
  ASSERT_TRUE(wait_until([&] { return !listener.said.isEmpty(); }));
  job.reset();
  EXPECT_TRUE(over);
  QCoreApplication::processEvents();
  EXPECT_EQ(listener.said, QStringList{"running 0"});
  Job never_started("rest", [](Progress&) { FAIL(); });
}

TEST(Job, WhatDoesNotHeedACancelIsLeft) {
  test::core_application();
  const auto gate = std::make_shared<Gate>();
  Job job(
      "deaf", [gate](Progress&) { gate->wait(); }, nullptr, Job::Unheeded::leave);
  const Listener listener(job);
  job.start();
  ASSERT_TRUE(wait_until([&] { return gate->arrived(); }));
  EXPECT_FALSE(Job::any_left());
  QElapsedTimer watch;
  watch.start();
  job.cancel();
  ASSERT_TRUE(wait_until([&] { return listener.ended(); }));
  EXPECT_LT(watch.elapsed(), 200);
  EXPECT_EQ(listener.said, QStringList{"cancelled"});
  EXPECT_TRUE(Job::any_left());

  const auto other_gate = std::make_shared<Gate>();
  auto deleted = std::make_unique<Job>(
      "deaf", [other_gate](Progress&) { other_gate->wait(); }, nullptr, Job::Unheeded::leave);
  deleted->start();
  ASSERT_TRUE(wait_until([&] { return other_gate->arrived(); }));
  watch.start();
  deleted.reset();
  EXPECT_LT(watch.elapsed(), 200);
  gate->open();
  other_gate->open();
  EXPECT_TRUE(wait_until([] { return !Job::any_left(); }));
  EXPECT_EQ(listener.said, QStringList{"cancelled"});
}

// Also the threads of its parallel loops, and not those of the window.
TEST(Job, StandsBackBehindTheWindow) {
  test::core_application();
  const auto niceness = [] { return getpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid))); };
  const int of_window = niceness();
  std::atomic<int> least{1000};
  Job job("measure", [&](Progress&) {
    parallel_for(64, 1, [&](std::size_t, std::size_t) {
      int before = least;
      const int mine = niceness();
      while (mine < before && !least.compare_exchange_weak(before, mine)) {
      }
    });
  });
  const Listener listener(job);
  job.start();
  ASSERT_TRUE(wait_until([&] { return listener.ended(); }));
  EXPECT_EQ(niceness(), of_window);
  EXPECT_GE(least, std::min(of_window + 5, 19));
}

}  // namespace
