#include "app/gui/preprocessing.h"

#include <fmt/format.h>
#include <unistd.h>

#include <QCoreApplication>
#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "app/cli/text_table.h"
#include "app/gui/job.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

namespace fs = std::filesystem;

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

// Shares of the time, about: a million atoms of fcc and of rock salt (README, "A file of atoms to a .crb").
double weight(const std::string& stage) {
  struct Share {
    const char* stage;
    double weight;
  };
  constexpr std::array shares{
      Share{"read_atoms", 8.0},        Share{"find_unit_cell", 11.0}, Share{"reduce_atoms", 5.0},
      Share{"tetrahedralize", 28.0},   Share{"carve", 11.0},          Share{"extract_surface", 11.0},
      Share{"quantify_defects", 25.0}, Share{"assign_scalar", 1.0},   Share{"simplify", 900.0},
      Share{"measure", 6.0},           Share{"write_material", 6.0}};
  for (const Share& share : shares) {
    if (stage == share.stage) return share.weight;
  }
  return 1.0;
}

// What a run tells of itself while it works; notes once each.
class Teller {
 public:
  Teller(std::shared_ptr<Courier> courier, Preprocessing* to) : courier_(std::move(courier)), to_(to) {}

  void stage(const StageRow& row, void (Preprocessing::*take)(const StageRow&)) {
    courier_->post([to = to_, row, take] { (to->*take)(row); });
  }
  void notes(const PipelineReport& report) {
    for (const auto* list : {&report.read.notes, &report.find_cell.notes, &report.defects.notes, &report.notes}) {
      for (const std::string& note : *list) this->note(note);
    }
  }
  void note(const std::string& note) {
    if (std::find(said_.begin(), said_.end(), note) != said_.end()) return;
    said_.push_back(note);
    courier_->post([to = to_, note] { emit to->noted(text(note)); });
  }
  const std::vector<std::string>& said() const { return said_; }

 private:
  std::shared_ptr<Courier> courier_;
  Preprocessing* to_;  // only in what the courier brings
  std::vector<std::string> said_;
};

}  // namespace

struct Preprocessing::Result {
  cli::PreprocessedFile file;
  std::vector<StageRow> rows;
  std::vector<std::string> written;
  std::vector<std::string> notes;
  std::string write_error;
};

std::string default_output(const std::string& input) {
  return fs::path(input).replace_extension().string();
}

std::vector<std::string> output_paths(const PreprocessingRequest& request) {
  const std::string stem = request.output.empty() ? default_output(request.input) : request.output;
  std::vector<std::string> paths;
  if (request.format == OutputFormat::binary || request.format == OutputFormat::both) paths.push_back(stem + ".crb");
  if (request.format == OutputFormat::text || request.format == OutputFormat::both) paths.push_back(stem + ".crt");
  return paths;
}

std::vector<std::string> existing_outputs(const PreprocessingRequest& request) {
  std::vector<std::string> paths = output_paths(request);
  std::error_code ignored;
  std::erase_if(paths, [&](const std::string& path) { return !fs::exists(path, ignored); });
  return paths;
}

QString problem_with(const PreprocessingRequest& request) {
  std::error_code error;
  const auto translated = [](const char* sentence) { return QCoreApplication::translate("Preprocessing", sentence); };
  if (!fs::is_regular_file(request.input, error)) {
    return translated("%1 is not there, or is no file; choose another").arg(text(request.input));
  }
  if (::access(request.input.c_str(), R_OK) != 0) {
    return translated("%1 may not be read by you; ask its owner, or choose another").arg(text(request.input));
  }
  for (const std::string& path : output_paths(request)) {
    const fs::path folder = fs::absolute(path).parent_path();
    if (!fs::is_directory(folder, error)) {
      return translated("the folder %1 is not there; make it, or choose another for the result")
          .arg(text(folder.string()));
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
      return translated("in the folder %1 you may not write; choose another for the result, or save nothing")
          .arg(text(folder.string()));
    }
    if (fs::is_directory(path, error)) {
      return translated("%1 is a folder; choose another name for the result").arg(text(path));
    }
  }
  return {};
}

QString stage_title(const std::string& name) {
  QString title = text(name).replace('_', ' ');
  if (!title.isEmpty()) title[0] = title[0].toUpper();
  return title;
}

std::vector<std::string> planned_stages(const PreprocessingRequest& request) {
  const PipelineOptions& options = request.settings.options;
  const bool reduced = !options.reduce.mask.empty() || options.reduce.keep_every > 1;
  std::vector<std::string> stages{"read_atoms", "find_unit_cell"};
  if (reduced) stages.emplace_back("reduce_atoms");
  stages.emplace_back("tetrahedralize");
  if (options.carve) stages.emplace_back("carve");
  stages.emplace_back("extract_surface");
  if (!options.scalar.empty()) {
    stages.emplace_back("assign_scalar");
  } else if (!reduced && options.unit_cell != "none") {
    stages.emplace_back("quantify_defects");
  }
  if (options.simplify) stages.emplace_back("simplify");
  stages.emplace_back("measure");
  stages.insert(stages.end(), output_paths(request).size(), "write_material");
  return stages;
}

Preprocessing::Preprocessing(QObject* parent) : QObject(parent) {}

Preprocessing::~Preprocessing() {
  if (courier_) courier_->close();
  job_.reset();
}

