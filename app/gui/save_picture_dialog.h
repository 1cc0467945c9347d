// File > Save picture: the view at any size.
#pragma once

#include "app/gui/output_dialog.h"

namespace atomesh::gui {

class PictureForm;

class SavePictureDialog : public OutputDialog {
  Q_OBJECT

 public:
  SavePictureDialog(Workspace& workspace, QWidget* parent);

  PictureForm& form() { return *form_; }

 protected:
  void showEvent(QShowEvent* event) override;
  QString filter() const override;
  QString plan() override;
  Job::Work work() const override;

 private:
  PictureForm* form_;
};

}  // namespace atomesh::gui
