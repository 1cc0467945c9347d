// The graphics card's view: a GpuScene in a widget, and what lies over it.
#pragma once

#include <QImage>
#include <QOpenGLWidget>
#include <memory>

#include "app/gui/gpu_scene.h"
#include "app/gui/render_worker.h"

namespace atomesh::gui {

// What OpenGL there is, asked once: a context without a window is made for it. `version` is empty where there is none.
const GpuInfo& gpu_of_this_machine();

// Leaves the mouse to the widget under it.
class CardView : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit CardView(QWidget* parent = nullptr);
  ~CardView() override;

  // What is drawn from the next paint on; the scene's upload is part of that paint when it is another.
  void set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters, const Camera& camera,
           const QImage& overlay);
  const QImage& overlay() const { return overlay_; }

 signals:
  void painted(double ms);  // until the card was done
  void failed(const QString& message);

 protected:
  void initializeGL() override;
  void paintGL() override;

 private:
  void release();

  GpuScene gpu_;
  std::shared_ptr<const WorkerPicture> scene_;
  Parameters parameters_;
  Camera camera_;
  QImage overlay_;
};

}  // namespace atomesh::gui
