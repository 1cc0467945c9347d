// Runs the program as a user does, in a folder of its own.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace atomesh::testing {

struct Outcome {
  int exit_code = -1;  // 128 + signal when a signal ended it
  std::string out;
  std::string err;
  double ms_after_signal = 0.0;  // of run_interrupted: how long it went on
};

// A program that was started and goes on beside the test; killed with the object.
class RunningProgram {
 public:
  RunningProgram(int process, std::filesystem::path folder) : process_(process), folder_(std::move(folder)) {}
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  int process() const { return process_; }
  bool running();
  // Waits for its end, at most so long, and then kills it (exit code 128 + 9).
  Outcome finish(int deadline_ms);

 private:
  int process_;
  bool over_ = false;
  int status_ = 0;
  std::filesystem::path folder_;
};

// A fresh temporary folder in which atomesh is run; removed at the end.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  // Runs `atomesh arguments…` in the folder. Standard input is empty.
  Outcome run(const std::vector<std::string>& arguments) const;
  // The same with standard output going to `device`, such as /dev/full.
  Outcome run_printing_to(const std::string& device, const std::vector<std::string>& arguments) const;
  // The same, interrupted (SIGINT) after `delay_ms`.
  Outcome run_interrupted(const std::vector<std::string>& arguments, int delay_ms) const;

  // Starts it and returns; one at a time.
  RunningProgram start(const std::vector<std::string>& arguments) const;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  // Names of everything in the folder, sorted.
  std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace atomesh::testing
