#include "app/gui/color_map_canvas.h"

#include <QApplication>
#include <QClipboard>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QLocale>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "app/gui/color_map_edit.h"
#include "app/gui/color_map_painting.h"
#include "core/axis_ticks.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr double snap_step = 0.05;

QString number(double value) {
  return QString::fromStdString(rounded_text(value, 4));
}

}  // namespace

ColorMapCanvas::ColorMapCanvas(QWidget* parent) : QWidget(parent) {
  setObjectName("color_map_canvas");
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Color map over the scalar histogram"));
  setAccessibleDescription(
      tr("Page Up and Page Down select an entry, the arrow keys move it, Insert adds one, Delete removes it, Enter "
         "changes its color."));
}

void ColorMapCanvas::set_color_map(const ColorMap& map) {
  if (map == map_) return;
  map_ = map;
  if (drag_ && drag_->index >= map_.entries.size()) drag_.reset();
  hovered_.reset();
  if (selected_ && *selected_ >= map_.entries.size()) select(std::nullopt);
  update();
}

void ColorMapCanvas::set_histogram(std::shared_ptr<const ScalarHistogram> histogram, const QString& note) {
  histogram_ = std::move(histogram);
  note_ = note;
  update();
}

void ColorMapCanvas::set_logarithmic(bool logarithmic) {
  logarithmic_ = logarithmic;
  update();
}

void ColorMapCanvas::select(std::optional<std::size_t> index) {
  if (index && *index >= map_.entries.size()) index.reset();
  if (index == selected_) return;
  selected_ = index;
  ++gestures_;  // keys that move the next one are a step of their own
  update();
  emit selection_changed();
}

// --- where things are

QSize ColorMapCanvas::sizeHint() const {
  return {fontMetrics().averageCharWidth() * 70, fontMetrics().height() * 16};
}

QSize ColorMapCanvas::minimumSizeHint() const {
  return {fontMetrics().averageCharWidth() * 30, fontMetrics().height() * 9};
}

QRectF ColorMapCanvas::plot_area() const {
  const double line = fontMetrics().height();
  const double side = std::max(0.6 * line, fontMetrics().horizontalAdvance(QStringLiteral("−0.000")) * 0.5);
  return QRectF(rect()).adjusted(side, 0.6 * line, -side, -4.2 * line);
}

QRectF ColorMapCanvas::strip_area() const {
  const QRectF plot = plot_area();
  const double line = fontMetrics().height();
  return {plot.left(), plot.bottom() + 0.4 * line, plot.width(), 1.2 * line};
}

QPointF ColorMapCanvas::handle_position(std::size_t index) const {
  const QRectF plot = plot_area();
  const ColorMapEntry& e = map_.entries[index];
  return {plot.left() + e.scalar * plot.width(), plot.bottom() - static_cast<double>(e.color.a) * plot.height()};
}

std::optional<std::size_t> ColorMapCanvas::handle_under(const QPointF& position) const {
  const QRectF plot = plot_area();
  const double reach = 0.6 * fontMetrics().height();
  return entry_at(map_, position.x() - plot.left(), plot.bottom() - position.y(), plot.width(), plot.height(), reach);
}

double ColorMapCanvas::scalar_at(const QPointF& position) const {
  const QRectF plot = plot_area();
  return std::clamp((position.x() - plot.left()) / plot.width(), 0.0, 1.0);
}

float ColorMapCanvas::opacity_at(const QPointF& position) const {
  const QRectF plot = plot_area();
  return static_cast<float>(std::clamp((plot.bottom() - position.y()) / plot.height(), 0.0, 1.0));
}

// --- changes

template <class Edit>
void ColorMapCanvas::edit(const QString& name, const std::string& gesture, const Edit& change) {
  ColorMap map = map_;
  try {
    change(map);
  } catch (const UsageError& error) {
    emit refused(QString::fromUtf8(error.what()));
    return;
  }
  emit refused({});
  if (map == map_) return;
  map_ = map;
  update();
  emit edited(map_, name, gesture);
}

