#include "app/cli/run_vtk_reader.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <new>
#include <regex>

#include "core/error.h"

namespace atomesh::cli {

namespace {

// Keeps what VTK would print.
class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New();
  // clang-format off
  vtkTypeMacro(SilentWindow, vtkOutputWindow)
      // clang-format on
      void DisplayText(const char* text) override {
    take(text, false);
  }
  void DisplayErrorText(const char* text) override { take(text, true); }
  void DisplayWarningText(const char* text) override { take(text, false); }
  void DisplayGenericWarningText(const char* text) override { take(text, true); }
  void DisplayDebugText(const char*) override {}

  std::string first_error;
  std::string first_warning;

 private:
  // "ERROR: In FILE, line N\nvtkSomething (0x…): what it is about\n\n" → "what it is about"
  void take(const char* text, bool error) {
    std::string& kept = error ? first_error : first_warning;
    if (!kept.empty() || text == nullptr) return;
    static const std::regex place(R"(^(ERROR|Warning|Generic Warning): In [^\n]*\n)");
    static const std::regex object(R"(^[A-Za-z0-9_]+ \((0x)?[0-9a-fA-F]+\): )");
    kept = std::regex_replace(std::regex_replace(std::string(text), place, ""), object, "");
    std::replace(kept.begin(), kept.end(), '\n', ' ');
    kept.erase(kept.find_last_not_of(' ') + 1);
    // Where VTK only says which of its objects failed.
    if (kept.empty() || kept.find("(0x") != std::string::npos) kept = "what is announced is not in it";
  }
};
vtkStandardNewMacro(SilentWindow);

// VTK has one window and one log for the whole program: ours, and none, while this lives.
class Silence {
 public:
  Silence() : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Silence() {
    vtkOutputWindow::SetInstance(before_);
    vtkLogger::SetStderrVerbosity(verbosity_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  const SilentWindow& window() const { return *window_; }

 private:
  vtkNew<SilentWindow> window_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

}  // namespace

void run_vtk_reader(vtkAlgorithm& reader, const std::string& path, Progress& progress,
                    std::vector<std::string>& notes) {
  const Silence silence;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&progress);
  watch->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    if (static_cast<const Progress*>(data)->cancelled()) static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
  });
  reader.AddObserver(vtkCommand::ProgressEvent, watch);
  try {
    reader.Update();
  } catch (const std::bad_alloc&) {
    throw InputError(path, 0, "asks for more memory than there is; it is damaged, or too large for this machine");
  }
  progress.check();
  const std::string& error = silence.window().first_error;
  if (!error.empty()) throw InputError(path, 0, "damaged or incomplete: " + error);
  const std::string& warning = silence.window().first_warning;
  if (!warning.empty()) notes.push_back("reading " + path + ": " + warning);
}

}  // namespace atomesh::cli
