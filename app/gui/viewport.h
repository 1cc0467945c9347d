// The view of the sample: the picture of whoever draws the mode, and what lies over it.
#pragma once

#include <QImage>
#include <QWidget>
#include <array>
#include <memory>
#include <optional>

#include "app/gui/render_worker.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

class CardView;
class ViewInput;

// A plain widget, so that where OpenGL runs in software nothing waits for it: pictures of the processor are painted as
// they are. The graphics card's view (CardView) lies over it while the card draws, and is made when it first does.
class Viewport : public QWidget {
  Q_OBJECT

 public:
  explicit Viewport(Workspace& workspace, QWidget* parent = nullptr);
  ~Viewport() override;

  // The last picture of the CPU renderers, nothing over it; null where the graphics card draws.
  const std::shared_ptr<const WorkerPicture>& worker_picture() const { return picture_; }
  // Whether what is shown is complete and of the parameters as they are.
  bool settled() const;
  // Whether the graphics card draws the shown mode.
  bool drawn_by_gpu() const { return !why_not_by_gpu(); }
  // What is on the screen, in device pixels: the picture with what lies over it. Null before the first.
  QImage screenshot();
  ViewInput& input() { return *input_; }

 signals:
  // A frame is on its way to the screen: of the CPU renderers, with all that is known of it; or (null) of the card,
  // which took so long. Whether it is complete.
  void frame_shown(std::shared_ptr<const atomesh::gui::WorkerPicture> picture, double gpu_ms, bool whole);
  // So large a part of the whole frame is drawn by the card, which shows one with less detail.
  void refining(double fraction);
  void became_settled();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  void order();
  void take(std::shared_ptr<const WorkerPicture> picture);
  void forget_pictures();
  void follow_size();
  void show_on_card();
  // Nothing where the card draws the shown mode.
  std::optional<QString> why_not_by_gpu() const;
  void say_who_draws();
  void give_up_card(const QString& message);
  bool scene_is_shown() const;
  void refresh_overlay();
  QImage overlay(const WorkerPicture& of, const Parameters& parameters, const Camera& camera) const;

  Workspace& workspace_;
  RenderWorker worker_;
  std::uint64_t number_ = 0;                      // of the last order
  std::shared_ptr<const WorkerPicture> picture_;  // the last of the CPU renderers
  std::shared_ptr<const WorkerPicture> scene_;    // the last scene for the card
  std::unique_ptr<ViewInput> input_;
  CardView* card_ = nullptr;           // once it was needed
  bool card_painted_ = false;          // with everything as it is now
  std::array<bool, 5> card_failed_{};  // by mode
  QString said_of_volumes_;            // who draws them
  QImage overlay_;                     // of `picture_`
  bool was_settled_ = false;
};

}  // namespace atomesh::gui
