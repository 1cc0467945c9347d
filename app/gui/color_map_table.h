// The entries of a colour map as rows that are typed: scalar, value, colour, opacity.
#pragma once

#include <QAbstractTableModel>

#include "core/color_map.h"

namespace atomesh::gui {

// Knows no workspace: what is typed is emitted, set_color_map() shows what came of it.
class ColorMapTable : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { scalar, value, color, opacity, columns };
  explicit ColorMapTable(QObject* parent = nullptr) : QAbstractTableModel(parent) {}

  void set_color_map(const ColorMap& map);
  // What scalars 0 and 1 stand for.
  void set_range(double low, double high);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role = Qt::DisplayRole) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  // From text: a number; "#rrggbb" or "r,g,b". False, and refused(), for anything else.
  bool setData(const QModelIndex& index, const QVariant& text, int role = Qt::EditRole) override;

 signals:
  // `entry` is where the changed one is now.
  void edited(const atomesh::ColorMap& map, const QString& name, std::size_t entry);
  void refused(const QString& why);

 private:
  ColorMap map_;
  double low_ = 0.0;
  double high_ = 1.0;
};

}  // namespace atomesh::gui
