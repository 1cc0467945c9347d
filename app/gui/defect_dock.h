// The table of defect clusters: a click, or the arrow keys, fly there and mark it.
#pragma once

#include <QWidget>

#include "app/gui/defect_list.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QStackedWidget;
class QTableView;

namespace atomesh::gui {

class DefectDock : public QWidget {
  Q_OBJECT

 public:
  explicit DefectDock(Workspace& workspace, QWidget* parent = nullptr);

  const DefectList& list() const { return list_; }
  // Selects the cluster of an atom, as a click on its row; false where it is in none that is shown.
  bool select_atom(Index atom);
  // Without asking where to; complains where it cannot be written.
  void write_csv(const QString& path);

 public slots:
  void ask_where_to_write();

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void build();
  void show_state();
  void fill_kinds();
  void mark(int row);
  void fly(int row);
  void unmark();

  Workspace& workspace_;
  DefectList list_;
  QComboBox* kinds_ = nullptr;
  QCheckBox* flying_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  QTableView* table_ = nullptr;
  QLabel* message_ = nullptr;
  QLabel* summary_ = nullptr;
  QPushButton* export_ = nullptr;
  bool marked_ = false;  // by this
  bool fitted_ = false;  // the columns, to the sample's clusters
};

}  // namespace atomesh::gui
