// Where the time goes: the stages of what was last done, and the frames of the view.
#pragma once

#include <QElapsedTimer>
#include <QWidget>
#include <memory>

#include "app/gui/time_table.h"
#include "app/gui/workspace.h"

class QLabel;
class QPushButton;
class QTreeWidget;

namespace atomesh::gui {

struct WorkerPicture;

class TimingPanel : public QWidget {
  Q_OBJECT

 public:
  explicit TimingPanel(Workspace& workspace, QWidget* parent = nullptr);

  void set_frame(const FrameTimes& times);

 public slots:
  // For Viewport::frame_shown.
  void note_picture(std::shared_ptr<const atomesh::gui::WorkerPicture> picture, double gpu_ms, bool whole = true);
  void copy();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void build();
  void set_stages(const std::vector<StageTime>& stages);
  void show_stages();
  void show_frame();

  Workspace& workspace_;
  std::vector<StageTime> stages_;
  std::vector<std::uint64_t> memory_;  // of the stages, where known
  FrameTimes frame_;
  bool any_frame_ = false;
  FrameClock clock_;
  QElapsedTimer watch_;
  std::uint64_t card_pictures_ = 0;
  bool card_refines_ = false;  // the last of them was not whole
  QLabel* stages_title_ = nullptr;
  QTreeWidget* stages_tree_ = nullptr;
  QTreeWidget* frame_tree_ = nullptr;
  QPushButton* copy_ = nullptr;
};

}  // namespace atomesh::gui