void ColorMapCanvas::insert_at(double scalar, std::optional<float> opacity) {
  std::optional<std::size_t> added;
  edit(tr("Add color map entry"), "",
       [&](ColorMap& map) { added = opacity ? insert_entry(map, scalar, *opacity) : insert_entry(map, scalar); });
  if (added) {
    selected_.reset();  // whatever had the number before
    select(added);
  }
}

void ColorMapCanvas::insert_after_selected() {
  const std::size_t from = std::min(selected_.value_or(0), map_.entries.size() - 2);
  insert_at(0.5 * (map_.entries[from].scalar + map_.entries[from + 1].scalar), std::nullopt);
}

void ColorMapCanvas::remove_selected() {
  if (!selected_) {
    emit refused(tr("Select an entry to remove it."));
    return;
  }
  const std::size_t index = *selected_;
  edit(tr("Remove color map entry"), "", [&](ColorMap& map) { remove_entry(map, index); });
  if (selected_ && *selected_ >= map_.entries.size()) select(map_.entries.size() - 1);
}

void ColorMapCanvas::move_selected(double right, double up) {
  if (!selected_) {
    select(0);
    return;
  }
  const ColorMapEntry entry = map_.entries[*selected_];
  edit(tr("Move color map entry"), "color map keys " + std::to_string(gestures_), [&](ColorMap& map) {
    move_entry(map, *selected_, entry.scalar + right, entry.color.a + static_cast<float>(up));
  });
}

// --- mouse

void ColorMapCanvas::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  const auto under = handle_under(event->position());
  select(under);
  if (!under) return;
  const QPointF handle = handle_position(*under);
  drag_ = Drag{*under, handle - event->position(), handle, map_, "color map drag " + std::to_string(++gestures_)};
}

void ColorMapCanvas::mouseMoveEvent(QMouseEvent* event) {
  if (!drag_) {
    const auto under = handle_under(event->position());
    if (under != hovered_) update();
    hovered_ = under;
    setCursor(under ? Qt::SizeAllCursor : Qt::ArrowCursor);
    return;
  }
  QPointF to = event->position() + drag_->grip;
  if (event->modifiers().testFlag(Qt::ShiftModifier)) {
    const QPointF way = to - drag_->start;
    (std::abs(way.x()) >= std::abs(way.y()) ? to.ry() : to.rx()) =
        std::abs(way.x()) >= std::abs(way.y()) ? drag_->start.y() : drag_->start.x();
  }
  const bool snap = event->modifiers().testFlag(Qt::ControlModifier);
  const ColorMapEntry& before = drag_->before.entries[drag_->index];
  // What is not moved keeps its very number.
  const double scalar = to.x() == drag_->start.x() ? before.scalar : scalar_at(to);
  const float opacity = to.y() == drag_->start.y() ? before.color.a : opacity_at(to);
  edit(tr("Move color map entry"), drag_->gesture, [&](ColorMap& map) {
    move_entry(map, drag_->index, snap ? snapped(scalar, snap_step) : scalar,
               snap ? static_cast<float>(snapped(static_cast<double>(opacity), snap_step)) : opacity);
  });
}

void ColorMapCanvas::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !drag_) return;
  drag_.reset();
  emit gesture_ended();
}

void ColorMapCanvas::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (const auto under = handle_under(event->position())) {
    drag_.reset();
    select(under);
    emit color_wanted(*under);
  } else if (plot_area().contains(event->position())) {
    insert_at(scalar_at(event->position()), opacity_at(event->position()));
  } else if (strip_area().contains(event->position())) {
    insert_at(scalar_at(event->position()), std::nullopt);
  }
}

void ColorMapCanvas::contextMenuEvent(QContextMenuEvent* event) {
  if (event->reason() == QContextMenuEvent::Mouse) {
    select(handle_under(QPointF(event->pos())));
    show_menu(event->globalPos(), QPointF(event->pos()));
  } else {
    const QPointF at = selected_ ? handle_position(*selected_) : plot_area().center();
    show_menu(mapToGlobal(at.toPoint()), at);
  }
}

