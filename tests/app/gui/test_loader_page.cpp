// The loader and the preprocessing page as a person uses them: what is asked for which file, buttons, messages.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDropEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTest>
#include <QToolButton>
#include <QUrl>
#include <filesystem>

#include "app/gui/drop_target.h"
#include "app/gui/loader_page.h"
#include "app/gui/pipeline_form.h"
#include "app/gui/preprocessing_page.h"
#include "core/parameter_file.h"
#include "tests/app/gui/window_test.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

class Pages : public ::testing::Test {
 protected:
  QString settings() const { return QString::fromStdString(folder.file("settings.ini")); }
  QString path(const std::string& name) const { return QString::fromStdString(folder.file(name)); }
  bool known(const LoaderPage& loader) {
    return wait_for([&] { return loader.summary().has_value(); });
  }

  test::TemporaryFolder folder;
  std::string dat = test::cracked_salt_dat(folder.path().string());
};

TEST_F(Pages, AFileOfAtomsIsAskedForItsOutputFormat) {
  LoaderPage loader(nullptr, settings());
  loader.resize(900, 700);
  test::show(loader);
  auto& go = child<QPushButton>(loader, "go");
  EXPECT_FALSE(go.isEnabled());
  EXPECT_FALSE(child<QWidget>(loader, "output_box").isVisible());
  QTest::keyClicks(&child<QLineEdit>(loader, "file"), path("salt.dat"));
  ASSERT_TRUE(known(loader));
  EXPECT_TRUE(child<QLabel>(loader, "kind").text().startsWith("Atoms (.dat)"));
  EXPECT_TRUE(child<QWidget>(loader, "output_box").isVisible());
  EXPECT_EQ(go.text().remove('&'), "Preprocess");
  EXPECT_TRUE(go.isEnabled());
  test::keep_screenshot(loader.grab().toImage(), "loader-atoms");

  QSignalSpy asked(&loader, &LoaderPage::preprocess_requested);
  auto& format = child<QComboBox>(loader, "format");
  for (const OutputFormat chosen : {OutputFormat::binary, OutputFormat::text, OutputFormat::both, OutputFormat::none}) {
    format.setCurrentIndex(format.findData(static_cast<int>(chosen)));
    QTest::mouseClick(&go, Qt::LeftButton);
    ASSERT_EQ(asked.size(), 1);
    const auto request = asked.takeFirst()[0].value<PreprocessingRequest>();
    EXPECT_EQ(request.input, dat);
    EXPECT_EQ(request.format, chosen);
    EXPECT_TRUE(request.replace);
  }
  format.setCurrentIndex(format.findData(static_cast<int>(OutputFormat::text)));
  EXPECT_EQ(LoaderPage(nullptr, settings()).unasked_request(path("salt.dat")).format, OutputFormat::text);

  // Enter in the field is the button.
  QTest::keyClick(&child<QLineEdit>(loader, "file"), Qt::Key_Return);
  EXPECT_EQ(asked.size(), 1);
}

TEST_F(Pages, AMaterialOpensAtOnceWithItsParameters) {
  const std::string crb = test::cracked_salt_crb(folder.path().string());
  write_crf(folder.file("view.crf"), {});
  LoaderPage loader(nullptr, settings());
  test::show(loader);
  loader.set_file(QString::fromStdString(crb));
  ASSERT_TRUE(known(loader));
  auto& go = child<QPushButton>(loader, "go");
  EXPECT_EQ(go.text().remove('&'), "Open");
  EXPECT_FALSE(child<QWidget>(loader, "output_box").isVisible());
  EXPECT_TRUE(child<QLabel>(loader, "kind").text().contains("tetrahedra"));
  QSignalSpy opened(&loader, &LoaderPage::open_requested);
  QTest::mouseClick(&go, Qt::LeftButton);
  ASSERT_EQ(opened.size(), 1);
  EXPECT_EQ(opened[0][0].toString().toStdString(), crb);
  EXPECT_EQ(opened[0][1].toString(), "");
  loader.set_parameters_file(path("view.crf"));
  QTest::mouseClick(&go, Qt::LeftButton);
  ASSERT_EQ(opened.size(), 2);
  EXPECT_EQ(opened[1][1].toString(), path("view.crf"));
  loader.set_parameters_file(path("nothing.crf"));
  QTest::mouseClick(&go, Qt::LeftButton);
  EXPECT_EQ(opened.size(), 2);
  EXPECT_TRUE(child<QLabel>(loader, "loader_problem").isVisible());
  EXPECT_TRUE(child<QLabel>(loader, "loader_problem").text().contains("nothing.crf"));
  test::keep_screenshot(loader.grab().toImage(), "loader-material");
}

