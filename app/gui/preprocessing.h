// Atoms → material in the window: what is asked for, the run beside the window, and what it says on its way. Without
// widgets.
#pragma once

#include <QObject>
#include <QString>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/preprocess_file.h"
#include "app/gui/document.h"

namespace atomesh::gui {

class Job;

// Which files the result is written to: .crb, .crt, both, or it is only looked at.
enum class OutputFormat { binary, text, both, none };

struct PreprocessingRequest {
  std::string input;
  OutputFormat format = OutputFormat::binary;
  std::string output;   // path without the ending; "" is beside the input, by its name
  bool replace = true;  // what is already there; else it stays, and a note says so
  cli::PreprocessSettings settings;
};

// "/data/nacl.dat" → "/data/nacl".
std::string default_output(const std::string& input);
// In the order they are written.
std::vector<std::string> output_paths(const PreprocessingRequest& request);
// Those that are there already.
std::vector<std::string> existing_outputs(const PreprocessingRequest& request);
// Why the request cannot be carried out, with what to do, or "": input and folder, before any work.
QString problem_with(const PreprocessingRequest& request);

struct StageRow {
  std::string name;  // as in PipelineReport; "write_material" once for each file
  double ms = 0.0;
  std::uint64_t memory = 0;  // the most the process held, bytes
  std::string outcome;       // "25,725 atoms, dat; 0 skipped, 0 duplicates"
  bool operator==(const StageRow&) const = default;
};
// "find_unit_cell" → "Find unit cell".
QString stage_title(const std::string& name);
// The stages that such a request goes through, as far as can be told; some are left out when their turn comes.
std::vector<std::string> planned_stages(const PreprocessingRequest& request);

// One run after the other; each ends with one of done, cancelled, failed. Files are written beside and renamed: one
// that could not be finished leaves nothing. Deleting it cancels.
class Preprocessing : public QObject {
  Q_OBJECT

 public:
  enum class State { idle, running, done, cancelled, failed };

  explicit Preprocessing(QObject* parent = nullptr);
  ~Preprocessing() override;

  // Cancels, without signals, what still runs.
  void start(const PreprocessingRequest& request);
  void cancel();

  State state() const { return state_; }
  const PreprocessingRequest& request() const { return request_; }
  const std::vector<StageRow>& stages() const { return stages_; }  // that are finished
  const std::string& running_stage() const { return running_stage_; }
  double fraction() const { return fraction_; }                          // of the whole run, about; never goes back
  const std::vector<std::string>& written() const { return written_; }   // files of the last run
  const std::optional<Document>& document() const { return document_; }  // when done: kind atoms, all parts
  const QString& problem() const { return problem_; }                    // when failed, or when done but not saved

 signals:
  void began();
  void stage_began(const QString& name);
  void stage_ended(const atomesh::gui::StageRow& row);
  void progressed(double fraction);
  void noted(const QString& note);  // what a person should know
  void done();
  void cancelled();
  void failed(const QString& problem);

 private:
  struct Result;

  void take_progress(const QString& stage, double fraction);
  void take_stage(const StageRow& row);
  void finish(Result& result);
  void end(State state);

  PreprocessingRequest request_;
  State state_ = State::idle;
  std::vector<StageRow> stages_;
  std::vector<std::string> planned_;
  std::string running_stage_;
  double fraction_ = 0.0;
  std::vector<std::string> written_;
  std::optional<Document> document_;
  QString problem_;
  std::shared_ptr<class Courier> courier_;  // of the run's messages
  std::unique_ptr<Job> job_;
};

}  // namespace atomesh::gui
