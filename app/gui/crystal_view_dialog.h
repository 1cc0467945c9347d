// Views along the directions [uvw] and at the planes (hkl) of the crystal's own cell.
#pragma once

#include <QDialog>
#include <array>

#include "app/gui/workspace.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace atomesh::gui {

// Stays open beside the window; turns the view at once. Without a unit cell it says what to do.
class CrystalViewDialog : public QDialog {
  Q_OBJECT

 public:
  explicit CrystalViewDialog(Workspace& workspace, QWidget* parent = nullptr);

 private:
  void follow_document();
  void look();
  void set_indices(int kind, const std::array<int, 3>& indices);

  Workspace& workspace_;
  QComboBox* kind_ = nullptr;  // 0: direction, 1: plane
  std::array<QSpinBox*, 3> indices_{};
  QLabel* says_ = nullptr;
  QPushButton* look_ = nullptr;
  std::vector<QWidget*> needing_cell_;
};

}  // namespace atomesh::gui
