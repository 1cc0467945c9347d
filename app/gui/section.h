// A heading that folds what is under it, with a help button and what else belongs into the line.
#pragma once

#include <QWidget>

class QHBoxLayout;
class QToolButton;
class QVBoxLayout;

namespace atomesh::gui {

class Section : public QWidget {
  Q_OBJECT

 public:
  // help: the page of help_pages() that its ? button asks for; none where it is empty.
  Section(const QString& title, const QString& help, QWidget* parent);

  void add(QWidget* widget);
  // Into the line of the heading, right of the title.
  void add_to_heading(QWidget* widget);
  bool folded() const { return folded_; }
  void set_folded(bool folded);
  void set_title(const QString& title);

 signals:
  void help_requested(const QString& page);
  void folded_changed(bool folded);

 private:
  QToolButton* title_;
  QHBoxLayout* heading_;
  QWidget* content_;
  QVBoxLayout* lines_;
  bool folded_ = false;
};

}  // namespace atomesh::gui
