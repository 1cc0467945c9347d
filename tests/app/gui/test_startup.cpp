// The program as a process: it opens its window, says why it cannot, and ends at once when the window is closed.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>

#include "app/cli/virtual_display.h"
#include "app/gui/startup.h"
#include "tests/app/gui/x_windows.h"
#include "tests/app/program.h"

namespace {

using namespace atomesh;
using atomesh::testing::Outcome;
using atomesh::testing::RunningProgram;
using atomesh::testing::Workplace;

#if defined(__SANITIZE_ADDRESS__)
constexpr double slowdown = 10.0;  // of code under the sanitizers
#else
constexpr double slowdown = 1.0;
#endif

constexpr int not_here = 3;
constexpr int patience_ms = 60000;

// Sets a variable of the environment, and back at the end.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    if (value != nullptr) {
      setenv(name, value, 1);
    } else {
      unsetenv(name);
    }
  }
  ~Variable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

void expect_no_window(const Workplace& place, const std::string& reason) {
  const Outcome outcome = place.run({});
  EXPECT_EQ(outcome.exit_code, not_here) << outcome.err;
  for (const std::string& words : {reason, std::string("no window"), std::string("atomesh render"),
                                   std::string("atomesh preprocess"), std::string("defects")}) {
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << " is not in:\n" << outcome.err;
  }
}

TEST(Displays, AreToldByTheEnvironment) {
  const auto only = [](const std::string& name, const char* value) {
    return gui::missing_display([=](const char* asked) { return asked == name ? value : nullptr; });
  };
  EXPECT_EQ(only("DISPLAY", ":0"), "");
  EXPECT_EQ(only("WAYLAND_DISPLAY", "wayland-0"), "");
  EXPECT_EQ(only("QT_QPA_PLATFORM", "offscreen"), "");
  EXPECT_NE(only("DISPLAY", ""), "");
  EXPECT_NE(only("HOME", "/"), "");
}

TEST(NoWindow, WithoutADisplay) {
  const Workplace place;
  const Variable platform("QT_QPA_PLATFORM", nullptr);
  const Variable wayland("WAYLAND_DISPLAY", nullptr);
  {
    const Variable display("DISPLAY", nullptr);
    expect_no_window(place, "DISPLAY");
  }
  const Variable display("DISPLAY", ":987");  // where nobody listens
  expect_no_window(place, ":987");
}

TEST(NoWindow, WithoutQtsPlugin) {
  const Workplace place;
  const Variable platform("QT_QPA_PLATFORM", "no-such-platform");
  expect_no_window(place, "no-such-platform");
}

// What needs a display of our own.
class StartupOnDisplay : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { display.emplace(); }
  static void TearDownTestSuite() { display.reset(); }
  void SetUp() override {
    if (!display->available()) GTEST_SKIP() << display->why_not();
  }
  static std::optional<cli::VirtualDisplay> display;

  Workplace settings;  // nothing that the user of this machine has set
  Variable config{"XDG_CONFIG_HOME", settings.path("").c_str()};
  Variable platform{"QT_QPA_PLATFORM", nullptr};
  Variable runtime{"XDG_RUNTIME_DIR", settings.path("").c_str()};
  Workplace place;
};

std::optional<cli::VirtualDisplay> StartupOnDisplay::display;

TEST_F(StartupOnDisplay, AnOldOpenGLIsNotEnough) {
  const Variable version("MESA_GL_VERSION_OVERRIDE", "2.1");
  const Variable software("LIBGL_ALWAYS_SOFTWARE", "1");
  expect_no_window(place, "OpenGL");
  expect_no_window(place, "3.2");
}

TEST_F(StartupOnDisplay, NoOpenGLIsNotEnough) {
  const Variable integration("QT_XCB_GL_INTEGRATION", "none");
  expect_no_window(place, "OpenGL");
}

TEST_F(StartupOnDisplay, OpensTheLoaderAndEndsWhenItIsClosed) {
  RunningProgram program = place.start({});
  ASSERT_TRUE(test::wait_for_window("atomesh", patience_ms)) << program.finish(0).err;
  EXPECT_EQ(test::close_windows("atomesh"), 1);
  const Outcome outcome = program.finish(patience_ms);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LT(outcome.ms_after_signal, 2000.0 * slowdown);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(StartupOnDisplay, AFileGoesStraightOn) {
  ASSERT_EQ(place.run({"sample", "diamond-vacancy", "--atoms", "4000", "-o", "d.dat"}).exit_code, 0);
  RunningProgram program = place.start({"d.dat"});
  // Preprocessed, saved, and shown.
  ASSERT_TRUE(test::wait_for_window("d.dat – atomesh", patience_ms)) << program.finish(0).err;
  EXPECT_EQ(place.files(), (std::vector<std::string>{"d.crb", "d.dat"}));
  test::close_windows("d.dat – atomesh");
  EXPECT_EQ(program.finish(patience_ms).exit_code, 0);

  RunningProgram again = place.start({"d.crb"});
  ASSERT_TRUE(test::wait_for_window("d.crb – atomesh", patience_ms)) << again.finish(0).err;
  test::close_windows("d.crb – atomesh");
  EXPECT_EQ(again.finish(patience_ms).exit_code, 0);
}

TEST_F(StartupOnDisplay, ClosedWhilePreprocessingItEndsAtOnceAndLeavesNothing) {
  ASSERT_EQ(place.run({"sample", "diamond-vacancy", "--atoms", "1000000", "-o", "d.dat"}).exit_code, 0);
  RunningProgram program = place.start({"d.dat"});
  ASSERT_TRUE(test::wait_for_window("Preprocessing d.dat – atomesh", patience_ms)) << program.finish(0).err;
  EXPECT_EQ(test::close_windows("Preprocessing d.dat – atomesh"), 1);
  const Outcome outcome = program.finish(patience_ms);
  std::printf("ended %.0f ms after its window was closed\n", outcome.ms_after_signal);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LT(outcome.ms_after_signal, 2000.0 * slowdown);
  EXPECT_EQ(place.files(), std::vector<std::string>{"d.dat"});
  EXPECT_NE(::kill(program.process(), 0), 0);
}

// Not even a process that is killed leaves a part of a file.
TEST_F(StartupOnDisplay, KilledItLeavesNothing) {
  ASSERT_EQ(place.run({"sample", "diamond-vacancy", "--atoms", "1000000", "-o", "d.dat"}).exit_code, 0);
  RunningProgram program = place.start({"d.dat"});
  ASSERT_TRUE(test::wait_for_window("Preprocessing d.dat – atomesh", patience_ms)) << program.finish(0).err;
  EXPECT_EQ(program.finish(0).exit_code, 128 + 9);
  EXPECT_EQ(place.files(), std::vector<std::string>{"d.dat"});
}

}  // namespace
