#include <QAbstractButton>
#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QDockWidget>
#include <QFileDialog>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QStackedWidget>
#include <array>

#include "app/gui/crystal_view_dialog.h"
#include "app/gui/main_window.h"
#include "app/gui/navigation.h"
#include "app/gui/parameter_files.h"
#include "app/gui/rendering_parameters.h"
#include "app/gui/theme.h"
#include "app/gui/viewport.h"
#include "core/camera.h"
#include "core/error.h"

namespace atomesh::gui {

void MainWindow::build_menus() {
  build_file_menu();
  build_edit_menu();
  build_mode_menu();
  build_view_menu();
  build_window_menu();
  build_help_menu();
  keep_menu_keys();
}

void MainWindow::build_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  QAction* open = menu->addAction(tr("&Open…"));
  open->setObjectName("action_open");
  open->setShortcut(QKeySequence::Open);
  connect(open, &QAction::triggered, this, [this] {
    const QString path = QFileDialog::getOpenFileName(
        this, tr("Open"), folder(),
        tr("All that can be opened (*.crb *.crt *.dat *.xyz *.extxyz *.lmp *.data *.dump *.lammpstrj *.vtu *.vtk *.bin "
           "*.node *.ele *.png);;Materials (*.crb *.crt);;All files (*)"));
    if (!path.isEmpty()) this->open(path);
  });
  recent_menu_ = menu->addMenu(tr("Open &recent"));
  recent_menu_->setObjectName("menu_recent");
  recent_menu_->setToolTipsVisible(true);
  connect(recent_menu_, &QMenu::aboutToShow, this, &MainWindow::fill_recent_menu);
  QAction* loader = menu->addAction(tr("&Loader…"), this, &MainWindow::show_loader);
  loader->setObjectName("action_loader");
  loader->setShortcut(QKeySequence::New);
  menu->addSeparator();
  QAction* load = menu->addAction(tr("Load &parameters…"), this, [this] {
    const QString path = QFileDialog::getOpenFileName(this, tr("Load parameters"), folder(), tr("Parameters (*.crf)"));
    if (!path.isEmpty()) load_parameters(path);
  });
  load->setObjectName("action_load_parameters");
  QAction* save = menu->addAction(tr("Sa&ve parameters…"), this, [this] {
    const QString path = QFileDialog::getSaveFileName(this, tr("Save parameters"), folder(), tr("Parameters (*.crf)"));
    if (path.isEmpty()) return;
    try {
      save_parameter_file(workspace_, parameter_file_path(path, workspace_.document()));
    } catch (const Error& error) {
      complain(QString::fromUtf8(error.what()));
    }
  });
  save->setObjectName("action_save_parameters");
  menu->addSeparator();
  add_output_actions(*menu);
  menu->addSeparator();
  QAction* quit = menu->addAction(tr("E&xit"));
  quit->setObjectName("action_quit");
  quit->setShortcuts({QKeySequence(Qt::Key_Q), QKeySequence::Quit});
  connect(quit, &QAction::triggered, this, &QWidget::close);
}

void MainWindow::build_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  undo_ = menu->addAction(tr("&Undo"), this, [this] { workspace_.undo(); });
  undo_->setObjectName("action_undo");
  undo_->setShortcut(QKeySequence::Undo);
  redo_ = menu->addAction(tr("&Redo"), this, [this] { workspace_.redo(); });
  redo_->setObjectName("action_redo");
  redo_->setShortcuts({QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z), QKeySequence(Qt::CTRL | Qt::Key_Y)});
  menu->addSeparator();
  QAction* find = menu->addAction(tr("&Find parameter…"), this, [this] {
    rendering_dock_->show();
    rendering_dock_->raise();
    rendering_->start_search();
  });
  find->setObjectName("action_find_parameter");
  find->setShortcut(QKeySequence::Find);
  needing_document_.push_back(find);
  menu->addSeparator();
  add_copy_action(*menu);
}

