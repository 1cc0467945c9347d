// Every entry of the menus and every shortcut: each is clicked, and its keys are pressed, and what it is for is done.
#include <QAction>
#include <QClipboard>
#include <QDockWidget>
#include <QFileDialog>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QShortcut>
#include <QSpinBox>
#include <QStackedWidget>
#include <QTimer>
#include <QTreeWidget>
#include <map>
#include <set>

#include "app/gui/crystal_view_dialog.h"
#include "app/gui/help_window.h"
#include "app/gui/loader_page.h"
#include "app/gui/movie_dialog.h"
#include "app/gui/save_picture_dialog.h"
#include "app/gui/theme.h"
#include "core/parameter_file.h"
#include "tests/app/gui/window_fixture.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

using Act = std::function<void()>;              // clicks the entry, or presses one of its keys
using Check = std::function<void(const Act&)>;  // that it does what it is for

class WindowActions : public test::WindowFixture {
 protected:
  void SetUp() override {
    WindowFixture::SetUp();
    if (IsSkipped()) return;
    open_salt();
    add_files();
    add_changes();
    add_modes();
    add_views();
    add_view_options();
    add_windows();
    add_help();
  }

  Workspace& workspace() { return window->workspace(); }
  const Parameters& now() { return window->workspace().parameters(); }
  QWidget* page() { return child<QStackedWidget>(*window, "pages").currentWidget(); }
  QAction& action(const QString& name) { return child<QAction>(*window, name); }
  void set(const std::string& key, const std::string& value) { workspace().set(key, value); }

  // As after opening.
  void start_over() {
    window->show_view();
    workspace().change(Parameters(), "As at first");
    workspace().set_view_options({});
    window->activateWindow();
    ASSERT_TRUE(wait_for([&] { return window->isActiveWindow(); }));
  }

