// The graphics card's view: a scene in a widget, and what lies over it.
#pragma once

#include <QImage>
#include <QOpenGLWidget>
#include <QTimer>
#include <memory>

#include "app/gui/gpu_scene.h"
#include "app/gui/moving_detail.h"
#include "app/gui/render_worker.h"

namespace atomesh::gui {

// What OpenGL there is, asked once: a context without a window is made for it. `version` is empty where there is none.
const GpuInfo& gpu_of_this_machine();

// Draws modes surface, atoms (GpuScene) and volume (gl::VolumePicture). A volume that takes long is drawn with less
// detail while the view or the colours change, and whole when they rest. Leaves the mouse to the widget under it.
class CardView : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit CardView(QWidget* parent = nullptr);
  ~CardView() override;

  // What is drawn from the next paint on; the scene's upload is part of that paint when it is another.
  void set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters, const Camera& camera,
           const QImage& overlay);
  const QImage& overlay() const { return overlay_; }
  // Of the next picture, and while painted() is emitted of this one.
  const Detail& detail() const { return detail_; }

 signals:
  void painted(double ms, bool whole);  // until the card was done; whether nothing is left out
  // Nothing more comes of it: it is to be deleted.
  void failed(const QString& message);

 protected:
  void initializeGL() override;
  void paintGL() override;
  void paintEvent(QPaintEvent* event) override;

 private:
  void release();
  void draw_volume();
  void draw_coarse_volume();
  void fail(const QString& message);

  GpuScene gpu_;
  std::unique_ptr<gl::VolumePicture> volume_;
  std::unique_ptr<gl::VolumePicture> coarse_;  // of fewer cells, once it was needed for this scene
  std::shared_ptr<const WorkerPicture> scene_;
  Parameters parameters_;
  Camera camera_;
  QImage overlay_;
  MovingDetail moving_;
  Detail detail_;      // of the next picture
  QTimer rest_{this};  // runs while what is shown is not the whole
  bool failed_ = false;
};

}  // namespace atomesh::gui
