// The dock "Rendering parameters" (manual, B.6.3): a page for each mode with auto apply and apply, the parameter file,
// and a search over all parameters. Its rows come from the parameter table.
#pragma once

#include <QWidget>
#include <array>

#include "core/parameters.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QLineEdit;
class QMenu;
class QPushButton;
class QStackedWidget;
class QVBoxLayout;

namespace atomesh::gui {

class ParameterForm;
class Workspace;

class RenderingParameters : public QWidget {
  Q_OBJECT

 public:
  RenderingParameters(Workspace& workspace, QWidget* parent);

  // The mode whose page is shown; that of the view until another is chosen.
  Mode page() const;
  void show_page(Mode mode);
  // Puts the cursor into the search field.
  void start_search();

 signals:
  void edit_color_map_requested();
  void create_histogram_requested();  // histogram.csv, see the manual's B.6.3.3
  // A page of help_pages(), or a parameter's key.
  void help_requested(const QString& topic);

 private:
  struct Page {
    QCheckBox* auto_apply = nullptr;
    QPushButton* apply = nullptr;
  };
  QWidget* make_pages();
  QWidget* make_page(Mode mode);
  QWidget* make_search_page();
  QWidget* make_file_box();
  ParameterForm* make_form(QWidget* parent);
  void follow_mode();
  void follow_apply();
  void search();
  void reset_page();
  void load(const QString& path);
  void load_typed();
  void save_typed();
  void fill_recent();

  Workspace& workspace_;
  QLineEdit* search_ = nullptr;
  QStackedWidget* search_or_pages_ = nullptr;
  QComboBox* mode_ = nullptr;
  QLabel* not_shown_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  std::array<Page, 5> page_{};
  Mode view_mode_;
  ParameterForm* found_ = nullptr;
  QLabel* found_text_ = nullptr;
  QLineEdit* file_ = nullptr;
  QLabel* file_message_ = nullptr;
  QMenu* recent_ = nullptr;
};

}  // namespace atomesh::gui