  // Entries without what has entries of its own; "Open recent" is filled when it opens.
  static void collect(QMenu& menu, std::vector<QMenu*> way, std::map<QAction*, std::vector<QMenu*>>& entries) {
    way.push_back(&menu);
    for (QAction* entry : menu.actions()) {
      if (entry->isSeparator() || entry->objectName() == "menu_recent") continue;
      if (entry->menu() == nullptr) {
        entries[entry] = way;
      } else if (entry->menu()->objectName() != "menu_recent") {
        collect(*entry->menu(), way, entries);
      }
    }
  }
  // And the menus on the way to each.
  std::map<QAction*, std::vector<QMenu*>> entries() {
    std::map<QAction*, std::vector<QMenu*>> found;
    for (QAction* top : window->menuBar()->actions()) collect(*top->menu(), {}, found);
    return found;
  }
  void click(const std::vector<QMenu*>& way, QAction* entry) {
    QMenuBar& bar = *window->menuBar();
    QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.actionGeometry(way.front()->menuAction()).center());
    for (std::size_t i = 0; i < way.size(); ++i) {
      ASSERT_TRUE(wait_for([&] { return way[i]->isVisible(); }));
      QAction* const next = i + 1 < way.size() ? way[i + 1]->menuAction() : entry;
      EXPECT_TRUE(next->isEnabled());
      way[i]->setActiveAction(next);
      QTest::keyClick(way[i], next == entry ? Qt::Key_Return : Qt::Key_Right);
    }
    EXPECT_TRUE(wait_for([&] { return !way.front()->isVisible(); }));
  }
  void press_keys(const QKeySequence& keys) {
    ASSERT_EQ(keys.count(), 1);
    press(keys[0].key(), keys[0].keyboardModifiers());
  }

  // For what asks in an event loop of its own: `answer` is tried until it has found whom to answer.
  static void answering(const std::function<bool()>& answer, const Act& act) {
    bool answered = false;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] { answered = answered || answer(); });
    timer.start(5);
    act();
    EXPECT_TRUE(wait_for([&] { return answered; }));
  }
  static void choosing(const std::string& file, const Act& act) {
    answering(
        [&] {
          auto* const dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
          if (dialog == nullptr || !dialog->isVisible()) return false;
          auto& name = child<QLineEdit>(*dialog, "fileNameEdit");
          name.setText(QString::fromStdString(file));
          QTest::keyClick(&name, Qt::Key_Return);
          return true;
        },
        act);
  }
  // That a window comes, to be used without the mouse.
  template <class Dialog>
  void comes(const Act& act) {
    act();
    const auto shown = [&] {
      auto* const dialog = window->findChild<Dialog*>();
      return dialog != nullptr && dialog->isVisible() && dialog->isActiveWindow() && dialog->focusWidget() != nullptr;
    };
    EXPECT_TRUE(wait_for(shown));
    window->findChild<Dialog*>()->close();
  }

  void add_files() {
    checks["action_open"] = [this](const Act& act) {
      std::filesystem::copy_file(folder.file("salt.crb"), folder.file("other.crb"),
                                 std::filesystem::copy_options::overwrite_existing);
      choosing(folder.file("other.crb"), act);
      EXPECT_TRUE(wait_for([&] { return workspace().document()->path == folder.file("other.crb"); }));
      window->open(QString::fromStdString(folder.file("salt.crb")));
      EXPECT_TRUE(wait_for([&] { return workspace().document()->path == folder.file("salt.crb"); }));
    };
    checks["action_loader"] = [this](const Act& act) {
      act();
      EXPECT_EQ(page(), window->findChild<LoaderPage*>());
    };
    checks["action_load_parameters"] = [this](const Act& act) {
      Parameters parameters;
      parameters.mode = Mode::xray;
      parameters.zoom = 1.75;
      write_crf(folder.file("view.crf"), parameters);
      choosing(folder.file("view.crf"), act);
      EXPECT_TRUE(wait_for([&] { return now() == parameters; }));
    };
    checks["action_save_parameters"] = [this](const Act& act) {
      set("view.zoom", "2.25");
      choosing(folder.file("kept.crf"), act);
      EXPECT_EQ(read_crf(folder.file("kept.crf")), now());
      std::filesystem::remove(folder.file("kept.crf"));
    };
    checks["action_save_picture"] = [this](const Act& act) { comes<SavePictureDialog>(act); };
    checks["action_movie"] = [this](const Act& act) { comes<MovieDialog>(act); };
    checks["action_quit"] = [this](const Act& act) {
      act();
      EXPECT_TRUE(wait_for([&] { return !window->isVisible(); }));
      test::show(*window);
    };
  }

  void add_changes() {
    checks["action_undo"] = [this](const Act& act) {
      set("view.zoom", "3");
      act();
      EXPECT_EQ(now().zoom, 1.0);
    };
    checks["action_redo"] = [this](const Act& act) {
      set("view.zoom", "3");
      workspace().undo();
      act();
      EXPECT_EQ(now().zoom, 3.0);
    };
    checks["action_find_parameter"] = [this](const Act& act) {
      child<QDockWidget>(*window, "rendering_parameters_dock").hide();
      act();
      EXPECT_TRUE(wait_for([&] { return child<QLineEdit>(*window, "parameter_search").hasFocus(); }));
    };
    checks["action_copy_picture"] = [this](const Act& act) {
      QApplication::clipboard()->clear();
      act();
      EXPECT_TRUE(wait_for([&] {
        return QApplication::clipboard()->image().size() == QSize(workspace().width(), workspace().height());
      }));
    };
  }

  void add_modes() {
    for (const Mode mode : test::all_modes) {
      const std::string name = "mode_" + std::string(mode_name(mode));
      checks[name] = [this, mode, name](const Act& act) {
        set("mode", mode == Mode::volume ? "surface" : "volume");
        EXPECT_FALSE(action(name.c_str()).isChecked());
        act();
        EXPECT_EQ(now().mode, mode);
        EXPECT_TRUE(action(name.c_str()).isChecked());
      };
    }
    checks["action_next_mode"] = [this](const Act& act) {
      for (int mode = 1; mode <= 5; ++mode) {
        act();
        EXPECT_EQ(now().mode, test::all_modes[static_cast<std::size_t>(mode % 5)]);
      }
    };
    checks["action_previous_mode"] = [this](const Act& act) {
      for (int mode = 4; mode >= 0; --mode) {
        act();
        EXPECT_EQ(now().mode, test::all_modes[static_cast<std::size_t>(mode)]);
      }
    };
    for (const auto& [name, shading] :
         {std::pair("shading_flat", Shading::flat), {"shading_smooth", Shading::smooth}}) {
      checks[name] = [this, name, shading](const Act& act) {
        set("shading", shading == Shading::flat ? "smooth" : "flat");
        act();
        EXPECT_EQ(now().shading, shading);
        EXPECT_TRUE(action(name).isChecked());
      };
    }
    checks["action_next_shading"] = [this](const Act& act) {
      const Shading before = now().shading;
      act();
      EXPECT_NE(now().shading, before);
      act();
      EXPECT_EQ(now().shading, before);
    };
  }

  void add_views() {
    checks["action_reset"] = [this](const Act& act) {
      set("view.azimuth", "77");
      set("view.roll", "20");
      set("view.zoom", "3");
      set("view.pan", "0.1,0.2,0");
      workspace().set_rotation_center(workspace().bounds().min);
      act();
      EXPECT_EQ(now(), Parameters());
      EXPECT_EQ(workspace().rotation_center(), workspace().bounds().center());
    };
    const double tilt = 20.0 * std::numbers::pi / 180.0;
    const double turn = 30.0 * std::numbers::pi / 180.0;
    const std::map<std::string, Vec3> forward{
        {"front", {0, 1, 0}},
        {"back", {0, -1, 0}},
        {"right", {-1, 0, 0}},
        {"left", {1, 0, 0}},
        {"top", {0, 0, -1}},
        {"bottom", {0, 0, 1}},
        {"iso", {-std::sin(turn) * std::cos(tilt), std::cos(turn) * std::cos(tilt), -std::sin(tilt)}}};
    for (const auto& [name, expected] : forward) {
      checks["view_" + name] = [this, direction = expected](const Act& act) {
        set("view.azimuth", "77");
        set("view.elevation", "-33");
        set("view.roll", "20");
        set("view.zoom", "3");
        act();
        EXPECT_NEAR(glm::length(workspace().camera().forward - direction), 0.0, 1e-12);
        EXPECT_EQ(now().roll, 0.0);
        EXPECT_EQ(now().zoom, 3.0);
      };
    }
    checks["action_crystal_view"] = [this](const Act& act) { comes<CrystalViewDialog>(act); };
    for (const auto& [name, projection] : {std::pair("projection_parallel", Projection::parallel),
                                           {"projection_perspective", Projection::perspective}}) {
      checks[name] = [this, name, projection](const Act& act) {
        set("view.projection", projection == Projection::parallel ? "perspective" : "parallel");
        act();
        EXPECT_EQ(now().projection, projection);
        EXPECT_TRUE(action(name).isChecked());
      };
    }
    checks["action_next_projection"] = [this](const Act& act) {
      const Projection before = now().projection;
      act();
      EXPECT_NE(now().projection, before);
      act();
      EXPECT_EQ(now().projection, before);
    };
  }

  void add_view_options() {
    const std::map<std::string, bool ViewOptions::*> options{{"option_legend", &ViewOptions::legend},
                                                             {"option_scale_bar", &ViewOptions::scale_bar},
                                                             {"option_tripod", &ViewOptions::tripod},
                                                             {"option_cut_handles", &ViewOptions::cut_handles},
                                                             {"option_upright", &ViewOptions::upright}};
    for (const auto& [name, option] : options) {
      checks[name] = [this, option = option](const Act& act) {
        const ViewOptions before = workspace().view_options();
        act();
        EXPECT_NE(workspace().view_options().*option, before.*option);
        act();
        EXPECT_EQ(workspace().view_options(), before);
      };
    }
    using Drawing = ViewOptions::Drawing;
    for (const Drawing drawing : {Drawing::automatic, Drawing::gpu, Drawing::cpu}) {
      checks["drawing_" + std::to_string(static_cast<int>(drawing))] = [this, drawing](const Act& act) {
        workspace().set_view_options({.drawing = drawing == Drawing::cpu ? Drawing::automatic : Drawing::cpu});
        set("mode", "surface");
        act();
        EXPECT_EQ(workspace().view_options().drawing, drawing);
        EXPECT_TRUE(wait_for([&] { return window->viewport().settled(); }));
        if (drawing == Drawing::automatic) return;  // as the machine is
        EXPECT_EQ(window->viewport().drawn_by_gpu(), drawing == Drawing::gpu);
      };
    }
  }

  void add_windows() {
    checks["action_full_screen"] = [this](const Act& act) {
      QAction& full = action("action_full_screen");
      act();
      EXPECT_TRUE(wait_for([&] { return window->isFullScreen() && full.isChecked(); }));
      window->toggle_full_screen();  // as the button of the display options
      EXPECT_TRUE(wait_for([&] { return !window->isFullScreen() && !full.isChecked(); }));
    };
    for (const Theme theme : {Theme::system, Theme::light, Theme::dark}) {
      checks["theme_" + std::to_string(static_cast<int>(theme))] = [theme](const Act& act) {
        ThemeKeeper keeper;
        keeper.choose(theme == Theme::light ? Theme::dark : Theme::light);
        act();
        EXPECT_EQ(keeper.theme(), theme);
        EXPECT_EQ(is_dark(QApplication::palette()), theme == Theme::dark);
        keeper.choose(Theme::system);
      };
    }
    for (const char* name : {"material_panel", "defect_dock", "pick_panel", "display_options", "rendering_parameters",
                             "color_map_editor", "log_panel", "timing_panel"}) {
      checks[std::string("show_") + name] = [this, name](const Act& act) {
        const auto& dock = child<QDockWidget>(*window, QString(name) + "_dock");
        const bool hidden = dock.isHidden();
        act();
        EXPECT_EQ(dock.isHidden(), !hidden);
        act();
        EXPECT_EQ(dock.isHidden(), hidden);
      };
    }
  }

  void shows_help(const QString& topic, const Act& act) {
    act();
    const auto shown = [&] {
      const auto* help = window->findChild<HelpWindow*>();
      return help != nullptr && help->isVisible() && (topic.isEmpty() || help->page() == topic);
    };
    EXPECT_TRUE(wait_for(shown));
    window->findChild<HelpWindow*>()->close();
  }
  void add_help() {
    checks["action_help"] = [this](const Act& act) { shows_help({}, act); };
    checks["action_help_controls"] = [this](const Act& act) { shows_help("controls", act); };
    checks["action_about"] = [](const Act& act) {
      QString said;
      answering(
          [&] {
            auto* const box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
            if (box == nullptr) return false;
            said = box->text();
            box->accept();
            return true;
          },
          act);
      EXPECT_TRUE(said.contains("atomesh") && said.contains("GPL-3.0")) << said.toStdString();
    };
  }

  std::map<std::string, Check> checks;  // by the action's name
};

