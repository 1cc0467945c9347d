// Edit > Copy picture: the view into the clipboard, drawn as a saved picture of its size is.
#pragma once

#include <QImage>
#include <QObject>
#include <memory>

#include "app/gui/job.h"
#include "app/gui/save_picture.h"

namespace atomesh::gui {

// With opacity, 8 bits a channel, rounded as in a PNG.
QImage to_clipboard_image(const Image& image);

class PictureCopier : public QObject {
  Q_OBJECT

 public:
  PictureCopier(Workspace& workspace, QObject* parent);
  ~PictureCopier() override;

  // Draws the view beside the window, with what the view options and the marks show, then puts it into the clipboard.
  // A copy under way is dropped. Says so in the log; complains where it cannot be. Nothing without a document.
  void copy();

 signals:
  void started(atomesh::gui::Job* job);  // for the progress bar
  void copied();

 private:
  Workspace& workspace_;
  std::unique_ptr<Job> job_;
};

}  // namespace atomesh::gui
