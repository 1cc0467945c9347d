#include "app/gui/opening.h"

#include <QFileInfo>
#include <QStackedWidget>
#include <utility>

#include "app/gui/job.h"
#include "app/gui/loader_page.h"
#include "app/gui/pipeline_settings.h"
#include "app/gui/preprocessing_page.h"
#include "core/error.h"
#include "render/scene.h"

namespace atomesh::gui {

namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

std::string absolute(const QString& path) {
  return QFileInfo(path).absoluteFilePath().toStdString();
}

}  // namespace

// What to open, and with what.
struct Opening::Wanted {
  std::string path;                             // "" for parameters alone
  std::string parameters_file;                  // .crf or .png, over the defaults; "" for none
  std::optional<PreprocessingRequest> request;  // of the loader, for atoms
};

// What is there, read beside the window.
struct Opening::Found {
  FileKind kind = FileKind::material;
  Look look;
  std::optional<Document> document;
  std::optional<PictureState> picture;
  bool shown_already = false;  // the picture shows what is open
};

Opening::Opening(Workspace& workspace, QStackedWidget& pages, QWidget& view, const QString& settings_file)
    : QObject(&pages),
      workspace_(workspace),
      pages_(pages),
      view_(view),
      loader_(new LoaderPage(&pages, settings_file)),
      preprocessing_(new PreprocessingPage(&pages, settings_file)) {
  pages_.addWidget(loader_);
  pages_.addWidget(preprocessing_);
  connect(loader_, &LoaderPage::open_requested, this, &Opening::open);
  connect(loader_, &LoaderPage::preprocess_requested, this,
          [this](const PreprocessingRequest& request, const QString& parameters_file) {
            find({.path = request.input,
                  .parameters_file = parameters_file.isEmpty() ? std::string() : absolute(parameters_file),
                  .request = request});
          });
  connect(loader_, &LoaderPage::cancelled, this, [this] {
    job_.reset();
    if (workspace_.document()) {
      pages_.setCurrentWidget(&view_);
      view_.setFocus();
    } else {
      emit exit_wanted();
    }
  });
  connect(preprocessing_, &PreprocessingPage::go_on, this, [this](const Document& document) {
    loader_->recent_files().add(text(document.path));
    for (const std::string& written : preprocessing_->run().written()) loader_->recent_files().add(text(written));
    show(document, look_);
  });
  connect(preprocessing_, &PreprocessingPage::back_to_loader, this, [this](const QString& file) {
    loader_->set_file(file);
    show_loader();
  });
  connect(preprocessing_, &PreprocessingPage::state_changed, this, &Opening::activity_changed);
  connect(preprocessing_, &PreprocessingPage::said, &workspace_, &Workspace::say);
}

Opening::~Opening() = default;

QString Opening::activity() const {
  const Preprocessing& run = preprocessing_->run();
  if (run.state() != Preprocessing::State::running) return {};
  return tr("Preprocessing %1").arg(QFileInfo(text(run.request().input)).fileName());
}

void Opening::open(const QString& path, const QString& parameters_file) {
  find({.path = absolute(path),
        .parameters_file = parameters_file.isEmpty() ? std::string() : absolute(parameters_file),
        .request = std::nullopt});
}

void Opening::load_parameters(const QString& path) {
  find({.path = {}, .parameters_file = absolute(path), .request = std::nullopt});
}

void Opening::take(const QString& data, const QString& parameters_file) {
  if (!data.isEmpty()) {
    open(data, parameters_file);
  } else if (!parameters_file.isEmpty() && workspace_.document()) {
    load_parameters(parameters_file);
  } else if (!parameters_file.isEmpty()) {
    loader_->set_parameters_file(QFileInfo(parameters_file).absoluteFilePath());
    show_loader();
  }
}

void Opening::show_loader() {
  loader_->set_has_view(workspace_.document().has_value());
  pages_.setCurrentWidget(loader_);
}