void Preprocessing::start(const PreprocessingRequest& request) {
  if (courier_) courier_->close();
  job_.reset();
  request_ = request;
  stages_.clear();
  planned_ = planned_stages(request);
  running_stage_.clear();
  fraction_ = 0.0;
  written_.clear();
  document_.reset();
  problem_.clear();
  courier_ = std::make_shared<Courier>(this);

  const auto result = std::make_shared<Result>();
  const auto teller = std::make_shared<Teller>(courier_, this);
  const Job::Work work = [result, teller, request](Progress& progress) {
    const auto tell = [&](const StageRow& row) {
      result->rows.push_back(row);
      teller->stage(row, &Preprocessing::take_stage);
    };
    cli::PreprocessSettings settings = request.settings;
    settings.options.after_stage = [&](const StageTime& finished, const Material& material,
                                       const PipelineReport& report) {
      tell({finished.name, finished.ms, report.stage_memory.back(),
            cli::stage_outcome(finished.name, material, report)});
      teller->notes(report);
    };
    result->file = cli::preprocess_input(request.input, settings, progress);
    teller->notes(result->file.report);
    std::vector<std::string> fresh;  // files that were not there before
    std::error_code ignored;
    try {
      for (const std::string& path : output_paths(request)) {
        const bool there = fs::exists(path, ignored);
        if (there && !request.replace) {
          teller->note(path + " was there already and stays as it is; preprocess from the loader to replace it");
          continue;
        }
        try {
          cli::write_output(result->file, path, settings.compress, progress);
        } catch (const CancelledError&) {
          // Who cancels wants none of it; what was there before is replaced already.
          for (const std::string& earlier : fresh) fs::remove(earlier, ignored);
          throw;
        }
        if (!there) fresh.push_back(path);
        result->written.push_back(path);
        tell({"write_material", result->file.stages.back().ms, result->file.stage_memory.back(),
              fmt::format("{}, {}", path, cli::byte_size(result->file.output_bytes))});
      }
    } catch (const CancelledError&) {
      throw;
    } catch (const Error& error) {
      result->write_error = error.what();  // the material is there all the same
    }
    result->notes = teller->said();
  };
  job_ = std::make_unique<Job>(tr("Preprocessing %1").arg(text(request.input)), work, nullptr, Job::Unheeded::leave);
  connect(job_.get(), &Job::progressed, this, &Preprocessing::take_progress);
  connect(job_.get(), &Job::done, this, [this, result] { finish(*result); });
  connect(job_.get(), &Job::cancelled, this, [this] {
    end(State::cancelled);
    emit cancelled();
  });
  connect(job_.get(), &Job::failed, this, [this](const QString& message) {
    problem_ = message;
    end(State::failed);
    emit failed(message);
  });
  state_ = State::running;
  emit began();
  job_->start();
}

void Preprocessing::cancel() {
  if (job_ && state_ == State::running) job_->cancel();
}

void Preprocessing::take_progress(const QString& stage, double fraction) {
  if (state_ != State::running) return;
  std::string name = stage.toStdString();
  if (name == "write") name = "write_material";  // the writer's own word
  if (name != running_stage_) {
    running_stage_ = name;
    emit stage_began(stage);
  }
  double before = 0.0;
  double all = 0.0;
  std::size_t finished = 0;
  for (const std::string& planned : planned_) {
    all += weight(planned);
    if (finished < stages_.size() && stages_[finished].name == planned) {
      before += weight(planned);
      ++finished;
    }
  }
  const double now = std::min(1.0, (before + weight(name) * fraction) / std::max(all, 1.0));
  if (now <= fraction_) return;
  fraction_ = now;
  emit progressed(fraction_);
}

void Preprocessing::take_stage(const StageRow& row) {
  stages_.push_back(row);
  running_stage_.clear();
  // What was planned before it and has not come is not going to.
  const auto here =
      std::find(planned_.begin() + static_cast<std::ptrdiff_t>(std::min(stages_.size() - 1, planned_.size())),
                planned_.end(), row.name);
  if (here != planned_.end()) {
    planned_.erase(planned_.begin() + static_cast<std::ptrdiff_t>(stages_.size() - 1), here);
  }
  emit stage_ended(row);
}

void Preprocessing::finish(Result& result) {
  stages_ = std::move(result.rows);
  // Now it is known whether the surface is closed.
  for (StageRow& row : stages_) {
    if (row.name == "extract_surface") {
      row.outcome = cli::stage_outcome(row.name, result.file.material, result.file.report);
    }
  }
  written_ = std::move(result.written);
  Document document;
  document.path = fs::absolute(request_.input).lexically_normal().string();
  document.kind = FileKind::atoms;
  document.times = result.file.stages;
  document.notes = result.notes;
  document.pipeline = std::move(result.file.report);
  document.material = std::make_shared<const Material>(std::move(result.file.material));
  document_ = std::move(document);
  if (!result.write_error.empty()) {
    problem_ = tr("The result could not be saved, but can be looked at: %1").arg(text(result.write_error));
  }
  fraction_ = 1.0;
  emit progressed(1.0);
  end(State::done);
  emit done();
}

void Preprocessing::end(State state) {
  state_ = state;
  running_stage_.clear();
  courier_->close();
  if (job_) job_.release()->deleteLater();
}

}  // namespace atomesh::gui
