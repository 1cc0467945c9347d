// What leaves the window: pictures, movies, the clipboard.
#include <QAction>
#include <QMenu>

#include "app/gui/copy_picture.h"
#include "app/gui/main_window.h"
#include "app/gui/movie_dialog.h"
#include "app/gui/save_picture_dialog.h"

namespace atomesh::gui {

namespace {

// Made when first asked for, and then kept with what was chosen in it.
template <class Dialog>
void show_dialog(Dialog*& dialog, Workspace& workspace, QWidget* parent) {
  if (dialog == nullptr) dialog = new Dialog(workspace, parent);
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
}

}  // namespace

void MainWindow::add_output_actions(QMenu& menu) {
  QAction* picture =
      menu.addAction(tr("&Save picture…"), this, [this] { show_dialog(save_picture_, workspace_, this); });
  picture->setObjectName("action_save_picture");
  picture->setShortcut(QKeySequence::Save);
  QAction* movie = menu.addAction(tr("Turntable &movie…"), this, [this] { show_dialog(movie_, workspace_, this); });
  movie->setObjectName("action_movie");
  movie->setShortcut(Qt::CTRL | Qt::Key_M);
  needing_document_.push_back(picture);
  needing_document_.push_back(movie);
}

void MainWindow::add_copy_action(QMenu& menu) {
  copier_ = new PictureCopier(workspace_, this);
  connect(copier_, &PictureCopier::started, this, &MainWindow::follow);
  QAction* copy = menu.addAction(tr("&Copy picture"), copier_, &PictureCopier::copy);
  copy->setObjectName("action_copy_picture");
  copy->setShortcut(QKeySequence::Copy);
  needing_document_.push_back(copy);
}

}  // namespace atomesh::gui
