// The graphics card's view: a scene in a widget, and what lies over it.
#pragma once

#include <QImage>
#include <QOpenGLWidget>
#include <QTimer>
#include <memory>

#include "app/gui/gpu_scene.h"
#include "app/gui/moving_detail.h"
#include "app/gui/overlay_drawing.h"
#include "app/gui/render_worker.h"

class QOpenGLFramebufferObject;

namespace atomesh::gui {

// What OpenGL there is, asked once: a context without a window is made for it. `version` is empty where there is none.
const GpuInfo& gpu_of_this_machine();

// Draws modes surface, atoms (GpuScene) and volume (gl::VolumePicture). A volume that takes long is drawn with less
// detail while the view or the colours change; when they rest, whole, in slices of time between which the window
// answers. Leaves the mouse to the widget under it.
class CardView : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit CardView(QWidget* parent = nullptr);
  ~CardView() override;

  // What is drawn from the next paint on; the scene's upload is part of that paint when it is another. Gives up the
  // volume that is being refined, unless nothing but the overlay is another.
  void set(const std::shared_ptr<const WorkerPicture>& scene, const Parameters& parameters, const Camera& camera,
           const QImage& overlay);
  const QImage& overlay() const { return overlay_; }
  // Of the picture that is shown, or of the next where that is to be drawn.
  const Detail& detail() const { return detail_; }
  // What is shown, as grabFramebuffer() gives it; null where the context is lost.
  QImage picture();

 signals:
  // What is shown took so long until the card was done (of slices, their sum); whether nothing is left out.
  void painted(double ms, bool whole);
  // Of a volume that is shown with less detail so large a part of the whole one is drawn.
  void refining(double fraction);
  // Nothing more comes of it: it is to be deleted, and with it goes what lies on the card.
  void failed(const QString& message);

 protected:
  void initializeGL() override;
  void paintGL() override;
  bool event(QEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  using Target = std::unique_ptr<QOpenGLFramebufferObject>;

  bool take_context();
  void release();
  void give_back();
  void abandon();
  void drop_volume();
  void bind(Target& target) const;
  void show_volume();
  void draw_volume();
  void draw_coarse_volume();
  void refine();
  void stop_refining();
  void fail(const QString& message);
  template <class Draw>
  bool draw_or_fail(Draw&& draw);

  std::unique_ptr<GpuScene> gpu_ = std::make_unique<GpuScene>();
  std::unique_ptr<gl::VolumePicture> volume_;
  std::unique_ptr<gl::VolumePicture> coarse_;  // of fewer cells, once it was needed for this scene
  Target shown_;                               // the volume
  Target next_;                                // what will be shown, once it is refined
  bool stale_ = true;                          // `shown_` is of something else
  double shown_ms_ = 0.0;
  std::shared_ptr<const WorkerPicture> scene_;
  Parameters parameters_;
  Camera camera_;
  QImage overlay_;
  OverlayDrawing overlay_drawing_;
  MovingDetail moving_;
  Detail detail_;
  QTimer rest_{this};        // runs while a view that moves is shown with less detail
  QTimer next_slice_{this};  // runs while it is refined
  bool refining_ = false;    // `volume_` has begun what goes into `next_`
  double refined_ms_ = 0.0;
  bool failed_ = false;
};

}  // namespace atomesh::gui
