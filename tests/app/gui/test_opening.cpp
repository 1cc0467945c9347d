// From a file's name to what the window shows, whatever kind of file it is and from wherever it was named.
#include <gtest/gtest.h>

#include <QAction>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QStackedWidget>
#include <QTest>
#include <filesystem>
#include <fstream>

#include "app/gui/loader_page.h"
#include "app/gui/main_window.h"
#include "app/gui/preprocessing_page.h"
#include "app/gui/viewport.h"
#include "core/parameter_file.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/window_test.h"
#include "tests/app/program.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

class OpeningInWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_opengl()) GTEST_SKIP() << "no display with OpenGL";
    QSettings().clear();
    window = std::make_unique<MainWindow>();
    window->resize(1000, 760);
    test::show(*window);
  }
  QString path(const std::string& name) const { return QString::fromStdString(folder.file(name)); }
  QWidget* page() const { return child<QStackedWidget>(*window, "pages").currentWidget(); }
  bool shows(const QString& file) {
    return wait_for([&] {
      const auto& document = window->workspace().document();
      return document && QString::fromStdString(document->path) == file && page() == &window->viewport();
    });
  }
  LoaderPage& loader() { return child<LoaderPage>(*window, "loader"); }
  QLabel& problem() { return child<QLabel>(*window, "loader_problem"); }

  test::TemporaryFolder folder;
  std::string dat = test::cracked_salt_dat(folder.path().string());
  std::unique_ptr<MainWindow> window;
};

TEST_F(OpeningInWindow, StartsWithTheLoaderAndGoesThroughPreprocessing) {
  window->start({}, {});
  EXPECT_EQ(page(), &loader());
  test::keep_screenshot(window->grab().toImage(), "window-loader");
  QTest::keyClicks(&child<QLineEdit>(*window, "file"), path("salt.dat"));
  auto& go = child<QPushButton>(*window, "go");
  ASSERT_TRUE(wait_for([&] { return go.isEnabled(); }));
  QTest::mouseClick(&go, Qt::LeftButton);
  ASSERT_TRUE(shows(path("salt.dat")));
  const Document& document = *window->workspace().document();
  EXPECT_EQ(document.kind, FileKind::atoms);
  EXPECT_TRUE(document.pipeline);
  EXPECT_TRUE(std::filesystem::exists(folder.file("salt.crb")));
  EXPECT_EQ(loader().recent_files().files(), (QStringList{path("salt.crb"), path("salt.dat")}));
  EXPECT_EQ(window->windowTitle(), "salt.dat – atomesh");
}

TEST_F(OpeningInWindow, AFileWithACrfGoesStraightOn) {
  test::cracked_salt_crb(folder.path().string());
  Parameters parameters;
  parameters.mode = Mode::xray;
  parameters.zoom = 1.75;
  write_crf(folder.file("v.crf"), parameters);
  window->start(path("salt.crb"), path("v.crf"));
  ASSERT_TRUE(shows(path("salt.crb")));
  EXPECT_EQ(window->workspace().parameters().mode, Mode::xray);
  EXPECT_EQ(window->workspace().parameters().zoom, 1.75);
  EXPECT_EQ(loader().recent_parameters().files(), QStringList{path("v.crf")});
  // A .crf by itself goes over the defaults, as on the command line, and can be undone.
  std::ofstream(folder.file("w.crf")) << "mode = \"atoms\"\n";
  window->load_parameters(path("w.crf"));
  ASSERT_TRUE(wait_for([&] { return window->workspace().parameters().mode == Mode::atoms; }));
  EXPECT_EQ(window->workspace().parameters().zoom, 1.0);
  child<QAction>(*window, "action_undo").trigger();
  EXPECT_EQ(window->workspace().parameters().mode, Mode::xray);
  EXPECT_EQ(window->workspace().parameters().zoom, 1.75);
}

TEST_F(OpeningInWindow, FailuresAreSaidWhereTheUserLooks) {
  window->start(path("broken.crb"), {});
  ASSERT_TRUE(wait_for([&] { return problem().isVisible(); }));
  EXPECT_EQ(page(), &loader());
  EXPECT_TRUE(problem().text().contains("broken.crb"));
  test::keep_screenshot(window->grab().toImage(), "window-loader-problem");
  test::cracked_salt_crb(folder.path().string());
  std::ofstream(folder.file("bad.crf")) << "moed = \"atoms\"\n";
  window->start(path("salt.crb"), path("bad.crf"));
  ASSERT_TRUE(wait_for([&] { return problem().text().contains("bad.crf"); }));
  EXPECT_EQ(loader().file(), path("salt.crb"));
  EXPECT_FALSE(window->workspace().document());
  // With something open, it stays and a message says it.
  window->open(path("salt.crb"));
  ASSERT_TRUE(shows(path("salt.crb")));
  window->load_parameters(path("bad.crf"));
  ASSERT_TRUE(wait_for([&] { return window->findChild<QMessageBox*>("complaint") != nullptr; }));
  EXPECT_TRUE(child<QMessageBox>(*window, "complaint").text().contains("mode"));
  child<QMessageBox>(*window, "complaint").accept();
  EXPECT_EQ(page(), &window->viewport());
}

TEST_F(OpeningInWindow, TheLoaderGoesBackToWhatIsOpen) {
  test::cracked_salt_crb(folder.path().string());
  window->open(path("salt.crb"));
  ASSERT_TRUE(shows(path("salt.crb")));
  child<QAction>(*window, "action_loader").trigger();
  EXPECT_EQ(page(), &loader());
  QTest::mouseClick(&child<QPushButton>(*window, "cancel"), Qt::LeftButton);
  EXPECT_EQ(page(), &window->viewport());
}