void MainWindow::build_mode_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Mode"));
  modes_ = new QActionGroup(this);
  const std::array<QString, 5> names{tr("Volume and surface"), tr("Volume"), tr("Surface"), tr("X-ray"),
                                     tr("Atom balls")};
  for (int mode = 0; mode < 5; ++mode) {
    QAction* action = menu->addAction(names[static_cast<std::size_t>(mode)]);
    action->setObjectName("mode_" + QString::fromUtf8(mode_name(static_cast<Mode>(mode)).data()));
    action->setCheckable(true);
    action->setData(mode);
    action->setShortcut(QKeySequence(Qt::CTRL | static_cast<Qt::Key>(Qt::Key_1 + mode)));
    modes_->addAction(action);
  }
  connect(modes_, &QActionGroup::triggered, this, [this](const QAction* action) {
    change_view(tr("Render mode"), [action](Parameters& p) { p.mode = static_cast<Mode>(action->data().toInt()); });
  });
  menu->addSeparator();
  QAction* next = menu->addAction(tr("Next mode"), this, [this] { next_mode(); });
  next->setObjectName("action_next_mode");
  next->setShortcut(Qt::Key_D);
  QAction* previous = menu->addAction(tr("Previous mode"), this, [this] { next_mode(-1); });
  previous->setObjectName("action_previous_mode");
  previous->setShortcut(Qt::SHIFT | Qt::Key_D);
  menu->addSeparator();
  shadings_ = new QActionGroup(this);
  for (const Shading shading : {Shading::flat, Shading::smooth}) {
    QAction* action = menu->addAction(shading == Shading::flat ? tr("Flat shading") : tr("Smooth shading"));
    action->setObjectName(shading == Shading::flat ? "shading_flat" : "shading_smooth");
    action->setCheckable(true);
    action->setData(static_cast<int>(shading));
    shadings_->addAction(action);
  }
  connect(shadings_, &QActionGroup::triggered, this, [this](const QAction* action) {
    change_view(tr("Shading mode"),
                [action](Parameters& p) { p.shading = static_cast<Shading>(action->data().toInt()); });
  });
  QAction* shading = menu->addAction(tr("Other shading"), this, &MainWindow::next_shading);
  shading->setObjectName("action_next_shading");
  shading->setShortcut(Qt::Key_S);
}

void MainWindow::build_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  QAction* reset = menu->addAction(tr("&Reset orientation"), this, &MainWindow::reset_orientation);
  reset->setObjectName("action_reset");
  reset->setShortcut(Qt::Key_R);
  struct View {
    const char* name;
    QString text;
    Qt::Key key;
  };
  const std::array<View, 7> views{{{"front", tr("Front"), Qt::Key_1},
                                   {"back", tr("Back"), Qt::Key_2},
                                   {"right", tr("Right"), Qt::Key_3},
                                   {"left", tr("Left"), Qt::Key_4},
                                   {"top", tr("Top"), Qt::Key_7},
                                   {"bottom", tr("Bottom"), Qt::Key_8},
                                   {"iso", tr("Isometric"), Qt::Key_9}}};
  menu->addSeparator();
  for (const View& view : views) {
    QAction* action = menu->addAction(view.text, this, [this, name = view.name, text = view.text] {
      change_view(text, [name](Parameters& parameters) {
        set_view(parameters, name);
        parameters.roll = 0.0;
      });
    });
    action->setObjectName(QString("view_") + view.name);
    action->setShortcut(view.key);
  }
  QAction* crystal = menu->addAction(tr("Along the &crystal…"), this, [this] {
    if (crystal_view_ == nullptr) crystal_view_ = new CrystalViewDialog(workspace_, this);
    crystal_view_->show();
    crystal_view_->raise();
    crystal_view_->activateWindow();
  });
  crystal->setObjectName("action_crystal_view");
  crystal->setShortcut(Qt::Key_C);
  menu->addSeparator();
  projections_ = new QActionGroup(this);
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    QAction* action = menu->addAction(projection == Projection::perspective ? tr("Perspective") : tr("Parallel"));
    action->setObjectName(projection == Projection::perspective ? "projection_perspective" : "projection_parallel");
    action->setCheckable(true);
    action->setData(static_cast<int>(projection));
    projections_->addAction(action);
  }
  connect(projections_, &QActionGroup::triggered, this, [this](const QAction* action) {
    change_view(tr("Projection"),
                [action](Parameters& p) { p.projection = static_cast<Projection>(action->data().toInt()); });
  });
  QAction* other = menu->addAction(tr("Other projection"), this, [this] {
    change_view(tr("Projection"), [](Parameters& p) {
      p.projection = p.projection == Projection::parallel ? Projection::perspective : Projection::parallel;
    });
  });
  other->setObjectName("action_next_projection");
  other->setShortcut(Qt::Key_5);
  menu->addSeparator();
  build_view_options(*menu);
}