TEST_F(Pages, WhatCannotBeOpenedCannotBeAskedFor) {
  LoaderPage loader(nullptr, settings());
  test::show(loader);
  for (const std::string& name : {folder.file("none.dat"), folder.path().string(), folder.file("empty.xyz", "")}) {
    loader.set_file(QString::fromStdString(name));
    ASSERT_TRUE(known(loader));
    EXPECT_FALSE(child<QPushButton>(loader, "go").isEnabled()) << name;
    EXPECT_TRUE(child<QLabel>(loader, "kind").text().contains(QString::fromStdString(name)));
  }
  loader.set_file(path("salt.dat"));
  ASSERT_TRUE(known(loader));
  child<QLineEdit>(loader, "output").setText("/no/such/folder/x");
  EXPECT_FALSE(child<QPushButton>(loader, "go").isEnabled());
  EXPECT_TRUE(child<QLabel>(loader, "output_note").text().contains("/no/such/folder"));
  child<QLineEdit>(loader, "output").setText("");
  folder.file("salt.crb", "x");
  child<QComboBox>(loader, "format").setCurrentIndex(2);
  EXPECT_TRUE(child<QLabel>(loader, "output_note").text().contains("salt.crb is there already"));
  EXPECT_TRUE(child<QPushButton>(loader, "go").isEnabled());
}

TEST_F(Pages, SettingsOfPreprocessingAreThoseOfTheCommandLine) {
  LoaderPage loader(nullptr, settings());
  loader.resize(900, 900);
  test::show(loader);
  loader.set_file(path("salt.dat"));
  ASSERT_TRUE(known(loader));
  auto& table = child<QWidget>(loader, "settings_table");
  EXPECT_FALSE(table.isVisible());
  QTest::mouseClick(&child<QToolButton>(loader, "settings_opener"), Qt::LeftButton);
  EXPECT_TRUE(table.isVisible());
  for (const PipelineSetting& setting : pipeline_settings()) {
    auto& field = child<QWidget>(loader, "setting_" + QString::fromStdString(setting.name));
    EXPECT_TRUE(field.toolTip().contains(QString::fromStdString(setting.help.substr(0, 20)).toHtmlEscaped()))
        << setting.name;
  }
  child<QComboBox>(loader, "setting_carve").setEditText("2.6");
  child<QComboBox>(loader, "setting_mesher").setCurrentText("delaunay");
  EXPECT_EQ(loader.request().settings.options.carve_options.radius, 2.6);
  EXPECT_EQ(loader.request().settings.options.tetrahedralize.mesher, "delaunay");
  test::keep_screenshot(loader.grab().toImage(), "loader-settings");
  loader.setPalette(test::dark_palette());
  test::keep_screenshot(loader.grab().toImage(), "loader-settings-dark");
  child<QComboBox>(loader, "setting_carve").setEditText("wide");
  EXPECT_FALSE(child<QPushButton>(loader, "go").isEnabled());
  EXPECT_TRUE(child<QLabel>(loader, "settings_message").text().contains("--carve"));
  child<QComboBox>(loader, "setting_carve").setEditText("auto");
  EXPECT_TRUE(child<QPushButton>(loader, "go").isEnabled());
  QTest::mouseClick(&child<QToolButton>(loader, "settings_opener"), Qt::LeftButton);
  EXPECT_EQ(child<QLabel>(loader, "settings_message").text(), "Changed: mesher delaunay");
}

