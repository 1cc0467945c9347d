// How a colour map is drawn: strips, swatches, the histogram behind and the axis below.
#pragma once

#include <QIcon>
#include <QPainter>
#include <QPalette>
#include <QRectF>

#include "app/gui/scalar_histogram.h"
#include "core/color_map.h"

namespace atomesh::gui {

QColor to_color(const Vec4f& color, bool opaque = true);

// Squares of two grays, behind what may be transparent.
void draw_checks(QPainter& painter, const QRectF& area);
// The colours of scalars 0 to 1 from left to right, exact to the device pixel; with `opacity` as they are, else opaque.
void draw_color_strip(QPainter& painter, const QRectF& area, const ColorMap& map, bool opacity);
// A colour strip as icon of a menu's entry, and a swatch of one colour.
QIcon color_map_icon(const ColorMap& map, const QSize& size, double pixel_ratio);
QIcon swatch_icon(const Vec4f& color, const QSize& size, double pixel_ratio);

void draw_histogram(QPainter& painter, const QRectF& area, const ScalarHistogram& histogram, bool logarithmic,
                    const QColor& color);
// Opacity over scalar, the area below filled with the map's colours.
void draw_opacity_curve(QPainter& painter, const QRectF& area, const ColorMap& map, const QColor& line);
// Ticks and their texts below `area`, for values from `low` to `high` at its left and right sides.
void draw_value_axis(QPainter& painter, const QRectF& area, double low, double high, const QColor& ink);

}  // namespace atomesh::gui