void MainWindow::build_view_options(QMenu& menu) {
  struct Option {
    const char* name;
    QString text;
    bool ViewOptions::*value;
  };
  const std::array<Option, 5> options{{{"legend", tr("&Legend"), &ViewOptions::legend},
                                       {"scale_bar", tr("Sc&ale bar"), &ViewOptions::scale_bar},
                                       {"tripod", tr("&Tripod of axes"), &ViewOptions::tripod},
                                       {"cut_handles", tr("&Handles of cut planes"), &ViewOptions::cut_handles},
                                       {"upright", tr("&Keep z upright when turning"), &ViewOptions::upright}}};
  for (const Option& option : options) {
    QAction* action = menu.addAction(option.text);
    action->setObjectName(QString("option_") + option.name);
    action->setCheckable(true);
    action->setChecked(workspace_.view_options().*option.value);
    connect(action, &QAction::toggled, this, [this, value = option.value](bool on) {
      ViewOptions changed = workspace_.view_options();
      changed.*value = on;
      workspace_.set_view_options(changed);
    });
    connect(&workspace_, &Workspace::view_options_changed, action,
            [this, action, value = option.value] { action->setChecked(workspace_.view_options().*value); });
  }
  QMenu* drawing = menu.addMenu(tr("Draw volume, surface and atom balls with"));
  auto* group = new QActionGroup(this);
  const std::array<std::pair<ViewOptions::Drawing, QString>, 3> who{
      {{ViewOptions::Drawing::automatic, tr("Graphics card where there is one")},
       {ViewOptions::Drawing::gpu, tr("OpenGL")},
       {ViewOptions::Drawing::cpu, tr("Processor")}}};
  for (const auto& [value, text] : who) {
    QAction* action = drawing->addAction(text);
    action->setObjectName(QString("drawing_%1").arg(static_cast<int>(value)));
    action->setCheckable(true);
    action->setChecked(workspace_.view_options().drawing == value);
    group->addAction(action);
    connect(action, &QAction::triggered, this, [this, chosen = value] {
      ViewOptions changed = workspace_.view_options();
      changed.drawing = chosen;
      workspace_.set_view_options(changed);
    });
  }
}

void MainWindow::build_window_menu() {
  docks_menu_ = menuBar()->addMenu(tr("&Window"));
  full_screen_ = docks_menu_->addAction(tr("&Full screen"), this, &MainWindow::toggle_full_screen);
  full_screen_->setObjectName("action_full_screen");
  full_screen_->setShortcuts({QKeySequence(Qt::Key_F), QKeySequence(Qt::Key_F11)});
  full_screen_->setCheckable(true);
  docks_menu_->addSeparator();
  QMenu* theme = docks_menu_->addMenu(tr("&Theme"));
  auto* themes = new QActionGroup(this);
  const std::array<std::pair<Theme, QString>, 3> choices{
      {{Theme::system, tr("As the system")}, {Theme::light, tr("Light")}, {Theme::dark, tr("Dark")}}};
  for (const auto& [value, text] : choices) {
    QAction* action = theme->addAction(text);
    action->setObjectName(QString("theme_%1").arg(static_cast<int>(value)));
    action->setCheckable(true);
    action->setChecked(chosen_theme() == value);
    themes->addAction(action);
    connect(action, &QAction::triggered, this, [chosen = value] {
      if (ThemeKeeper::instance() != nullptr) ThemeKeeper::instance()->choose(chosen);
    });
  }
  docks_menu_->addSeparator();
  for (QDockWidget* dock : docks_) docks_menu_->addAction(dock->toggleViewAction());
}