TEST_F(Pages, RecentFilesAreChosenByAClickAndThoseThatWentAreGray) {
  {
    RecentFiles recent("data", settings());
    recent.add(path("gone.crb"));
    recent.add(path("salt.dat"));
  }
  LoaderPage loader(nullptr, settings());
  test::show(loader);
  auto& list = child<QListWidget>(loader, "recent");
  ASSERT_EQ(list.count(), 2);
  ASSERT_TRUE(wait_for([&] { return loader.recent_files().missing(path("gone.crb")); }));
  EXPECT_TRUE(list.item(0)->flags() & Qt::ItemIsEnabled);
  EXPECT_FALSE(list.item(1)->flags() & Qt::ItemIsEnabled);
  QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(list.item(0)).center());
  EXPECT_EQ(loader.file(), path("salt.dat"));
  QSignalSpy asked(&loader, &LoaderPage::preprocess_requested);
  emit list.itemActivated(list.item(0));
  EXPECT_TRUE(wait_for([&] { return asked.size() == 1; }));  // once it is known what it is
}

TEST_F(Pages, PreprocessingShowsItsStagesAndGoesOn) {
  PreprocessingPage page(nullptr, settings());
  page.resize(900, 700);
  test::show(page);
  child<QCheckBox>(page, "automatic").setChecked(false);
  QSignalSpy on(&page, &PreprocessingPage::go_on);
  QSignalSpy back(&page, &PreprocessingPage::back_to_loader);
  PreprocessingRequest request;
  request.input = dat;
  request.settings.options.carve_options.radius = 2.6;
  page.start(request);
  auto& stages = child<QTableWidget>(page, "stages");
  EXPECT_EQ(stages.rowCount(), 8);  // the plan
  EXPECT_TRUE(child<QPushButton>(page, "preprocessing_cancel").isVisible());
  EXPECT_FALSE(child<QPushButton>(page, "go_on").isVisible());
  ASSERT_TRUE(wait_for([&] { return page.run().state() == Preprocessing::State::done; }));
  ASSERT_EQ(stages.rowCount(), 8);
  EXPECT_EQ(stages.item(0, 0)->text(), "Read atoms");
  for (int row = 0; row < stages.rowCount(); ++row) {
    for (int column = 0; column < 4; ++column) EXPECT_NE(stages.item(row, column)->text(), "") << row << ' ' << column;
  }
  EXPECT_TRUE(stages.item(7, 3)->text().contains("salt.crb"));
  EXPECT_EQ(child<QProgressBar>(page, "preprocessing_progress").value(), 1000);
  EXPECT_TRUE(child<QLabel>(page, "preprocessing_status").text().contains("salt.crb"));
  EXPECT_TRUE(child<QPlainTextEdit>(page, "preprocessing_log").toPlainText().contains("carve 2.6"));
  test::keep_screenshot(page.grab().toImage(), "preprocessing-done");
  page.setPalette(test::dark_palette());
  test::keep_screenshot(page.grab().toImage(), "preprocessing-done-dark");
  EXPECT_EQ(on.size(), 0);
  EXPECT_FALSE(child<QPushButton>(page, "preprocessing_cancel").isVisible());
  QTest::mouseClick(&child<QPushButton>(page, "back"), Qt::LeftButton);
  ASSERT_EQ(back.size(), 1);
  EXPECT_EQ(back[0][0].toString(), path("salt.crb"));
  QTest::mouseClick(&child<QPushButton>(page, "go_on"), Qt::LeftButton);
  EXPECT_EQ(on.size(), 1);
  child<QCheckBox>(page, "automatic").setChecked(true);
  page.start(request);
  EXPECT_TRUE(wait_for([&] { return on.size() == 2; }));
  EXPECT_TRUE(child<QCheckBox>(PreprocessingPage(nullptr, settings()), "automatic").isChecked());
}