void Opening::find(const Wanted& wanted) {
  preprocessing_->cancel();
  loader_->show_problem({});
  const auto found = std::make_shared<Found>();
  const QString name = QFileInfo(text(wanted.path.empty() ? wanted.parameters_file : wanted.path)).fileName();
  job_ = std::make_unique<Job>(
      tr("Opening %1").arg(name),
      [found, wanted, shown = workspace_.parameters(), open_now = workspace_.document()](Progress& progress) {
        if (!wanted.parameters_file.empty()) found->look.parameters = cli::read_parameters(wanted.parameters_file);
        if (wanted.path.empty()) return;
        found->kind = file_kind(wanted.path);
        std::string path = wanted.path;
        if (found->kind == FileKind::picture) {
          found->picture = read_picture_state(wanted.path, progress);
          if (!found->look.parameters) found->look.parameters = found->picture->origin.parameters;
          found->look.parts = found->picture->origin.parts;
          found->shown_already = open_now && shows(*found->picture, *open_now, progress);
          const auto& data = found->picture->data;
          if (found->shown_already || !data || data->match == PictureData::Match::atoms) return;
          path = data->path;
          if (file_kind(path) == FileKind::atoms) return;
        } else if (found->kind == FileKind::atoms) {
          return;
        }
        found->document = open_document(path, parts_needed(found->look.parameters.value_or(shown)), progress);
      },
      nullptr, Job::Unheeded::leave);
  connect(job_.get(), &Job::done, this, [this, wanted, found] {
    job_.release()->deleteLater();
    take_found(wanted, *found);
  });
  connect(job_.get(), &Job::failed, this, [this, path = text(wanted.path)](const QString& problem) {
    job_.release()->deleteLater();
    fail(path, problem);
  });
  emit job_started(job_.get());
  job_->start();
}

void Opening::take_found(const Wanted& wanted, Found& found) {
  if (!wanted.parameters_file.empty()) loader_->recent_parameters().add(text(wanted.parameters_file));
  if (wanted.path.empty()) {
    workspace_.change(*found.look.parameters, tr("Load %1").arg(QFileInfo(text(wanted.parameters_file)).fileName()));
    workspace_.say(tr("Parameters of %1").arg(text(wanted.parameters_file)));
  } else if (found.picture) {
    take_picture(wanted, found);
  } else if (found.kind == FileKind::atoms) {
    preprocess(wanted.request ? *wanted.request : loader_->unasked_request(text(wanted.path)), found.look);
  } else {
    loader_->recent_files().add(text(wanted.path));
    show(std::move(*found.document), found.look);
  }
}

void Opening::take_picture(const Wanted& wanted, Found& found) {
  const PictureState& picture = *found.picture;
  if (found.shown_already) {
    workspace_.change_look(*found.look.parameters, *found.look.parts,
                           tr("View of %1").arg(QFileInfo(text(wanted.path)).fileName()));
    pages_.setCurrentWidget(&view_);
    emit opened();
    return;
  }
  if (!picture.data) {
    fail(text(wanted.path), text(missing_data_text(picture, wanted.path)));
    return;
  }
  loader_->recent_files().add(text(wanted.path));
  const bool other = picture.data->match == PictureData::Match::other;
  if (!found.document) {
    PreprocessingRequest request = loader_->unasked_request(text(picture.data->path));
    try {
      request.settings.options = pipeline_options(recorded_values(picture_options(picture)));
    } catch (const UsageError& error) {
      workspace_.say(
          tr("The picture's settings of preprocessing are not known here: %1").arg(QString::fromUtf8(error.what())));
    }
    preprocess(request, found.look);
  } else {
    show(std::move(*found.document), found.look);
  }
  if (other) workspace_.say(text(missing_data_text(picture, wanted.path)));
}

void Opening::preprocess(const PreprocessingRequest& request, const Look& look) {
  const QString problem = problem_with(request);
  if (!problem.isEmpty()) {
    fail(text(request.input), problem);
    return;
  }
  look_ = look;
  preprocessing_->start(request);
  pages_.setCurrentWidget(preprocessing_);
}

void Opening::show(Document document, const Look& look) {
  if (look.parts) workspace_.show_parts(*look.parts);
  workspace_.show_document(std::move(document), look.parameters);
  pages_.setCurrentWidget(&view_);
  view_.setFocus();
  emit opened();
}

void Opening::fail(const QString& path, const QString& problem) {
  if (workspace_.document() && pages_.currentWidget() == &view_) {
    workspace_.complain(problem);
    return;
  }
  workspace_.say(problem);
  if (!path.isEmpty() && loader_->file() != path) loader_->set_file(path);
  show_loader();
  loader_->show_problem(problem);
}

}  // namespace atomesh::gui