void MainWindow::build_help_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  QAction* help = menu->addAction(tr("&Help"), this, [this] { show_help({}); });
  help->setObjectName("action_help");
  help->setShortcuts({QKeySequence(Qt::Key_H), QKeySequence(QKeySequence::HelpContents)});
  QAction* controls = menu->addAction(tr("&Mouse and keys"), this, [this] { show_help("controls"); });
  controls->setObjectName("action_help_controls");
  menu->addSeparator();
  QAction* about = menu->addAction(tr("&About atomesh"), this, [this] {
    QMessageBox::about(
        this, tr("About atomesh"),
        tr("<b>%1</b><p>What is wrong inside a crystal, seen.<p>GPL-3.0 or later; with CGAL, TetGen, VTK, "
           "Embree, spglib and Qt %2.")
            .arg(QString::fromStdString(program_version()), QString::fromUtf8(qVersion())));
  });
  about->setObjectName("action_about");
}

// The menus' keys are theirs: what in a dock or page would answer to the same is found by Tab.
void MainWindow::keep_menu_keys() {
  QString taken;
  for (const QAction* menu : menuBar()->actions()) {
    const QKeySequence key = QKeySequence::mnemonic(menu->text());
    if (!key.isEmpty()) taken += QChar(key[0].key());
  }
  const auto without = [&taken](const QString& text) {
    const QKeySequence key = QKeySequence::mnemonic(text);
    return !key.isEmpty() && taken.contains(QChar(key[0].key())) ? QString(text).remove(QChar('&')) : text;
  };
  std::vector<const QWidget*> all(docks_.begin(), docks_.end());
  all.push_back(pages_);
  for (const QWidget* one : all) {
    for (QAbstractButton* button : one->findChildren<QAbstractButton*>()) {
      if (const QString text = without(button->text()); text != button->text()) button->setText(text);
    }
    for (QLabel* label : one->findChildren<QLabel*>()) {
      if (const QString text = without(label->text()); label->buddy() != nullptr && text != label->text()) {
        label->setText(text);
      }
    }
  }
}

void MainWindow::reset_orientation() {
  workspace_.reset_rotation_center();
  change_view(tr("Reset orientation"), [](Parameters& parameters) { gui::reset_orientation(parameters); });
}

void MainWindow::update_actions() {
  const ParameterHistory& history = workspace_.history();
  undo_->setEnabled(history.can_undo());
  redo_->setEnabled(history.can_redo());
  undo_->setText(history.can_undo() ? tr("&Undo %1").arg(QString::fromStdString(history.undo_name())) : tr("&Undo"));
  redo_->setText(history.can_redo() ? tr("&Redo %1").arg(QString::fromStdString(history.redo_name())) : tr("&Redo"));
  const Parameters& parameters = workspace_.parameters();
  const auto check = [](const QActionGroup* group, int value) {
    for (QAction* action : group->actions()) action->setChecked(action->data().toInt() == value);
  };
  check(modes_, static_cast<int>(parameters.mode));
  check(shadings_, static_cast<int>(parameters.shading));
  check(projections_, static_cast<int>(parameters.projection));
  for (QAction* action : needing_document_) action->setEnabled(workspace_.document().has_value());
}

}  // namespace atomesh::gui