TEST_F(WindowActions, EachDoesWhatItIsForByMenuAndByKey) {
  std::set<std::string> done;
  for (const auto& [entry, way] : entries()) {
    const std::string name = entry->objectName().toStdString();
    const std::string text = entry->text().toStdString();
    const auto check = checks.find(name);
    if (check == checks.end()) {
      ADD_FAILURE() << "no check of the menu entry \"" << text << "\", " << name;
      continue;
    }
    EXPECT_TRUE(done.insert(name).second) << name;
    {
      const testing::ScopedTrace trace(__FILE__, __LINE__, "menu entry " + text);
      start_over();
      check->second([&] { click(way, entry); });
    }
    for (const QKeySequence& keys : entry->shortcuts()) {
      const testing::ScopedTrace trace(__FILE__, __LINE__, name + " by " + keys.toString().toStdString());
      start_over();
      check->second([&] { press_keys(keys); });
    }
  }
  EXPECT_EQ(done.size(), checks.size());
}

// Keys that no menu shows nobody would find, and none would be tested above.
TEST_F(WindowActions, EveryShortcutOfTheWindowIsInAMenu) {
  const auto in_menus = entries();
  for (QAction* each : window->findChildren<QAction*>()) {
    if (each->shortcuts().isEmpty() || each->shortcutContext() != Qt::WindowShortcut) continue;
    EXPECT_TRUE(in_menus.contains(each)) << each->text().toStdString();
  }
  EXPECT_TRUE(window->findChildren<QShortcut*>().isEmpty());
}

