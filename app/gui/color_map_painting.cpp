#include "app/gui/color_map_painting.h"

#include <QFontMetricsF>
#include <QImage>
#include <QPainterPath>
#include <QPixmap>
#include <algorithm>
#include <cmath>

#include "core/axis_ticks.h"

namespace atomesh::gui {

namespace {

double pixel_ratio(const QPainter& painter) {
  return painter.device() != nullptr ? painter.device()->devicePixelRatioF() : 1.0;
}

QPixmap blank_pixmap(const QSize& size, double ratio) {
  QPixmap pixmap((QSizeF(size) * ratio).toSize());
  pixmap.setDevicePixelRatio(ratio);
  pixmap.fill(Qt::transparent);
  return pixmap;
}

}  // namespace

QColor to_color(const Vec4f& color, bool opaque) {
  const auto part = [](float c) { return std::clamp(c, 0.0F, 1.0F); };
  return QColor::fromRgbF(part(color.r), part(color.g), part(color.b), opaque ? 1.0F : part(color.a));
}

void draw_checks(QPainter& painter, const QRectF& area) {
  painter.save();
  painter.setClipRect(area);
  painter.fillRect(area, QColor(205, 205, 205));
  const double side = std::max(3.0, area.height() / 2.0);
  int row = 0;
  for (double y = area.top(); y < area.bottom(); y += side, ++row) {
    for (double x = area.left() + (row % 2) * side; x < area.right(); x += 2.0 * side) {
      painter.fillRect(QRectF(x, y, side, side), QColor(150, 150, 150));
    }
  }
  painter.restore();
}

void draw_color_strip(QPainter& painter, const QRectF& area, const ColorMap& map, bool opacity) {
  const int columns = std::max(1, static_cast<int>(std::lround(area.width() * pixel_ratio(painter))));
  QImage line(columns, 1, QImage::Format_ARGB32);
  for (int c = 0; c < columns; ++c) {
    line.setPixelColor(c, 0, to_color(map((c + 0.5) / columns), !opacity));
  }
  if (opacity) draw_checks(painter, area);
  painter.save();
  painter.setRenderHint(QPainter::SmoothPixmapTransform, false);
  painter.drawImage(area, line, QRectF(0, 0, columns, 1));
  painter.restore();
}

QIcon color_map_icon(const ColorMap& map, const QSize& size, double ratio) {
  QPixmap pixmap = blank_pixmap(size, ratio);
  QPainter painter(&pixmap);
  draw_color_strip(painter, QRectF(QPointF(0, 0), QSizeF(size)), map, false);
  return pixmap;
}

QIcon swatch_icon(const Vec4f& color, const QSize& size, double ratio) {
  QPixmap pixmap = blank_pixmap(size, ratio);
  QPainter painter(&pixmap);
  painter.fillRect(QRectF(QPointF(0, 0), QSizeF(size)), to_color(color));
  return pixmap;
}

void draw_histogram(QPainter& painter, const QRectF& area, const ScalarHistogram& histogram, bool logarithmic,
                    const QColor& color) {
  const std::size_t bins = histogram.counts.size();
  const std::uint64_t largest = histogram.largest();
  if (bins == 0 || largest == 0) return;
  const double step = area.width() / static_cast<double>(bins);
  // Crystals have few different values: a bar by itself, or at the frame, is wide enough to be seen.
  const double width = std::max(step, 3.0);
  QPainterPath bars;
  bars.setFillRule(Qt::WindingFill);
  for (std::size_t b = 0; b < bins; ++b) {
    if (histogram.counts[b] == 0) continue;
    // One atom among a million is seen too.
    const double height = std::max(bar_height(histogram.counts[b], largest, logarithmic) * area.height(), 1.0);
    const double middle = area.left() + (static_cast<double>(b) + 0.5) * step;
    const double left = std::max(area.left(), std::min(middle - 0.5 * width, area.right() - width));
    bars.addRect(left, area.bottom() - height, width, height);
  }
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, step < 4.0);
  painter.setPen(Qt::NoPen);
  painter.setBrush(color);
  painter.drawPath(bars);
  painter.restore();
}

void draw_opacity_curve(QPainter& painter, const QRectF& area, const ColorMap& map, const QColor& line) {
  if (map.entries.empty()) return;
  const auto y = [&](const ColorMapEntry& e) { return area.bottom() - static_cast<double>(e.color.a) * area.height(); };
  QPainterPath curve;
  curve.moveTo(area.left(), y(map.entries.front()));
  for (const ColorMapEntry& e : map.entries) curve.lineTo(area.left() + e.scalar * area.width(), y(e));
  curve.lineTo(area.right(), y(map.entries.back()));
  QPainterPath below = curve;
  below.lineTo(area.bottomRight());
  below.lineTo(area.bottomLeft());
  below.closeSubpath();

  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setClipPath(below, Qt::IntersectClip);
  painter.setOpacity(0.45);
  draw_color_strip(painter, area, map, false);
  painter.restore();

  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(line, 1.5));
  painter.setBrush(Qt::NoBrush);
  painter.drawPath(curve);
  painter.restore();
}

void draw_value_axis(QPainter& painter, const QRectF& area, double low, double high, const QColor& ink) {
  const QFontMetricsF metrics(painter.font());
  const double room = metrics.horizontalAdvance(QStringLiteral("−0.0000")) * 1.4;
  const int at_most = std::clamp(static_cast<int>(area.width() / room), 2, 11);
  painter.save();
  painter.setPen(ink);
  double taken = -1e9;  // up to where texts stand
  for (const AxisTick& tick : linear_ticks(low, high, at_most)) {
    const double part = high > low ? (0.5 * tick.value - 0.5 * low) / (0.5 * high - 0.5 * low) : 0.5;
    const double x = area.left() + std::clamp(part, 0.0, 1.0) * area.width();
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.top() + 4.0));
    const QString text = QString::fromStdString(tick.text);
    const double width = metrics.horizontalAdvance(text);
    const double left = std::clamp(x - 0.5 * width, area.left() - 0.5 * width, area.right() + 0.5 * room - width);
    if (left < taken) continue;
    painter.drawText(QPointF(left, area.top() + 5.0 + metrics.ascent()), text);
    taken = left + width + metrics.averageCharWidth();
  }
  painter.restore();
}

}  // namespace atomesh::gui
