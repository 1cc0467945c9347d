// The window of the help, driven as by a person.
#include <gtest/gtest.h>

#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QScrollBar>
#include <QTest>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>

#include "app/gui/help_pages.h"
#include "app/gui/help_window.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/theme.h"
#include "tests/app/gui/window_test.h"

namespace atomesh::gui {
namespace {

using test::child;

class Help : public testing::Test {
 protected:
  void SetUp() override { test::show(window_); }
  QTextBrowser& browser() { return child<QTextBrowser>(window_, "help_browser"); }
  HelpWindow window_;
};

TEST_F(Help, OpensAtTheTopicOfADock) {
  EXPECT_EQ(window_.page(), "start");
  window_.show_topic("Lights");
  EXPECT_EQ(window_.page(), "cut-planes");
  EXPECT_GT(browser().verticalScrollBar()->value(), 0) << "at the group's heading";
  window_.show_topic("controls");
  EXPECT_EQ(window_.page(), "controls");
  EXPECT_EQ(browser().verticalScrollBar()->value(), 0);
  EXPECT_TRUE(browser().toPlainText().contains("full screen and back"));
  window_.show_topic("nothing of the kind");
  EXPECT_EQ(window_.page(), "start");
}

TEST_F(Help, ScrollsToTheEntryOfEveryParameter) {
  window_.resize(900, 300);
  QCoreApplication::processEvents();
  for (const std::string& key : parameter_keys({"Na"})) {
    window_.show_topic("start");
    window_.show_topic(QString::fromStdString(key));
    EXPECT_GT(browser().verticalScrollBar()->value(), 0) << key;
  }
}

TEST_F(Help, GoesBackAndForward) {
  window_.show_topic("files");
  window_.show_topic("volume");
  QTest::mouseClick(&child<QToolButton>(window_, "help_back"), Qt::LeftButton);
  EXPECT_EQ(window_.page(), "files");
  QTest::mouseClick(&child<QToolButton>(window_, "help_forward"), Qt::LeftButton);
  EXPECT_EQ(window_.page(), "volume");
  QTest::mouseClick(&child<QToolButton>(window_, "help_home"), Qt::LeftButton);
  EXPECT_EQ(window_.page(), "start");
  EXPECT_EQ(child<QTreeWidget>(window_, "help_contents").currentItem()->text(0), "atomesh");
}

TEST_F(Help, TheContentsHoldEveryPage) {
  auto& contents = child<QTreeWidget>(window_, "help_contents");
  ASSERT_EQ(contents.topLevelItemCount(), static_cast<int>(help_pages().size()));
  for (int i = 0; i < contents.topLevelItemCount(); ++i) {
    contents.setCurrentItem(contents.topLevelItem(i));
    EXPECT_EQ(window_.page(), help_pages()[static_cast<std::size_t>(i)].id);
    EXPECT_FALSE(browser().toPlainText().isEmpty());
  }
}

TEST_F(Help, TheSearchShowsHitsAndOpensThem) {
  auto& search = child<QLineEdit>(window_, "help_search");
  auto& hits = child<QListWidget>(window_, "help_hits");
  search.setFocus();
  QTest::keyClicks(&search, "miller");
  EXPECT_TRUE(hits.isVisible());
  ASSERT_GT(hits.count(), 0);
  EXPECT_TRUE(hits.item(0)->text().startsWith("Cut planes › By Miller indices")) << hits.item(0)->text().toStdString();
  QTest::keyClick(&search, Qt::Key_Return);
  EXPECT_EQ(window_.page(), "cut-planes");
  window_.search("xyzzy");
  EXPECT_TRUE(child<QLabel>(window_, "help_nothing").isVisible());
  QTest::keyClick(&window_, Qt::Key_Escape);
  EXPECT_TRUE(search.text().isEmpty());
  EXPECT_TRUE(child<QTreeWidget>(window_, "help_contents").isVisible());
  QTest::keyClick(&window_, Qt::Key_Escape);
  EXPECT_FALSE(window_.isVisible());
}

TEST_F(Help, FollowsTheTheme) {
  ThemeKeeper keeper;
  for (const Theme theme : {Theme::light, Theme::dark}) {
    keeper.choose(theme);
    window_.show_topic("color-map");
    QCoreApplication::processEvents();
    test::keep_screenshot(window_.grab().toImage(), theme == Theme::dark ? "help_dark" : "help_light");
    EXPECT_EQ(is_dark(browser().palette()), theme == Theme::dark);
    window_.show_topic("Lights");
    QCoreApplication::processEvents();
    test::keep_screenshot(window_.grab().toImage(), theme == Theme::dark ? "help_lights_dark" : "help_lights_light");
  }
  keeper.choose(Theme::system);
}

}  // namespace
}  // namespace atomesh::gui
