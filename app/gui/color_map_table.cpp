#include "app/gui/color_map_table.h"

#include <QColor>
#include <algorithm>
#include <cmath>
#include <optional>

#include "app/gui/color_map_edit.h"
#include "core/error.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

namespace {

QString number(double value) {
  return QString::number(value, 'g', 6);
}

// As set_parameter() says it.
double typed_number(const std::string& text, const char* what) {
  const std::optional<double> number = read_real(text);
  if (!number) throw UsageError("\"" + text + "\" is no number; the " + what + " is one, such as 0.25");
  return *number;
}

}  // namespace

void ColorMapTable::set_color_map(const ColorMap& map) {
  if (map == map_) return;
  if (map.entries.size() != map_.entries.size()) {
    beginResetModel();
    map_ = map;
    endResetModel();
    return;
  }
  map_ = map;
  emit dataChanged(index(0, 0), index(rowCount() - 1, columns - 1));
}

void ColorMapTable::set_range(double low, double high) {
  low_ = low;
  high_ = high;
  if (rowCount() > 0) emit dataChanged(index(0, value), index(rowCount() - 1, value));
}

int ColorMapTable::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(map_.entries.size());
}

int ColorMapTable::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : columns;
}

QVariant ColorMapTable::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const ColorMapEntry& entry = map_.entries[static_cast<std::size_t>(index.row())];
  const QColor shown = QColor::fromRgbF(entry.color.r, entry.color.g, entry.color.b);
  if (role == Qt::TextAlignmentRole) return QVariant::fromValue<int>(Qt::AlignRight | Qt::AlignVCenter);
  if (role == Qt::DecorationRole && index.column() == color) return shown;
  if (role != Qt::DisplayRole && role != Qt::EditRole) return {};
  // To be changed, a number stands there as it is.
  const bool exact = role == Qt::EditRole;
  switch (index.column()) {
    case scalar:
      return exact ? QString::fromStdString(real_text(entry.scalar)) : number(entry.scalar);
    case value: {
      const double v = low_ * (1.0 - entry.scalar) + high_ * entry.scalar;
      return exact ? QString::fromStdString(real_text(v)) : number(v);
    }
    case color:
      return shown.name();
    case opacity:
      return exact ? QString::fromStdString(real_text(entry.color.a)) : number(static_cast<double>(entry.color.a));
    default:
      return {};
  }
}

QVariant ColorMapTable::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role != Qt::DisplayRole && role != Qt::ToolTipRole) return {};
  if (orientation == Qt::Vertical) return role == Qt::DisplayRole ? QVariant(section + 1) : QVariant();
  const bool tip = role == Qt::ToolTipRole;
  switch (section) {
    case scalar:
      return tip ? tr("Normalized scalar, 0 to 1") : tr("Scalar");
    case value:
      return tip ? tr("What the scalar stands for: the sum of an atom's weighted defect values, or the field's value")
                 : tr("Value");
    case color:
      return tip ? tr("#rrggbb, or three numbers from 0 to 1; double click for a dialog") : tr("Color");
    case opacity:
      return tip ? tr("Opacity coefficient, 0 to 1: times the alpha length constant it is the extinction")
                 : tr("Opacity");
    default:
      return {};
  }
}

Qt::ItemFlags ColorMapTable::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = Qt::ItemIsSelectable | Qt::ItemIsEnabled;
  return index.column() == value && !(high_ > low_) ? flags : flags | Qt::ItemIsEditable;
}

bool ColorMapTable::setData(const QModelIndex& index, const QVariant& typed, int role) {
  if (role != Qt::EditRole || !index.isValid() || index.row() >= rowCount()) return false;
  const std::string text = typed.toString().trimmed().toStdString();
  ColorMap map = map_;
  auto entry = static_cast<std::size_t>(index.row());
  try {
    switch (index.column()) {
      case scalar:
        entry = set_entry_scalar(map, entry, typed_number(text, "scalar"));
        break;
      case value: {
        const double v = typed_number(text, "value");
        if (text == data(index, Qt::EditRole).toString().toStdString()) return true;  // as it was
        if (!(v >= low_ && v <= high_)) {
          throw UsageError("the value must be from " + real_text(low_) + " to " + real_text(high_));
        }
        entry = set_entry_scalar(map, entry, std::clamp((v - low_) / (high_ - low_), 0.0, 1.0));
        break;
      }
      case color: {
        const std::optional<Vec3f> rgb = read_rgb(text);
        if (!rgb) throw UsageError("\"" + text + "\" is no color; write #rrggbb or three numbers from 0 to 1");
        // A colour that reads as it stood keeps the digits that #rrggbb does not show.
        if (text == data(index, Qt::EditRole).toString().toStdString()) return true;
        set_entry_color(map, entry, *rgb);
        break;
      }
      case opacity:
        set_entry_opacity(map, entry, static_cast<float>(typed_number(text, "opacity")));
        break;
      default:
        return false;
    }
  } catch (const UsageError& error) {
    emit refused(QString::fromUtf8(error.what()));
    return false;
  }
  emit refused({});
  if (map == map_) return true;
  set_color_map(map);
  emit edited(map, tr("Color map entry %1").arg(index.row() + 1), entry);
  return true;
}

}  // namespace atomesh::gui