TEST_F(WindowActions, TheHelpOnKeysNamesEveryShortcut) {
  QFile file(QString(ATOMESH_SOURCE_DIR) + "/app/gui/help/controls.md");
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  QStringList said;
  for (const QString& line : QString::fromUtf8(file.readAll()).section("## Keys", 1).split('\n')) {
    if (line.startsWith("| ")) said += line.section(" | ", 0, 0).mid(2).remove('`').split(", ");
  }
  QStringList expected{"key", "---", "arrows", "+", "-", "Page Up", "Page Down", "Escape"};  // the view's own
  for (const auto& [entry, way] : entries()) {
    for (const QKeySequence& keys : entry->shortcuts()) {
      // "Ctrl+Shift+Z" as "Ctrl + Shift + Z", the letter alone as "d".
      QStringList parts = keys.toString().split('+');
      if (!parts.contains("Ctrl") && parts.back().size() == 1) parts.back() = parts.back().toLower();
      expected << parts.join(" + ");
    }
  }
  said.sort();
  expected.sort();
  EXPECT_EQ(said, expected) << said.join(", ").toStdString() << "\n" << expected.join(", ").toStdString();
}

TEST_F(WindowActions, LettersOfAMenuAreEachForOneEntry) {
  std::map<const QMenu*, std::map<QKeySequence, QString>> letters;
  for (const auto& [entry, way] : entries()) {
    const QKeySequence letter = QKeySequence::mnemonic(entry->text());
    if (letter.isEmpty()) continue;
    const auto [other, free] = letters[way.back()].emplace(letter, entry->text());
    EXPECT_TRUE(free) << entry->text().toStdString() << " and " << other->second.toStdString();
  }
}

