// File > Turntable movie: the sample turning once around.
#pragma once

#include "app/gui/output_dialog.h"
#include "app/gui/turntable.h"

class QComboBox;
class QLabel;
class QSpinBox;

namespace atomesh::gui {

class PictureForm;

class MovieDialog : public OutputDialog {
  Q_OBJECT

 public:
  MovieDialog(Workspace& workspace, QWidget* parent);

  TurntableSettings settings() const;
  PictureForm& form() { return *form_; }

 protected:
  void showEvent(QShowEvent* event) override;
  QString filter() const override;
  QString plan() override;
  QStringList in_the_way() const override;
  Job::Work work() const override;

 private:
  void build_turn();
  void take_format();
  void follow_path();

  PictureForm* form_;
  QComboBox* format_ = nullptr;
  QComboBox* axis_ = nullptr;
  QComboBox* direction_ = nullptr;
  QSpinBox* frames_ = nullptr;
  QSpinBox* rate_ = nullptr;
  QComboBox* quality_ = nullptr;
  QLabel* lasts_ = nullptr;
};

}  // namespace atomesh::gui
