// A spin box over the text of a number, as the parameter table reads it: every digit that counts, "auto" where that is
// allowed, and what is typed wrong stays to be put right.
#pragma once

#include <QAbstractSpinBox>

#include "app/gui/parameter_hints.h"

namespace atomesh::gui {

class NumberBox : public QAbstractSpinBox {
  Q_OBJECT

 public:
  explicit NumberBox(QWidget* parent = nullptr);
  ~NumberBox() override;

  void set_scale(const SliderScale& scale) { scale_ = scale; }
  // Steps stay within; what is typed is not looked at here.
  void set_range(double min, double max);
  // Where steps from a text that is no number ("auto") start.
  void set_start(double start) { start_ = start; }
  void show_text(const QString& text);
  // Whether the text was typed and not yet entered, or was refused.
  bool being_edited() const { return text() != shown_; }

  void stepBy(int steps) override;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 signals:
  void entered(const QString& text);  // typed, then Enter or another widget
  void stepped(const QString& text);  // by arrows or wheel
  void steps_ended();                 // the arrow was let go, the wheel left
  void given_up();                    // Escape: the text is again what was shown

 protected:
  StepEnabled stepEnabled() const override { return StepUpEnabled | StepDownEnabled; }
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  void enter();

  SliderScale scale_;
  double min_;
  double max_;
  double start_ = 0.0;
  QString shown_;
};

}  // namespace atomesh::gui
