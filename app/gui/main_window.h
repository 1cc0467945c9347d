// The window: the viewport in the middle, docks around it, menus over all of them.
#pragma once

#include <QMainWindow>
#include <memory>

#include "app/gui/workspace.h"

class QAction;
class QActionGroup;
class QDockWidget;
class QLabel;
class QMenu;
class QProgressBar;
class QStackedWidget;
class QToolButton;

namespace atomesh::gui {

class ColorMapEditor;
class CrystalViewDialog;
class DefectDock;
class HelpWindow;
class Job;
class MovieDialog;
class PictureCopier;
class SavePictureDialog;
class Opening;
class RenderingParameters;
class Viewport;
struct WorkerPicture;

class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  Workspace& workspace() { return workspace_; }
  Viewport& viewport() { return *viewport_; }

  // A data file of any kind: material and mesh files open, atoms go to preprocessing, a picture that atomesh made
  // brings back its view. `crf`: the parameters to begin with; "": those there are.
  void open(const QString& path, const QString& crf = {});
  // As one step of the history.
  void load_parameters(const QString& path);
  // What the command line named, either may be "": without a file the loader is shown.
  void start(const QString& path, const QString& crf);

 public slots:
  void show_loader();
  void show_view();
  void next_mode(int step = 1);
  void next_shading();
  void toggle_full_screen();
  void reset_orientation();

 protected:
  void changeEvent(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void build_pages();
  void build_docks();
  void build_left_docks();
  void build_right_docks();
  void build_bottom_docks();
  QDockWidget* add_dock(QWidget* content, const QString& title, Qt::DockWidgetArea area);
  void build_menus();
  void build_file_menu();
  void add_output_actions(QMenu& menu);  // saving pictures and movies
  void build_edit_menu();
  void add_copy_action(QMenu& menu);
  void build_view_menu();
  void build_mode_menu();
  void build_view_options(QMenu& menu);
  void build_window_menu();
  void build_help_menu();
  void keep_menu_keys();
  void build_status_line();
  void follow_workspace();
  void update_title();
  void update_actions();
  void update_status(const std::shared_ptr<const WorkerPicture>& picture, double gpu_ms, bool whole);
  void show_refining(double fraction);
  void follow(Job* job);
  void complain(const QString& message);
  void change_view(const QString& name, const std::function<void(Parameters&)>& change);
  void fill_recent_menu();
  QString folder() const;  // of what is open, where dialogs for files begin
  void show_help(const QString& topic);
  void show_docks(bool on);

  Workspace workspace_;
  QStackedWidget* pages_ = nullptr;
  Opening* opening_ = nullptr;
  Viewport* viewport_ = nullptr;
  ColorMapEditor* color_map_ = nullptr;
  RenderingParameters* rendering_ = nullptr;
  DefectDock* defects_ = nullptr;
  HelpWindow* help_ = nullptr;
  CrystalViewDialog* crystal_view_ = nullptr;
  SavePictureDialog* save_picture_ = nullptr;
  MovieDialog* movie_ = nullptr;
  PictureCopier* copier_ = nullptr;

  QAction* undo_ = nullptr;
  QAction* redo_ = nullptr;
  QActionGroup* modes_ = nullptr;
  QActionGroup* shadings_ = nullptr;
  QActionGroup* projections_ = nullptr;
  QAction* full_screen_ = nullptr;
  std::vector<QAction*> needing_document_;
  std::vector<QDockWidget*> docks_;
  QDockWidget* rendering_dock_ = nullptr;
  bool docks_shown_ = true;
  QByteArray view_state_;  // of docks and toolbars, while they are hidden
  QMenu* docks_menu_ = nullptr;
  QMenu* recent_menu_ = nullptr;
  QLabel* counts_ = nullptr;
  QLabel* frame_ = nullptr;
  QString frame_text_;  // but for how far it is refined
  QLabel* hint_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QToolButton* cancel_ = nullptr;
};

}  // namespace atomesh::gui
