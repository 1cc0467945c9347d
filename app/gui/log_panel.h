// The log: what was said, each line with its time.
#pragma once

#include <QWidget>

#include "app/gui/workspace.h"

class QPlainTextEdit;
class QPushButton;

namespace atomesh::gui {

// Takes down what Workspace says from its making on, whether it is shown or not; the last 10,000 lines.
class LogPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LogPanel(Workspace& workspace, QWidget* parent = nullptr);

  // All lines, "10:31:02.512  message".
  QString text() const;
  // Without asking where to; complains where it cannot be written.
  void write(const QString& path);

 public slots:
  void ask_where_to_write();
  void copy();  // the selection, or all
  void clear();

 private:
  void add(const QString& message);
  void show_buttons();

  Workspace& workspace_;
  QPlainTextEdit* lines_ = nullptr;
  QPushButton* copy_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* clear_ = nullptr;
};

}  // namespace atomesh::gui
