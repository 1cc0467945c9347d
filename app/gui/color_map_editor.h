// The colour map of the volume, edited over the histogram of its scalars (the manual's B.6.3.3).
#pragma once

#include <QWidget>

#include "app/gui/color_map_edit.h"
#include "app/gui/histogram_source.h"
#include "app/gui/workspace.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QLineEdit;
class QMenu;
class QPushButton;
class QSpinBox;
class QTableView;

namespace atomesh::gui {

class ColorMapCanvas;
class ColorMapTable;

// Every change goes to the workspace at once, one step of the history for one gesture. For a dock or a window of its
// own.
class ColorMapEditor : public QWidget {
  Q_OBJECT

 public:
  explicit ColorMapEditor(Workspace& workspace, QWidget* parent = nullptr);

  // As it is counted now; null before the first.
  std::shared_ptr<const ScalarHistogram> histogram() const { return source_.histogram(); }
  bool counting() const { return source_.counting(); }
  // *Create Scalar Histogram*, without asking where to: at once, or when it is counted. Complains where there is
  // nothing to count and where it cannot be written.
  void write_histogram(const QString& path);

  // A file of color_map_files.h; complains where there is none. Its colours alone where it has no opacities.
  void load_color_map(const QString& path);
  void save_color_map(const QString& path);

 public slots:
  void ask_color(std::size_t entry);
  void ask_where_to_write_histogram();

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void build_toolbar();
  void build_table();
  void build_range();
  void build_layout();
  void follow();
  void fill_presets(QMenu* menu);
  void fill_opacities(QMenu* menu);

  // Of the workspace's parameters.
  const ColorMap& color_map() const { return workspace_.parameters().volume.color_map; }
  void change(const ColorMap& map, const QString& name, const std::string& gesture = "");
  void apply_preset(const std::string& name);
  void show_parameters();
  void show_histogram();
  void show_apply();
  void write_when_counted();
  void show_refusal(const QString& why);
  void ask_which_to_load();
  void ask_where_to_save();
  void set_range(const std::string& key, QLineEdit* edit);
  void copy_text();
  void paste_text();
  ColorMapPart part() const;

  Workspace& workspace_;
  HistogramSource source_;
  QPushButton* presets_ = nullptr;
  QComboBox* part_ = nullptr;
  QPushButton* opacities_ = nullptr;
  QPushButton* reverse_ = nullptr;
  QCheckBox* logarithmic_ = nullptr;
  ColorMapCanvas* canvas_ = nullptr;
  ColorMapTable* entries_ = nullptr;
  QTableView* table_ = nullptr;
  QPushButton* add_ = nullptr;
  QPushButton* remove_ = nullptr;
  QPushButton* color_ = nullptr;
  QLabel* count_ = nullptr;
  QWidget* range_ = nullptr;
  QLineEdit* range_low_ = nullptr;
  QLineEdit* range_high_ = nullptr;
  QLabel* refusal_ = nullptr;
  QSpinBox* bins_ = nullptr;
  QPushButton* create_histogram_ = nullptr;
  QCheckBox* auto_apply_ = nullptr;
  QPushButton* apply_ = nullptr;
  int colors_asked_ = 0;
  QString histogram_path_;  // where the next histogram is to be written; "" nowhere
};

}  // namespace atomesh::gui
