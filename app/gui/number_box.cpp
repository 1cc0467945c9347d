#include "app/gui/number_box.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <algorithm>

#include "app/gui/wheel_guard.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

NumberBox::NumberBox(QWidget* parent)
    : QAbstractSpinBox(parent), min_(std::numeric_limits<double>::lowest()), max_(std::numeric_limits<double>::max()) {
  guard_wheel(this);
  setKeyboardTracking(false);
  setAccelerated(true);
  connect(this, &QAbstractSpinBox::editingFinished, this, &NumberBox::enter);
}

NumberBox::~NumberBox() {
  blockSignals(true);  // it loses the focus with its last breath, which is no Enter
}

void NumberBox::set_range(double min, double max) {
  min_ = min;
  max_ = max;
}

void NumberBox::show_text(const QString& text) {
  shown_ = text;
  if (lineEdit()->text() == text) return;
  lineEdit()->setText(text);
  lineEdit()->setCursorPosition(0);  // the leading digits of a long number
}

void NumberBox::enter() {
  if (being_edited()) emit entered(text().trimmed());
}

void NumberBox::stepBy(int steps) {
  const double now = read_real(text().toStdString()).value_or(start_);
  const double next = std::clamp(scale_.stepped(now, steps), min_, max_);
  const QString text = QString::fromStdString(real_text(next));
  show_text(text);
  emit stepped(text);
}

QSize NumberBox::minimumSizeHint() const {
  // Six digits and the arrows.
  const QSize base = QAbstractSpinBox::minimumSizeHint();
  return {fontMetrics().horizontalAdvance(QStringLiteral("0.0000")) + base.height() * 5 / 4, base.height()};
}

QSize NumberBox::sizeHint() const {
  return minimumSizeHint() + QSize(fontMetrics().horizontalAdvance(QStringLiteral("00")), 0);
}

void NumberBox::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && being_edited()) {
    lineEdit()->setText(shown_);
    lineEdit()->selectAll();
    emit given_up();
    event->accept();
    return;
  }
  const bool enters = being_edited();
  QAbstractSpinBox::keyPressEvent(event);
  // Enter takes the number, and only then presses a dialog's button.
  if (enters && (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter)) event->accept();
}

void NumberBox::keyReleaseEvent(QKeyEvent* event) {
  QAbstractSpinBox::keyReleaseEvent(event);
  if (!event->isAutoRepeat() && (event->key() == Qt::Key_Up || event->key() == Qt::Key_Down ||
                                 event->key() == Qt::Key_PageUp || event->key() == Qt::Key_PageDown)) {
    emit steps_ended();
  }
}

void NumberBox::mouseReleaseEvent(QMouseEvent* event) {
  QAbstractSpinBox::mouseReleaseEvent(event);
  emit steps_ended();
}

void NumberBox::focusOutEvent(QFocusEvent* event) {
  QAbstractSpinBox::focusOutEvent(event);
  emit steps_ended();
}

}  // namespace atomesh::gui
