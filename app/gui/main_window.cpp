#include "app/gui/main_window.h"

#include <fmt/format.h>

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QFileInfo>
#include <QLabel>
#include <QMessageBox>
#include <QProgressBar>
#include <QSettings>
#include <QStackedWidget>
#include <QStatusBar>
#include <QToolButton>
#include <utility>

#include "app/gui/card_view.h"
#include "app/gui/copy_picture.h"
#include "app/gui/crystal_view_dialog.h"
#include "app/gui/help_window.h"
#include "app/gui/job.h"
#include "app/gui/movie_dialog.h"
#include "app/gui/opening.h"
#include "app/gui/render_worker.h"
#include "app/gui/save_picture_dialog.h"
#include "app/gui/viewport.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

ViewOptions stored_view_options() {
  const QSettings settings;
  ViewOptions options;
  options.legend = settings.value("view/legend", options.legend).toBool();
  options.scale_bar = settings.value("view/scale_bar", options.scale_bar).toBool();
  options.tripod = settings.value("view/tripod", options.tripod).toBool();
  options.cut_handles = settings.value("view/cut_handles", options.cut_handles).toBool();
  options.upright = settings.value("view/upright", options.upright).toBool();
  const QString drawing = settings.value("view/drawing").toString();
  if (drawing == "gpu") options.drawing = ViewOptions::Drawing::gpu;
  if (drawing == "cpu") options.drawing = ViewOptions::Drawing::cpu;
  return options;
}

void store(const ViewOptions& options) {
  QSettings settings;
  settings.setValue("view/legend", options.legend);
  settings.setValue("view/scale_bar", options.scale_bar);
  settings.setValue("view/tripod", options.tripod);
  settings.setValue("view/cut_handles", options.cut_handles);
  settings.setValue("view/upright", options.upright);
  using Drawing = ViewOptions::Drawing;
  settings.setValue("view/drawing", options.drawing == Drawing::gpu   ? "gpu"
                                    : options.drawing == Drawing::cpu ? "cpu"
                                                                      : "automatic");
}

}  // namespace

MainWindow::MainWindow(QWidget* parent) : QMainWindow(parent) {
  setObjectName("main_window");
  workspace_.set_view_options(stored_view_options());
  resize(1280, 820);
  setAcceptDrops(true);
  build_pages();
  build_docks();
  build_menus();
  build_status_line();
  follow_workspace();
  update_title();
  update_actions();
  QSettings settings;
  restoreGeometry(settings.value("window/geometry").toByteArray());
  restoreState(settings.value("window/state").toByteArray());
}

// What the window shows looks at the workspace, which as a member would go before the window's children.
MainWindow::~MainWindow() {
  delete crystal_view_;
  delete save_picture_;
  delete movie_;
  delete copier_;
  delete help_;
  delete opening_;
  qDeleteAll(docks_);
  delete pages_;
}

void MainWindow::build_status_line() {
  hint_ = new QLabel(this);
  hint_->setObjectName("hint");
  hint_->setContentsMargins(fontMetrics().averageCharWidth(), 0, 0, 0);
  progress_ = new QProgressBar(this);
  progress_->setObjectName("progress");
  progress_->setRange(0, 1000);
  progress_->setMaximumWidth(fontMetrics().averageCharWidth() * 40);
  progress_->hide();
  counts_ = new QLabel(this);
  counts_->setObjectName("counts");
  frame_ = new QLabel(this);
  frame_->setObjectName("frame");
  statusBar()->addWidget(hint_, 1);
  cancel_ = new QToolButton(this);
  cancel_->setObjectName("cancel_job");
  cancel_->setText(tr("Cancel"));
  cancel_->hide();
  statusBar()->addPermanentWidget(progress_);
  statusBar()->addPermanentWidget(cancel_);
  statusBar()->addPermanentWidget(counts_);
  statusBar()->addPermanentWidget(frame_);
}

void MainWindow::follow_workspace() {
  connect(&workspace_, &Workspace::document_changed, this, [this] {
    update_title();
    update_actions();
  });
  connect(&workspace_, &Workspace::parts_changed, this, &MainWindow::update_actions);
  connect(&workspace_, &Workspace::parameters_changed, this, &MainWindow::update_actions);
  connect(&workspace_, &Workspace::job_started, this, &MainWindow::follow);
  connect(&workspace_, &Workspace::complained, this, &MainWindow::complain);
  connect(&workspace_, &Workspace::said, this, [this](const QString& line) { hint_->setText(line); });
  connect(viewport_, &Viewport::frame_shown, this, &MainWindow::update_status);
  connect(viewport_, &Viewport::refining, this, &MainWindow::show_refining);
}