TEST_F(WindowActions, RecentFilesOpenAgain) {
  std::filesystem::copy_file(folder.file("salt.crb"), folder.file("other.crb"));
  window->open(QString::fromStdString(folder.file("other.crb")));
  ASSERT_TRUE(wait_for([&] { return workspace().document()->path == folder.file("other.crb"); }));
  std::filesystem::remove(folder.file("other.crb"));
  auto& recent = child<QMenu>(*window, "menu_recent");
  auto* const file_menu = window->menuBar()->actions().front()->menu();
  const auto entry = [&](const char* name) {
    emit recent.aboutToShow();
    for (QAction* each : recent.actions()) {
      if (each->text() == name) return each;
    }
    throw std::runtime_error(std::string("not a recent file: ") + name);
  };
  EXPECT_TRUE(wait_for([&] { return !entry("other.crb")->isEnabled(); }));  // it is gone
  QMenuBar& bar = *window->menuBar();
  QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.actionGeometry(file_menu->menuAction()).center());
  file_menu->setActiveAction(recent.menuAction());
  QTest::keyClick(file_menu, Qt::Key_Right);
  ASSERT_TRUE(wait_for([&] { return recent.isVisible(); }));
  recent.setActiveAction(entry("salt.crb"));
  QTest::keyClick(&recent, Qt::Key_Return);
  EXPECT_TRUE(wait_for([&] { return workspace().document()->path == folder.file("salt.crb"); }));
}

// Where text is shown that can be copied, the key copies that.
TEST_F(WindowActions, CopyIsOfWhatHasTheFocus) {
  auto& facts = child<QTreeWidget>(*window, "material_facts");
  start_over();
  facts.setFocus();
  QTest::keyClick(&facts, Qt::Key_C, Qt::ControlModifier);
  EXPECT_TRUE(QApplication::clipboard()->text().contains("salt.crb"));
}

// Before anything is open there is nothing to save, to copy or to look for.
using EmptyWindow = test::WindowFixture;
TEST_F(EmptyWindow, WithoutASampleEntriesThatNeedOneAreOff) {
  const auto enabled = [&](const char* name) { return child<QAction>(*window, name).isEnabled(); };
  for (const char* name : {"action_save_picture", "action_movie", "action_copy_picture", "action_find_parameter"}) {
    EXPECT_FALSE(enabled(name)) << name;
  }
  EXPECT_TRUE(enabled("action_open"));
  open_salt();
  for (const char* name : {"action_save_picture", "action_movie", "action_copy_picture", "action_find_parameter"}) {
    EXPECT_TRUE(enabled(name)) << name;
  }
}

}  // namespace
