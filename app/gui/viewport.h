// The view of the sample: the picture of whoever draws the mode, and what lies over it.
#pragma once

#include <QImage>
#include <QOpenGLWidget>
#include <memory>

#include "app/gui/render_worker.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

class Viewport : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit Viewport(Workspace& workspace, QWidget* parent = nullptr);
  ~Viewport() override;

  // What is shown now: device pixels, with what lies over it. Null before the first picture.
  QImage screenshot();
  // The last picture of the CPU renderers, nothing over it; null where the graphics card draws.
  const std::shared_ptr<const WorkerPicture>& worker_picture() const { return picture_; }
  // Whether what is shown is complete and of the parameters as they are.
  bool settled() const;
  // Whether the graphics card draws the shown mode.
  bool drawn_by_gpu() const;

 signals:
  // A frame is on its way to the screen: of the CPU renderers, with all that is known of it; or (null) of the card,
  // which took so long.
  void frame_shown(std::shared_ptr<const atomesh::gui::WorkerPicture> picture, double gpu_ms);
  void became_settled();
  void opengl_missing(const QString& why);

 protected:
  void initializeGL() override;
  void resizeGL(int width, int height) override;
  void paintGL() override;

 private:
  void order();
  void take(std::shared_ptr<const WorkerPicture> picture);
  void forget_pictures();
  QSize device_size() const;

  Workspace& workspace_;
  RenderWorker worker_;
  bool initialized_ = false;
  std::uint64_t number_ = 0;                      // of the last order
  std::shared_ptr<const WorkerPicture> picture_;  // the last of the CPU renderers
  std::shared_ptr<const WorkerPicture> scene_;    // the last scene for the card
  bool was_settled_ = false;
};

}  // namespace atomesh::gui
