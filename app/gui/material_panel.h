// The panel that says what is open: material_facts() as a tree.
#pragma once

#include <QWidget>

#include "app/gui/workspace.h"

class QTreeWidget;

namespace atomesh::gui {

class MaterialPanel : public QWidget {
  Q_OBJECT

 public:
  explicit MaterialPanel(Workspace& workspace, QWidget* parent = nullptr);

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  void refresh();
  void copy();

  Workspace& workspace_;
  QTreeWidget* tree_ = nullptr;
};

}  // namespace atomesh::gui
