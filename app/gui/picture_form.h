// How large a saved picture is and what is in it: the part that pictures and movies share.
#pragma once

#include <QWidget>

#include "app/gui/save_picture.h"

class QCheckBox;
class QComboBox;
class QSpinBox;

namespace atomesh::gui {

// Sizes are chosen by name (the view's, 2 × and 4 × of it, HD, Full HD, 4K) or typed, with the sides in their ratio
// where that is locked. What is in the picture starts as the view shows it.
class PictureForm : public QWidget {
  Q_OBJECT

 public:
  PictureForm(Workspace& workspace, QWidget* parent);

  // With the marks and picks of the workspace where these are asked for.
  PictureSettings settings() const;
  void set_size(int width, int height);
  // Says why where it cannot be.
  void allow_transparent(bool allowed, const QString& why_not);
  // The size and the parts of the view as it is now; what was typed stays.
  void follow_view();

 signals:
  void changed();

 private:
  void build_size();
  void build_parts();
  void take_preset();
  void keep_ratio(bool width_changed);
  QCheckBox* add_part(const char* name, const QString& text, const QString& tip);

  Workspace& workspace_;
  QComboBox* preset_ = nullptr;
  QSpinBox* width_ = nullptr;
  QSpinBox* height_ = nullptr;
  QCheckBox* lock_ = nullptr;
  QSpinBox* supersampling_ = nullptr;
  QCheckBox* transparent_ = nullptr;
  QCheckBox* legend_ = nullptr;
  QCheckBox* scale_bar_ = nullptr;
  QCheckBox* tripod_ = nullptr;
  QCheckBox* marks_ = nullptr;
  double ratio_ = 1.0;
};

}  // namespace atomesh::gui