TEST_F(OpeningInWindow, APictureBringsBackItsView) {
  const atomesh::testing::Workplace place;
  ASSERT_EQ(place.run({"sample", "nacl-cracked", "--atoms", "1800", "-o", "n.dat"}).exit_code, 0);
  ASSERT_EQ(place.run({"preprocess", "n.dat", "-o", "n.crb"}).exit_code, 0);
  ASSERT_EQ(
      place.run({"render", "n.crb", "-o", "n.png", "--mode", "xray", "--set", "view.zoom=2.5", "--legend"}).exit_code,
      0);
  const auto file = [&](const char* name) { return QString::fromStdString(place.path(name).string()); };
  // What lies over the view is as in the picture too; the rest of the view's options is nobody else's.
  const auto all_on = [&] { window->workspace().set_view_options({.cut_handles = false}); };
  const ViewOptions as_in_the_picture{.legend = true, .scale_bar = false, .tripod = false, .cut_handles = false};
  all_on();
  window->open(file("n.png"));
  ASSERT_TRUE(shows(file("n.crb")));
  EXPECT_EQ(window->workspace().view_options(), as_in_the_picture);
  EXPECT_TRUE(child<QAction>(*window, "option_legend").isChecked());
  EXPECT_FALSE(child<QAction>(*window, "option_tripod").isChecked());
  EXPECT_EQ(window->workspace().parameters().mode, Mode::xray);
  EXPECT_EQ(window->workspace().parameters().zoom, 2.5);
  // Over what is open only the view changes.
  const QSignalSpy others(&window->workspace(), &Workspace::document_changed);
  window->workspace().set("view.zoom", "1");
  all_on();
  window->open(file("n.png"));
  ASSERT_TRUE(wait_for([&] { return window->workspace().parameters().zoom == 2.5; }));
  EXPECT_EQ(others.size(), 0);
  EXPECT_EQ(window->workspace().view_options(), as_in_the_picture);
  // It is one step, of which undoing brings back all.
  auto& undo = child<QAction>(*window, "action_undo");
  EXPECT_TRUE(undo.text().contains("View of n.png")) << undo.text().toStdString();
  undo.trigger();
  EXPECT_EQ(window->workspace().parameters().zoom, 1.0);
  EXPECT_EQ(window->workspace().view_options(), ViewOptions{.cut_handles = false});
  EXPECT_TRUE(child<QAction>(*window, "option_tripod").isChecked());
  child<QAction>(*window, "action_redo").trigger();
  EXPECT_EQ(window->workspace().parameters().zoom, 2.5);
  EXPECT_EQ(window->workspace().view_options(), as_in_the_picture);

  // Without the material, from the atoms with the picture's settings.
  window->workspace().close_document();
  all_on();
  std::filesystem::remove(place.path("n.crb"));
  window->open(file("n.png"));
  ASSERT_TRUE(shows(file("n.dat")));
  EXPECT_EQ(window->workspace().parameters().zoom, 2.5);
  EXPECT_EQ(window->workspace().view_options(), as_in_the_picture);
  // Other files leave it as it is.
  all_on();
  window->open(file("n.dat"));
  ASSERT_TRUE(wait_for([&] { return window->workspace().parameters().zoom == 1.0; }));
  EXPECT_EQ(window->workspace().view_options(), ViewOptions{.cut_handles = false});

  window->workspace().close_document();
  std::filesystem::remove(place.path("n.dat"));
  std::filesystem::remove(place.path("n.crb"));
  window->open(file("n.png"));
  ASSERT_TRUE(wait_for([&] { return problem().isVisible() && problem().text().contains("n.crb"); }));
}

// As the button, whatever of the page has the focus.
TEST_F(OpeningInWindow, EscapeCancelsPreprocessing) {
  // Enough that it is not done before.
  const Sample sample = make_sample("nacl-cracked", {.atoms = 100000});
  write_atoms(folder.file("large.dat"), sample.atoms, sample.unit_cell);
  auto& page_of_it = child<PreprocessingPage>(*window, "preprocessing");
  window->activateWindow();
  ASSERT_TRUE(wait_for([&] { return window->isActiveWindow(); }));
  for (const char* name : {"preprocessing_cancel", "stages", "preprocessing_log", "automatic"}) {
    window->open(path("large.dat"));
    ASSERT_TRUE(wait_for([&] { return page_of_it.run().state() == Preprocessing::State::running; }));
    EXPECT_EQ(page(), &page_of_it);
    EXPECT_EQ(QApplication::focusWidget(), &child<QPushButton>(page_of_it, "preprocessing_cancel"));
    auto& focus = child<QWidget>(page_of_it, name);
    focus.setFocus();
    ASSERT_EQ(QApplication::focusWidget(), &focus);
    QTest::keyClick(&focus, Qt::Key_Escape);
    ASSERT_TRUE(wait_for([&] { return page_of_it.run().state() != Preprocessing::State::running; }));
    EXPECT_EQ(page_of_it.run().state(), Preprocessing::State::cancelled) << name;
    EXPECT_TRUE(child<QLabel>(page_of_it, "preprocessing_status").text().contains("Cancelled")) << name;
    EXPECT_EQ(page(), &page_of_it);
    EXPECT_FALSE(std::filesystem::exists(folder.file("large.crb")));
    // Now there is nothing to be cancelled.
    QTest::keyClick(&page_of_it, Qt::Key_Escape);
    EXPECT_EQ(page(), &page_of_it);
  }
}

TEST_F(OpeningInWindow, PreprocessingUnaskedReplacesNothing) {
  folder.file("salt.crb", "mine");
  window->open(path("salt.dat"));
  ASSERT_TRUE(shows(path("salt.dat")));
  EXPECT_EQ(test::read_bytes(folder.file("salt.crb")), "mine");
}

}  // namespace
