// The CPU renderers at work for the window: one thread that always draws what was asked for last.
#pragma once

#include <QImage>
#include <QObject>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/camera.h"
#include "core/material.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::gui {

struct RenderOrder {
  std::uint64_t number = 0;  // of the order; pictures carry it
  std::shared_ptr<const Material> material;
  Parameters parameters;
  int width = 1;  // device pixels
  int height = 1;
  bool scene_only = false;  // somebody else draws: only the scene is made
};

// A picture of an order: coarse ones first, the last complete.
struct WorkerPicture {
  std::uint64_t number = 0;
  std::shared_ptr<const Material> material;
  std::shared_ptr<const Scene> scene;
  Parameters parameters;
  Camera camera;
  QImage image;  // null where only the scene was asked for
  int level = 1;
  int levels = 1;
  double max_thickness = 0.0;  // Å, mode xray, of the pixels drawn so far
  double scene_ms = 0.0;       // making the scene; 0 where it was there
  double ms = 0.0;             // from the start of preparing to this picture
  RenderStats stats;
  bool complete() const { return level == levels; }
};

// Of format RGB32, or ARGB32 where a pixel is not opaque; channels rounded to the nearest of 256 as write_png() does.
QImage to_qimage(const Image& image);
// A band of what is transparent nearly everywhere, from that row on; the picture is as wide, of format
// ARGB32_Premultiplied.
void put_overlay(QImage& picture, const Image& band, int first_row);

// A new order ends the one that is drawn, once that has given its first picture: while the view turns there is always
// one to see. An order whose picture should be done within an instant (by how long the last took) is drawn whole;
// others coarse first.
//
// Signals come on the thread the worker was made on; pictures of orders that a newer one replaced come too, in order.
class RenderWorker : public QObject {
  Q_OBJECT

 public:
  explicit RenderWorker(QObject* parent = nullptr);
  ~RenderWorker() override;  // cancels and waits

  void draw(RenderOrder order);
  // Gives up what is drawn and what is asked for.
  void stop();

 signals:
  void picture(std::shared_ptr<const atomesh::gui::WorkerPicture> picture);
  void failed(const QString& message);  // of the order that was drawn; it is given up
  void idle();                          // nothing is left to draw

 private:
  void run();
  void work_on(const RenderOrder& order, Progress& progress);
  std::shared_ptr<const Scene> scene_of(const RenderOrder& order, double& ms, Progress& progress);
  int coarse_levels(const RenderOrder& order) const;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<RenderOrder> next_;
  Progress* current_ = nullptr;
  bool shown_ = false;  // the current order has given a picture
  bool quit_ = false;

  // Of the worker's thread alone.
  std::shared_ptr<const Material> scene_material_;
  Parameters scene_parameters_;
  std::shared_ptr<const Scene> scene_;
  double ms_per_pixel_ = -1.0;  // of the last whole picture of this scene; negative: not known
  std::thread thread_;
};

// Whether make_scene() gives the same for both.
bool same_scene(const Parameters& a, const Parameters& b);

}  // namespace atomesh::gui

Q_DECLARE_METATYPE(std::shared_ptr<const atomesh::gui::WorkerPicture>)
