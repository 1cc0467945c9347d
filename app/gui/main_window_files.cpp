// What the window opens.
#include <QFileInfo>
#include <QMenu>

#include "app/gui/loader_page.h"
#include "app/gui/main_window.h"
#include "app/gui/opening.h"

namespace atomesh::gui {

void MainWindow::open(const QString& path, const QString& crf) {
  opening_->open(path, crf);
}

void MainWindow::load_parameters(const QString& path) {
  opening_->load_parameters(path);
}

void MainWindow::start(const QString& path, const QString& crf) {
  if (path.isEmpty()) show_loader();
  opening_->take(path, crf);
}

QString MainWindow::folder() const {
  const auto& document = workspace_.document();
  return document ? QFileInfo(QString::fromStdString(document->path)).absolutePath() : QString();
}

void MainWindow::show_loader() {
  opening_->show_loader();
}

void MainWindow::fill_recent_menu() {
  recent_menu_->clear();
  RecentFiles& recent = opening_->loader().recent_files();
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
