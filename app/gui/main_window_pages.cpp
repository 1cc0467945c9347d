// Pages and docks of the window, and what they ask of each other.
#include <QAction>
#include <QDockWidget>
#include <QScrollArea>
#include <QStackedWidget>

#include "app/gui/color_map_editor.h"
#include "app/gui/defect_dock.h"
#include "app/gui/display_options.h"
#include "app/gui/drop_target.h"
#include "app/gui/help_window.h"
#include "app/gui/log_panel.h"
#include "app/gui/main_window.h"
#include "app/gui/material_panel.h"
#include "app/gui/opening.h"
#include "app/gui/pick_panel.h"
#include "app/gui/rendering_parameters.h"
#include "app/gui/timing_panel.h"
#include "app/gui/viewport.h"

namespace atomesh::gui {

void MainWindow::build_pages() {
  pages_ = new QStackedWidget(this);
  pages_->setObjectName("pages");
  viewport_ = new Viewport(workspace_, pages_);
  pages_->addWidget(viewport_);
  setCentralWidget(pages_);
  opening_ = new Opening(workspace_, *pages_, *viewport_);
  connect(pages_, &QStackedWidget::currentChanged, this, [this] { show_docks(pages_->currentWidget() == viewport_); });
  connect(opening_, &Opening::job_started, this, &MainWindow::follow);
  connect(opening_, &Opening::activity_changed, this, &MainWindow::update_title);
  connect(opening_, &Opening::exit_wanted, this, &QWidget::close);

  const auto* drops = new DropTarget(*this);
  connect(drops, &DropTarget::dropped, opening_, &Opening::take);
  connect(drops, &DropTarget::refused, this, &MainWindow::complain);
}

QDockWidget* MainWindow::add_dock(QWidget* content, const QString& title, Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(content->objectName() + "_dock");
  dock->toggleViewAction()->setObjectName("show_" + content->objectName());
  dock->setWidget(content);
  addDockWidget(area, dock);
  docks_.push_back(dock);
  return dock;
}

void MainWindow::build_docks() {
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
  setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  build_left_docks();
  build_right_docks();
  build_bottom_docks();
  // Until the user's own layout is known: columns of text on either side, the rest for the view.
  const int em = fontMetrics().averageCharWidth();
  resizeDocks({docks_.front(), rendering_dock_}, {54 * em, 73 * em}, Qt::Horizontal);
}

void MainWindow::build_left_docks() {
  add_dock(new MaterialPanel(workspace_), tr("Material"), Qt::LeftDockWidgetArea);
  defects_ = new DefectDock(workspace_, this);
  QDockWidget* defects_dock = add_dock(defects_, tr("Crystal defects"), Qt::LeftDockWidgetArea);
  QDockWidget* pick_dock = add_dock(new PickPanel(workspace_, this), tr("Pick"), Qt::LeftDockWidgetArea);
  tabifyDockWidget(defects_dock, pick_dock);
  defects_dock->raise();
  connect(&workspace_, &Workspace::picks_changed, pick_dock, [this, pick_dock] {
    if (!workspace_.picks().empty()) pick_dock->raise();
  });
}

void MainWindow::build_right_docks() {
  auto* display = new DisplayOptions(workspace_, this);
  QDockWidget* display_dock = add_dock(display, tr("Display options"), Qt::RightDockWidgetArea);
  connect(display, &DisplayOptions::full_screen_requested, this, &MainWindow::toggle_full_screen);
  connect(display, &DisplayOptions::reset_orientation_requested, this, &MainWindow::reset_orientation);
  connect(display, &DisplayOptions::help_requested, this, &MainWindow::show_help);

  rendering_ = new RenderingParameters(workspace_, this);
  rendering_dock_ = add_dock(rendering_, tr("Rendering parameters"), Qt::RightDockWidgetArea);
  connect(rendering_, &RenderingParameters::help_requested, this, &MainWindow::show_help);

  color_map_ = new ColorMapEditor(workspace_, this);
  QDockWidget* map_dock = add_dock(color_map_, tr("Color map"), Qt::RightDockWidgetArea);
  connect(rendering_, &RenderingParameters::edit_color_map_requested, map_dock, [map_dock] {
    map_dock->show();
    map_dock->raise();
  });
  connect(rendering_, &RenderingParameters::create_histogram_requested, color_map_,
          &ColorMapEditor::ask_where_to_write_histogram);
  tabifyDockWidget(display_dock, rendering_dock_);
  tabifyDockWidget(rendering_dock_, map_dock);
  rendering_dock_->raise();
  // Never so narrow that their tabs could not be read; a tab is its title and some room.
  int tabs = 0;
  for (const QDockWidget* dock : {display_dock, rendering_dock_, map_dock}) {
    tabs += fontMetrics().horizontalAdvance(dock->windowTitle()) + 4 * fontMetrics().averageCharWidth();
  }
  rendering_dock_->setMinimumWidth(tabs);
}

void MainWindow::build_bottom_docks() {
  QDockWidget* log = add_dock(new LogPanel(workspace_, this), tr("Log"), Qt::BottomDockWidgetArea);
  auto* timing = new TimingPanel(workspace_, this);
  connect(viewport_, &Viewport::frame_shown, timing, &TimingPanel::note_picture);
  QDockWidget* timing_dock = add_dock(timing, tr("Timing"), Qt::BottomDockWidgetArea);
  tabifyDockWidget(log, timing_dock);
  log->raise();
  // The view comes first; the status line says the last of it.
  log->hide();
  timing_dock->hide();
}

// Loader and preprocessing have the window to themselves; the view gets back the docks that it had.
void MainWindow::show_docks(bool on) {
  if (on == docks_shown_) return;
  docks_shown_ = on;
  if (on) {
    restoreState(view_state_);
  } else {
    view_state_ = saveState();
    for (QDockWidget* dock : docks_) dock->hide();
  }
  for (QDockWidget* dock : docks_) dock->toggleViewAction()->setEnabled(on);
}

void MainWindow::show_help(const QString& topic) {
  if (help_ == nullptr) help_ = new HelpWindow(this);
  help_->show_topic(topic);
}

void MainWindow::show_view() {
  pages_->setCurrentWidget(viewport_);
  viewport_->setFocus();
}

}  // namespace atomesh::gui