void ColorMapCanvas::show_menu(const QPoint& at, const QPointF& where) {
  auto* menu = new QMenu(this);
  menu->setObjectName("color_map_menu");
  menu->setAttribute(Qt::WA_DeleteOnClose);
  if (selected_) {
    QAction* color = menu->addAction(tr("&Color…"), this, [this] {
      if (selected_) emit color_wanted(*selected_);
    });
    color->setObjectName("menu_color");
    QAction* remove = menu->addAction(tr("&Remove entry"), this, &ColorMapCanvas::remove_selected);
    remove->setObjectName("menu_remove");
    remove->setEnabled(map_.entries.size() > min_color_map_entries);
  } else {
    const double scalar = scalar_at(where);
    const float opacity = opacity_at(where);
    QAction* add =
        menu->addAction(tr("&Add entry here"), this, [this, scalar, opacity] { insert_at(scalar, opacity); });
    add->setObjectName("menu_add");
    add->setEnabled(map_.entries.size() < max_color_map_entries);
  }
  menu->popup(at);
}

void ColorMapCanvas::leaveEvent(QEvent* /*event*/) {
  hovered_.reset();
  update();
}

// --- keys

void ColorMapCanvas::keyPressEvent(QKeyEvent* event) {
  const double step = event->modifiers().testFlag(Qt::ShiftModifier)     ? 0.1
                      : event->modifiers().testFlag(Qt::ControlModifier) ? 0.001
                                                                         : 0.01;
  const std::size_t last = map_.entries.empty() ? 0 : map_.entries.size() - 1;
  switch (event->key()) {
    case Qt::Key_Left:
      return move_selected(-step, 0.0);
    case Qt::Key_Right:
      return move_selected(step, 0.0);
    case Qt::Key_Up:
      return move_selected(0.0, step);
    case Qt::Key_Down:
      return move_selected(0.0, -step);
    case Qt::Key_PageUp:
      return select(selected_ ? std::max<std::size_t>(*selected_, 1) - 1 : last);
    case Qt::Key_PageDown:
      return select(selected_ ? std::min(*selected_ + 1, last) : 0);
    case Qt::Key_Home:
      return select(0);
    case Qt::Key_End:
      return select(last);
    case Qt::Key_Insert:
      return insert_after_selected();
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      return remove_selected();
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (selected_) emit color_wanted(*selected_);
      return;
    case Qt::Key_Escape:
      if (drag_) {
        const Drag drag = *drag_;
        drag_.reset();
        edit(tr("Move color map entry"), drag.gesture, [&](ColorMap& map) { map = drag.before; });
        emit gesture_ended();
        return;
      }
      break;
    default:
      break;
  }
  QWidget::keyPressEvent(event);
}

void ColorMapCanvas::focusInEvent(QFocusEvent* event) {
  if (!selected_ && event->reason() != Qt::MouseFocusReason && !map_.entries.empty()) select(0);
  update();
}

void ColorMapCanvas::focusOutEvent(QFocusEvent* /*event*/) {
  ++gestures_;
  emit gesture_ended();
  update();
}

// --- pictures

QString ColorMapCanvas::tip_at(const QPointF& position) const {
  const auto value = [&](double scalar) {
    return histogram_ ? tr(", value %1").arg(number(histogram_->value(scalar))) : QString();
  };
  if (const auto under = handle_under(position)) {
    const ColorMapEntry& e = map_.entries[*under];
    return tr("Entry %1: scalar %2%3, opacity %4")
        .arg(*under + 1)
        .arg(number(e.scalar), value(e.scalar), number(static_cast<double>(e.color.a)));
  }
  if (!plot_area().contains(position) && !strip_area().contains(position)) return {};
  const double scalar = scalar_at(position);
  QString tip = tr("Scalar %1%2").arg(number(scalar), value(scalar));
  if (histogram_ && !histogram_->counts.empty()) {
    const std::size_t bins = histogram_->counts.size();
    const std::size_t bin = std::min(static_cast<std::size_t>(scalar * static_cast<double>(bins)), bins - 1);
    const QString count = QLocale::c().toString(static_cast<qulonglong>(histogram_->counts[bin]));
    tip += '\n' + (histogram_->of_atoms ? tr("%1 atoms from %2 to %3") : tr("%1 vertices from %2 to %3"))
                      .arg(count, number(histogram_->value(static_cast<double>(bin) / static_cast<double>(bins))),
                           number(histogram_->value(static_cast<double>(bin + 1) / static_cast<double>(bins))));
  }
  return tip;
}

