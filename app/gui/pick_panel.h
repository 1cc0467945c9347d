// What is picked: all that is known of it, its neighbours, and the way between two.
#pragma once

#include <QWidget>

#include "app/gui/latest_job.h"
#include "app/gui/workspace.h"

class QLabel;
class QPushButton;
class QStackedWidget;
class QTreeWidget;
class QTreeWidgetItem;

namespace atomesh::gui {

class PickPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PickPanel(Workspace& workspace, QWidget* parent = nullptr);

  // As a pick of it in the view; found beside the window. `second`: to measure from what is picked.
  void pick_atom_by_number(Index atom, bool second);

 public slots:
  void copy();

 private:
  void build();
  void show_picks();
  void show_neighbours();
  void center_view();

  Workspace& workspace_;
  QStackedWidget* pages_ = nullptr;
  QTreeWidget* facts_ = nullptr;
  QLabel* distance_ = nullptr;
  QLabel* neighbours_title_ = nullptr;
  QTreeWidget* neighbours_ = nullptr;
  QPushButton* center_ = nullptr;
  QPushButton* copy_ = nullptr;
  QPushButton* clear_ = nullptr;
  LatestJob job_;
};

}  // namespace atomesh::gui