TEST_F(Pages, PreprocessingCanBeCancelledAndBegunAgain) {
  PreprocessingPage page(nullptr, settings());
  test::show(page);
  PreprocessingRequest request;
  request.input = dat;
  page.start(request);
  QTest::mouseClick(&child<QPushButton>(page, "preprocessing_cancel"), Qt::LeftButton);
  ASSERT_TRUE(wait_for([&] { return page.run().state() == Preprocessing::State::cancelled; }));
  EXPECT_TRUE(child<QLabel>(page, "preprocessing_status").text().startsWith("Cancelled"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("salt.crb")));
  EXPECT_FALSE(child<QPushButton>(page, "go_on").isVisible());
  test::keep_screenshot(page.grab().toImage(), "preprocessing-cancelled");
  QTest::mouseClick(&child<QPushButton>(page, "again"), Qt::LeftButton);
  ASSERT_TRUE(wait_for([&] { return page.run().state() == Preprocessing::State::done; }));
  EXPECT_TRUE(std::filesystem::exists(folder.file("salt.crb")));
}

TEST_F(Pages, PreprocessingSaysWhatIsWrongWithTheFile) {
  PreprocessingPage page(nullptr, settings());
  test::show(page);
  PreprocessingRequest request;
  request.input = folder.file("bad.dat", "Na 0 0 0\nNa 1 x 0\n");
  page.start(request);
  ASSERT_TRUE(wait_for([&] { return page.run().state() == Preprocessing::State::failed; }));
  EXPECT_TRUE(child<QLabel>(page, "preprocessing_status").text().contains("bad.dat:2"));
  EXPECT_TRUE(child<QPushButton>(page, "back").isVisible());
  test::keep_screenshot(page.grab().toImage(), "preprocessing-failed");
}

TEST_F(Pages, DropsAreTakenOneFileAtATime) {
  QWidget window;
  DropTarget target(window);
  test::show(window);
  QSignalSpy dropped(&target, &DropTarget::dropped);
  QSignalSpy refused(&target, &DropTarget::refused);
  const auto drop = [&](const QList<QUrl>& urls) {
    QMimeData data;
    data.setUrls(urls);
    QDragEnterEvent enter(QPoint(5, 5), Qt::MoveAction | Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&window, &enter);
    EXPECT_TRUE(enter.isAccepted());
    EXPECT_EQ(enter.dropAction(), Qt::CopyAction);
    QDropEvent event(QPointF(5, 5), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&window, &event);
  };
  drop({QUrl::fromLocalFile(path("salt.dat"))});
  ASSERT_EQ(dropped.size(), 1);
  EXPECT_EQ(dropped[0][0].toString(), path("salt.dat"));
  drop({QUrl::fromLocalFile(path("a.crf"))});
  ASSERT_EQ(dropped.size(), 2);
  EXPECT_EQ(dropped[1][1].toString(), path("a.crf"));
  drop({QUrl::fromLocalFile(path("salt.dat")), QUrl::fromLocalFile(path("b.dat"))});
  ASSERT_EQ(refused.size(), 1);
  EXPECT_TRUE(refused[0][0].toString().contains("salt.dat, b.dat"));
  drop({QUrl("https://example.org/a.crb")});
  EXPECT_EQ(refused.size(), 2);
  EXPECT_EQ(dropped.size(), 2);
  QMimeData words;
  words.setText("words");
  QDragEnterEvent enter(QPoint(5, 5), Qt::CopyAction, &words, Qt::LeftButton, Qt::NoModifier);
  enter.ignore();
  QApplication::sendEvent(&window, &enter);
  EXPECT_FALSE(enter.isAccepted());
}

}  // namespace