bool ColorMapCanvas::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    const auto* help = static_cast<QHelpEvent*>(event);
    const QString tip = tip_at(QPointF(help->pos()));
    tip.isEmpty() ? QToolTip::hideText() : QToolTip::showText(help->globalPos(), tip, this);
    return true;
  }
  if (event->type() == QEvent::ShortcutOverride) {  // the keys above are no menu's while this has the focus
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Delete || key == Qt::Key_Insert || key == Qt::Key_Home || key == Qt::Key_End) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

void ColorMapCanvas::changeEvent(QEvent* event) {
  if (event->type() == QEvent::FontChange || event->type() == QEvent::PaletteChange) updateGeometry();
  QWidget::changeEvent(event);
}

void ColorMapCanvas::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const QRectF plot = plot_area();
  const QColor ink = palette().color(QPalette::Text);
  const QColor base = palette().color(QPalette::Base);
  const auto blend = [&](double part) {
    return QColor::fromRgbF(static_cast<float>(base.redF() * (1.0 - part) + ink.redF() * part),
                            static_cast<float>(base.greenF() * (1.0 - part) + ink.greenF() * part),
                            static_cast<float>(base.blueF() * (1.0 - part) + ink.blueF() * part));
  };
  painter.fillRect(plot, base);
  if (histogram_) draw_histogram(painter, plot, *histogram_, logarithmic_, blend(0.3));
  draw_opacity_curve(painter, plot, map_, ink);
  painter.setPen(blend(0.35));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(plot);

  // Colours as they are, and below them with their opacity.
  QRectF strip = strip_area();
  QRectF upper = strip;
  upper.setHeight(0.55 * strip.height());
  QRectF lower = strip;
  lower.setTop(upper.bottom());
  draw_color_strip(painter, upper, map_, false);
  draw_color_strip(painter, lower, map_, true);
  painter.setPen(blend(0.35));
  painter.drawRect(strip);
  const QColor window_ink = palette().color(QPalette::WindowText);
  const QRectF below(plot.left(), strip.bottom(), plot.width(), 0.0);
  draw_value_axis(painter, below, histogram_ ? histogram_->low : 0.0, histogram_ ? histogram_->high : 1.0, window_ink);

  if (histogram_) {
    const QString name =
        histogram_->of_atoms ? tr("weighted sum of an atom's defect values") : QString::fromStdString(histogram_->name);
    const double line = fontMetrics().height();
    painter.setPen(window_ink);
    painter.drawText(QRectF(0.0, strip.bottom() + 1.35 * line, width(), 1.2 * line), Qt::AlignCenter, name);
  }
  painter.setPen(blend(0.7));
  painter.drawText(plot.adjusted(6, 4, -6, -4), Qt::AlignTop | Qt::AlignLeft, tr("Opacity"));
  if (!note_.isEmpty()) {
    painter.drawText(plot.adjusted(6, 4, -6, -4), static_cast<int>(Qt::AlignTop | Qt::AlignHCenter | Qt::TextWordWrap),
                     note_);
  }

  painter.setRenderHint(QPainter::Antialiasing);
  const double radius = 0.32 * fontMetrics().height();
  for (std::size_t i = 0; i < map_.entries.size(); ++i) {
    const bool chosen = selected_ == i;
    const double r = hovered_ == i || chosen ? 1.25 * radius : radius;
    painter.setPen(QPen(base, 3.0));
    painter.setBrush(to_color(map_.entries[i].color));
    painter.drawEllipse(handle_position(i), r, r);
    painter.setPen(QPen(chosen ? palette().color(QPalette::Highlight) : ink, chosen ? 2.5 : 1.3));
    painter.drawEllipse(handle_position(i), r, r);
  }
  if (hasFocus()) {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(plot.adjusted(-2, -2, 2, 2));
  }
}

}  // namespace atomesh::gui
