// A cut plane by Miller indices of the crystal's own cell; the picture follows while it is open.
#pragma once

#include <QDialog>
#include <array>

#include "core/parameters.h"

class QButtonGroup;
class QComboBox;
class QLabel;

namespace atomesh::gui {

class NumberBox;
class Workspace;

class MillerDialog : public QDialog {
  Q_OBJECT

 public:
  // Of cut plane n, from 1. Cancel brings back what was. The document must have a unit cell.
  MillerDialog(Workspace& workspace, int n, QWidget* parent);

  void reject() override;

 private:
  void start_from(const CutPlane& plane);
  void apply();

  Workspace& workspace_;
  int n_;
  CutPlane before_;
  std::array<NumberBox*, 3> hkl_{};
  NumberBox* offset_;
  QComboBox* unit_;
  QComboBox* from_;
  QComboBox* side_;
  QLabel* says_;
};

}  // namespace atomesh::gui
