// Work on a thread of its own: when it is over, what it throws, and that nothing of it goes on that was given up.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <new>
#include <thread>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/gl/beside.h"

namespace atomesh::gl {
namespace {

constexpr double long_ms = 60000.0;

// Until it is cancelled.
void go_on(const Progress& progress) {
  for (;;) {
    progress.check();
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

// A gate that a test opens.
class Gate {
 public:
  void open() {
    open_ = true;
    open_.notify_all();
  }
  void pass() const { open_.wait(false); }

 private:
  std::atomic<bool> open_{false};
};

TEST(Beside, IsOverAtFirst) {
  Beside beside;
  EXPECT_FALSE(beside.started());
  EXPECT_FALSE(beside.cancelled());
  EXPECT_TRUE(beside.over(0.0));
  // Of nothing.
  beside.cancel();
  beside.give_up();
  EXPECT_NO_THROW(beside.take());
  EXPECT_FALSE(beside.started());
}

TEST(Beside, RunsOnAnotherThread) {
  Beside beside;
  Gate gate;
  std::thread::id id;
  beside.start([&](Progress&) {
    gate.pass();
    id = std::this_thread::get_id();
  });
  EXPECT_TRUE(beside.started());
  for (const double milliseconds : {0.0, -1.0, -std::numeric_limits<double>::infinity(), 5.0}) {
    EXPECT_FALSE(beside.over(milliseconds)) << milliseconds;
  }
  gate.open();
  EXPECT_TRUE(beside.over(std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(beside.over(0.0));
  EXPECT_TRUE(beside.started());  // and not taken
  beside.take();
  EXPECT_FALSE(beside.started());
  EXPECT_NE(id, std::thread::id());
  EXPECT_NE(id, std::this_thread::get_id());
}

TEST(Beside, WaitsAsLongAsItIsToldTo) {
  Beside beside;
  beside.start(go_on);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(beside.over(30.0));
  EXPECT_GE(ms_since(start), 30.0);
}

TEST(Beside, TakingWaitsForTheEnd) {
  Beside beside;
  std::atomic<bool> done{false};
  beside.start([&](Progress&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    done = true;
  });
  beside.take();
  EXPECT_TRUE(done);
}

TEST(Beside, TakingThrowsWhatTheWorkThrewOnce) {
  Beside beside;
  beside.start([](Progress&) { throw UnavailableError("no memory"); });
  EXPECT_TRUE(beside.over(long_ms));
  EXPECT_THROW(beside.take(), UnavailableError);
  EXPECT_FALSE(beside.started());
  EXPECT_NO_THROW(beside.take());
  beside.start([](Progress&) { throw std::bad_alloc(); });
  EXPECT_THROW(beside.take(), std::bad_alloc);
  // What is given up throws nothing.
  beside.start([](Progress&) { throw UnavailableError("no memory"); });
  EXPECT_NO_THROW(beside.give_up());
}

TEST(Beside, CancellingAsksAndDoesNotWait) {
  Beside beside;
  Gate gate;
  beside.start([&](Progress& progress) {
    gate.pass();  // hears of nothing until then
    progress.check();
  });
  beside.cancel();
  EXPECT_TRUE(beside.cancelled());
  EXPECT_TRUE(beside.started());
  EXPECT_FALSE(beside.over(0.0));
  gate.open();
  EXPECT_THROW(beside.take(), CancelledError);
  EXPECT_FALSE(beside.cancelled());
}

TEST(Beside, GivingUpEndsTheWork) {
  Beside beside;
  std::atomic<bool> at_work{false};
  beside.start([&](Progress& progress) {
    at_work = true;
    try {
      go_on(progress);
    } catch (...) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      at_work = false;
      throw;
    }
  });
  while (!at_work) std::this_thread::yield();
  beside.give_up();
  EXPECT_FALSE(at_work);
  EXPECT_FALSE(beside.started());
  EXPECT_TRUE(beside.over(0.0));
}

// One at a time, and the next is not cancelled with the one before.
TEST(Beside, StartingGivesUpWhatGoesOn) {
  Beside beside;
  std::atomic<int> at_work{0};
  const auto work = [&](Progress& progress) {
    EXPECT_EQ(++at_work, 1);
    try {
      go_on(progress);
    } catch (...) {
      --at_work;
      throw;
    }
  };
  for (int i = 0; i < 20; ++i) {
    beside.start(work);
    if (i % 2 == 0) {
      while (at_work == 0) std::this_thread::yield();
    }
  }
  bool cancelled = true;
  beside.start([&](Progress& progress) { cancelled = progress.cancelled(); });
  EXPECT_FALSE(beside.cancelled());
  beside.take();
  EXPECT_FALSE(cancelled);
  EXPECT_EQ(at_work, 0);
}

TEST(Beside, EndsWithItsOwner) {
  std::atomic<bool> at_work{false};
  {
    Beside beside;
    beside.start([&](Progress& progress) {
      at_work = true;
      try {
        go_on(progress);
      } catch (...) {
        at_work = false;
        throw;
      }
    });
    while (!at_work) std::this_thread::yield();
  }
  EXPECT_FALSE(at_work);
}

}  // namespace
}  // namespace atomesh::gl
