// What the window opens: materials, meshes, atoms by way of preprocessing, pictures by way of what they show.
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QStackedWidget>
#include <utility>

#include "app/gui/job.h"
#include "app/gui/loader_page.h"
#include "app/gui/main_window.h"
#include "app/gui/parameter_files.h"
#include "app/gui/picture_state.h"
#include "app/gui/preprocessing_page.h"
#include "core/error.h"
#include "core/parameter_file.h"

namespace atomesh::gui {

// What became of a file that was to be opened.
struct MainWindow::Opened {
  FileKind kind = FileKind::material;
  std::optional<Parameters> parameters;
  std::optional<Document> document;
  std::optional<PictureState> picture;
};

void MainWindow::open(const QString& path, const QString& crf) {
  const auto opened = std::make_shared<Opened>();
  const auto work = [opened, file = path.toStdString(), parameter_file = crf.toStdString(),
                     now = workspace_.parameters(), shown = workspace_.document()](Progress& progress) {
    opened->kind = file_kind(file);
    if (!parameter_file.empty()) opened->parameters = read_crf(parameter_file);
    std::string sample = file;
    if (opened->kind == FileKind::picture) {
      opened->picture = read_picture_state(file, progress);
      if (parameter_file.empty()) opened->parameters = opened->picture->origin.parameters;
      if (shown && gui::shows(*opened->picture, *shown, progress)) return;
      if (!opened->picture->data) throw InputError(file, 0, missing_data_text(*opened->picture, file));
      sample = opened->picture->data->path;
    }
    if (opened->kind == FileKind::atoms || file_kind(sample) == FileKind::atoms) return;
    opened->document = open_document(sample, parts_needed(opened->parameters ? *opened->parameters : now), progress);
  };
  opening_ = std::make_unique<Job>(tr("Opening %1").arg(QFileInfo(path).fileName()), work);
  connect(opening_.get(), &Job::done, this, [this, opened, path, crf] {
    opening_.release()->deleteLater();
    take(*opened, path, crf);
  });
  connect(opening_.get(), &Job::cancelled, this, [this] { opening_.release()->deleteLater(); });
  connect(opening_.get(), &Job::failed, this, [this](const QString& message) {
    opening_.release()->deleteLater();
    complain(message);
  });
  follow(opening_.get());
  opening_->start();
}

void MainWindow::take(const Opened& opened, const QString& path, const QString& crf) {
  loader_->recent_files().add(QFileInfo(path).absoluteFilePath());
  if (opened.document) {
    show_document(*opened.document, opened.parameters);
  } else if (opened.picture && !opened.picture->data) {
    workspace_.change(*opened.parameters, tr("View of %1").arg(QFileInfo(path).fileName()));
    show_view();
  } else if (opened.picture && file_kind(opened.picture->data->path) == FileKind::atoms) {
    picture_parameters_ = opened.parameters;
    preprocess(loader_->unasked_request(QString::fromStdString(opened.picture->data->path)), {});
  } else if (opened.picture) {
    workspace_.change(*opened.parameters, tr("View of %1").arg(QFileInfo(path).fileName()));
    show_view();
  } else {
    picture_parameters_.reset();
    preprocess(loader_->unasked_request(path), crf);
  }
  if (opened.picture && opened.picture->data && opened.picture->data->match == PictureData::Match::other) {
    workspace_.complain(QString::fromStdString(missing_data_text(*opened.picture, path.toStdString())));
  }
}

void MainWindow::show_document(Document document, const std::optional<Parameters>& parameters) {
  workspace_.show_document(std::move(document), parameters);
  show_view();
}

void MainWindow::preprocess(const PreprocessingRequest& request, const QString& crf) {
  loader_->recent_files().add(QFileInfo(QString::fromStdString(request.input)).absoluteFilePath());
  pages_->setCurrentWidget(preprocessing_);
  preprocessing_->start(request, crf);
}

void MainWindow::load_parameters(const QString& path) {
  try {
    load_parameter_file(workspace_, path.toStdString());
    workspace_.say(tr("Parameters of %1").arg(path));
  } catch (const Error& error) {
    complain(QString::fromUtf8(error.what()));
  }
}

void MainWindow::fill_recent_menu() {
  recent_menu_->clear();
  RecentFiles& recent = loader_->recent_files();
  recent.look();
  for (const QString& path : recent.files()) {
    QAction* action = recent_menu_->addAction(QFileInfo(path).fileName());
    action->setToolTip(path);
    action->setStatusTip(path);
    action->setEnabled(!recent.missing(path));
    connect(action, &QAction::triggered, this, [this, path] { open(path); });
  }
  if (recent.files().isEmpty()) recent_menu_->addAction(tr("None yet"))->setEnabled(false);
}

}  // namespace atomesh::gui