void MainWindow::follow(Job* job) {
  progress_->setFormat(job->title() + " %p %");
  progress_->setValue(0);
  progress_->show();
  cancel_->show();
  connect(cancel_, &QToolButton::clicked, job, &Job::cancel);
  connect(job, &Job::progressed, this,
          [this](const QString&, double fraction) { progress_->setValue(static_cast<int>(1000.0 * fraction)); });
  const auto ended = [this] {
    progress_->hide();
    cancel_->hide();
  };
  connect(job, &Job::done, this, ended);
  connect(job, &Job::cancelled, this, ended);
  connect(job, &Job::failed, this, ended);
  connect(job, &QObject::destroyed, this, ended);
}

void MainWindow::complain(const QString& message) {
  auto* box = new QMessageBox(QMessageBox::Warning, "atomesh", message, QMessageBox::Ok, this);
  box->setObjectName("complaint");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setTextInteractionFlags(Qt::TextSelectableByMouse);
  box->open();
}

void MainWindow::update_title() {
  const auto& document = workspace_.document();
  const QString path = document ? QString::fromStdString(document->path) : QString();
  const QString activity = opening_->activity();
  setWindowFilePath(path);
  const QString what = !activity.isEmpty() ? activity : QFileInfo(path).fileName();
  setWindowTitle(what.isEmpty() ? QStringLiteral("atomesh") : what + " – atomesh");
}

void MainWindow::update_status(const std::shared_ptr<const WorkerPicture>& picture, double gpu_ms, bool whole) {
  const auto& document = workspace_.document();
  if (!document) return;
  const Material& material = *document->material;
  QStringList counts;
  if (material.atoms.size() > 0) counts << tr("%L1 atoms").arg(material.atoms.size());
  if (!material.mesh.tetrahedra.empty()) counts << tr("%L1 tetrahedra").arg(material.mesh.tetrahedra.size());
  if (!material.surface.triangles.empty()) counts << tr("%L1 triangles").arg(material.surface.triangles.size());
  counts_->setText(counts.join(", "));
  const double ms = picture ? picture->ms : gpu_ms;
  QString text = ms < 100.0 ? tr("%1 ms").arg(ms, 0, 'f', 1) : tr("%1 ms").arg(ms, 0, 'f', 0);
  if (!whole) text += tr(", picture %1 of %2").arg(picture ? picture->level : 1).arg(picture ? picture->levels : 2);
  frame_text_ = text;
  frame_->setText(text);
  frame_->setToolTip(
      picture ? tr("Drawn by the processor")
              : tr("Drawn by the graphics card: %1").arg(QString::fromStdString(gpu_of_this_machine().renderer)));
}

// While the card draws the whole of a picture that it shows with less detail.
void MainWindow::show_refining(double fraction) {
  frame_->setText(tr("%1 (%2 %)").arg(frame_text_).arg(static_cast<int>(100.0 * fraction)));
}

void MainWindow::next_mode(int step) {
  constexpr int count = 5;
  const int mode = (static_cast<int>(workspace_.parameters().mode) + step + count) % count;
  change_view(tr("Render mode"), [mode](Parameters& parameters) { parameters.mode = static_cast<Mode>(mode); });
}

void MainWindow::next_shading() {
  change_view(tr("Shading mode"), [](Parameters& parameters) {
    parameters.shading = parameters.shading == Shading::flat ? Shading::smooth : Shading::flat;
  });
}

void MainWindow::toggle_full_screen() {
  setWindowState(windowState() ^ Qt::WindowFullScreen);
}

// Whoever asked for it, a desktop's own keys among them.
void MainWindow::changeEvent(QEvent* event) {
  QMainWindow::changeEvent(event);
  if (event->type() == QEvent::WindowStateChange) full_screen_->setChecked(isFullScreen());
}

void MainWindow::change_view(const QString& name, const std::function<void(Parameters&)>& change) {
  Parameters parameters = workspace_.parameters();
  try {
    change(parameters);
    workspace_.change(parameters, name);
  } catch (const Error& error) {
    complain(QString::fromUtf8(error.what()));
  }
}

void MainWindow::closeEvent(QCloseEvent* event) {
  QSettings settings;
  settings.setValue("window/geometry", saveGeometry());
  settings.setValue("window/state", docks_shown_ ? saveState() : view_state_);
  store(workspace_.view_options());
  QMainWindow::closeEvent(event);
}

}  // namespace atomesh::gui
