#include "tests/app/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace atomesh::testing {

namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

[[noreturn]] void become(const std::vector<std::string>& arguments, const fs::path& folder, const fs::path& out,
                         const fs::path& err) {
  const auto redirect = [](const char* file, int flags, int to) {
    const int descriptor = open(file, flags, 0600);
    if (descriptor < 0 || dup2(descriptor, to) < 0) _exit(126);
  };
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  redirect(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  if (chdir(folder.c_str()) != 0) _exit(126);
  // A sanitizer's finding must not look like one of the program's own exit codes.
  const char* const options = std::getenv("ASAN_OPTIONS");
  setenv("ASAN_OPTIONS", ((options != nullptr ? std::string(options) + ":" : "") + "exitcode=99").c_str(), 1);
  setenv("UBSAN_OPTIONS", "exitcode=99", 1);
  std::vector<char*> words{const_cast<char*>("atomesh")};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(ATOMESH_PROGRAM, words.data());
  _exit(127);
}

Outcome run_in(const fs::path& folder, const std::vector<std::string>& arguments, int interrupt_after_ms,
               const std::string& device = "") {
  // Beside the folder, so that a test of what is left in it does not see them.
  const fs::path out = device.empty() ? folder.string() + ".out" : device;
  const fs::path err = folder.string() + ".err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(arguments, folder, out, err);
  if (interrupt_after_ms >= 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(interrupt_after_ms));
    kill(child, SIGINT);
  }
  const auto signalled = std::chrono::steady_clock::now();
  int status = 0;
  waitpid(child, &status, 0);
  const std::chrono::duration<double, std::milli> went_on = std::chrono::steady_clock::now() - signalled;
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), device.empty() ? text_of(out) : "",
                  text_of(err), went_on.count()};
  if (device.empty()) fs::remove(out);
  fs::remove(err);
  return outcome;
}

}  // namespace

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "atomesh-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  folder_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome Workplace::run(const std::vector<std::string>& arguments) const {
  return run_in(folder_, arguments, -1);
}

Outcome Workplace::run_printing_to(const std::string& device, const std::vector<std::string>& arguments) const {
  return run_in(folder_, arguments, -1, device);
}

Outcome Workplace::run_interrupted(const std::vector<std::string>& arguments, int delay_ms) const {
  return run_in(folder_, arguments, delay_ms);
}

RunningProgram Workplace::start(const std::vector<std::string>& arguments) const {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(arguments, folder_, folder_.string() + ".out", folder_.string() + ".err");
  return {child, folder_};
}

RunningProgram::~RunningProgram() {
  if (running()) finish(0);
}

bool RunningProgram::running() {
  if (!over_) over_ = waitpid(process_, &status_, WNOHANG) == process_;
  return !over_;
}

Outcome RunningProgram::finish(int deadline_ms) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  while (running()) {
    if (Clock::now() - start >= std::chrono::milliseconds(deadline_ms)) kill(process_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const std::chrono::duration<double, std::milli> went_on = Clock::now() - start;
  const std::string out = folder_.string() + ".out";
  const std::string err = folder_.string() + ".err";
  Outcome outcome{WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), text_of(out), text_of(err),
                  went_on.count()};
  std::error_code ignored;
  fs::remove(out, ignored);
  fs::remove(err, ignored);
  return outcome;
}

std::string Workplace::read(const std::string& name) const {
  return text_of(path(name));
}

void Workplace::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

std::vector<std::string> Workplace::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace atomesh::testing
