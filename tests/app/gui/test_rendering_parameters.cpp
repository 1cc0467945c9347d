// The dock of the rendering parameters: pages of the modes, auto apply, species, parameter files, search.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QElapsedTimer>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QTest>
#include <QToolButton>

#include "app/gui/display_options.h"
#include "app/gui/number_box.h"
#include "app/gui/numbered_parts.h"
#include "app/gui/parameter_field.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/rendering_parameters.h"
#include "app/gui/theme.h"
#include "app/gui/workspace.h"
#include "core/parameter_file.h"
#include "tests/app/gui/window_test.h"
#include "tests/core/random_parameters.h"

namespace atomesh::gui {
namespace {

using test::child;

void set_light_count_of(Workspace& workspace, int count) {
  Parameters parameters = workspace.parameters();
  set_light_count(parameters, count);
  workspace.change(parameters, "lights");
}

class Dock : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(folder_.isValid());
    auto material = std::make_shared<Material>();
    material->atoms.add_species("Na");
    material->atoms.add_species("Cl");
    material->atoms.positions = {Vec3(0.0), Vec3(3.0)};
    material->atoms.species = {0, 1};
    material->fields.push_back({"pressure", {0.0F, 1.0F}});
    Document document;
    document.path = folder_.filePath("salt.crb").toStdString();
    document.kind = FileKind::mesh;  // nothing to read later
    document.material = material;
    Parameters parameters;
    parameters.mode = Mode::atoms;
    workspace_.show_document(std::move(document), parameters);
    dock_.resize(420, 900);
    test::show(dock_);
  }
  template <class Widget>
  Widget& part(const char* name) {
    return child<Widget>(dock_, name);
  }
  void click(const char* name) { QTest::mouseClick(&part<QWidget>(name), Qt::LeftButton); }
  QLabel& message() { return part<QLabel>("parameter_file_message"); }
  QTemporaryDir folder_;
  Workspace workspace_;
  RenderingParameters dock_{workspace_, nullptr};
};

TEST_F(Dock, EveryModesPageHoldsItsRows) {
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    const auto& page = part<QWidget>(("page_" + std::string(mode_name(mode))).c_str());
    for (const std::string& key : keys_of_group(group_of_mode(mode), {"Na", "Cl"})) {
      EXPECT_NE(page.findChild<ParameterField*>(QString::fromStdString(key)), nullptr) << key;
    }
  }
}

TEST_F(Dock, TheViewsModeIsShownFirst) {
  EXPECT_EQ(dock_.page(), Mode::atoms);
  EXPECT_FALSE(part<QLabel>("not_shown").isVisible());
  workspace_.set("mode", "xray");
  EXPECT_EQ(dock_.page(), Mode::xray);
  part<QComboBox>("mode_page").setCurrentIndex(static_cast<int>(Mode::volume));
  EXPECT_EQ(dock_.page(), Mode::volume);
  EXPECT_TRUE(part<QLabel>("not_shown").isVisible());
  EXPECT_EQ(workspace_.parameters().mode, Mode::xray);
  workspace_.set("xray.alpha_length", "0.5");
  EXPECT_EQ(dock_.page(), Mode::volume) << "other changes do not turn the page";
  emit part<QLabel>("not_shown").linkActivated("show");
  EXPECT_EQ(workspace_.parameters().mode, Mode::volume);
  EXPECT_FALSE(part<QLabel>("not_shown").isVisible());
}

TEST_F(Dock, WithoutAutoApplyThePictureWaits) {
  auto& automatic = part<QCheckBox>("auto_apply_atoms");
  auto& apply = part<QPushButton>("apply_atoms");
  EXPECT_TRUE(automatic.isChecked());
  EXPECT_FALSE(apply.isEnabled());
  automatic.click();
  workspace_.set("atoms.scale", "0.5");
  EXPECT_EQ(workspace_.shown().atoms.scale, 1.0);
  EXPECT_TRUE(apply.isEnabled());
  apply.click();
  EXPECT_EQ(workspace_.shown().atoms.scale, 0.5);
  EXPECT_FALSE(apply.isEnabled());
  workspace_.set("atoms.scale", "0.25");
  automatic.click();
  EXPECT_EQ(workspace_.shown().atoms.scale, 0.25);
}

TEST_F(Dock, SpeciesAreThoseOfTheFile) {
  part<QCheckBox>("atoms.visible.Na/check").click();
  EXPECT_EQ(get_parameter(workspace_.parameters(), "atoms.visible.Na"), "false");
  click("hide_all_species");
  EXPECT_EQ(get_parameter(workspace_.parameters(), "atoms.visible.Cl"), "false");
  EXPECT_FALSE(part<QCheckBox>("atoms.visible.Cl/check").isChecked());
  click("show_all_species");
  EXPECT_TRUE(workspace_.parameters().atoms.visible.empty());
  auto& radius = part<NumberBox>("atoms.radius.Na/box");
  radius.setFocus();
  QTest::keyClick(&radius, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClicks(&radius, "1000");
  QTest::keyClick(&radius, Qt::Key_Return);
  EXPECT_TRUE(part<QLabel>("species Na/message").isVisible());
  EXPECT_TRUE(workspace_.parameters().atoms.radii.empty());
  // Another file, other species.
  Document document = *workspace_.document();
  auto material = std::make_shared<Material>();
  material->atoms.add_species("Pd");
  document.material = material;
  workspace_.show_document(document);
  EXPECT_NE(dock_.findChild<ParameterField*>("atoms.color.Pd"), nullptr);
  EXPECT_EQ(dock_.findChild<ParameterField*>("atoms.color.Na"), nullptr);
  workspace_.close_document();
  EXPECT_EQ(dock_.findChild<ParameterField*>("atoms.color.Pd"), nullptr);
}

TEST_F(Dock, TheFieldIsChosenAmongThoseOfTheFile) {
  auto& combo = part<QComboBox>("volume.field/text");
  EXPECT_GE(combo.findText("pressure"), 0);
  EXPECT_GE(combo.findText("defects"), 0);
  EXPECT_GE(combo.findText("auto"), 0);
}

TEST_F(Dock, ParametersAreSavedAndLoadedByTheDataSetsName) {
  const Parameters random = test::random_parameters(3, {"Na", "Cl"});
  workspace_.change(random, "random");
  click("parameter_file_save");
  EXPECT_TRUE(QFile::exists(folder_.filePath("salt.crf")));
  EXPECT_EQ(read_crf(folder_.filePath("salt.crf").toStdString()), random);
  click("reset_all");
  EXPECT_EQ(workspace_.parameters(), Parameters{});
  click("parameter_file_load");
  EXPECT_EQ(workspace_.parameters(), random);
  workspace_.undo();
  EXPECT_EQ(workspace_.parameters(), Parameters{});
  workspace_.undo();
  EXPECT_EQ(workspace_.parameters(), random);
}

TEST_F(Dock, AFileWithAMistakeIsNotTaken) {
  QFile file(folder_.filePath("bad.crf"));
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("[xray]\nalpha_lenght = 1\n");
  file.close();
  const Parameters before = workspace_.parameters();
  part<QLineEdit>("parameter_file").setText("bad");
  click("parameter_file_load");
  EXPECT_EQ(workspace_.parameters(), before);
  EXPECT_TRUE(message().isVisible());
  EXPECT_TRUE(message().text().contains("bad.crf:2:")) << message().text().toStdString();
  EXPECT_TRUE(message().text().contains("alpha_length")) << message().text().toStdString();
}

TEST_F(Dock, TheSearchEditsWhatItFinds) {
  auto& search = part<QLineEdit>("parameter_search");
  search.setFocus();
  QTest::keyClicks(&search, "face alpha");
  const auto& page = part<QWidget>("search_page");
  EXPECT_TRUE(page.isVisible());
  EXPECT_EQ(part<QLabel>("search_text").text(), "2 parameters");  // "surface" has "face" in it too
  auto& box = child<NumberBox>(page, "volume_surface.face_alpha/box");
  EXPECT_TRUE(box.isVisible());
  box.setFocus();
  QTest::keyClick(&box, Qt::Key_Up);
  EXPECT_EQ(get_parameter(workspace_.parameters(), "volume_surface.face_alpha"), "0.16");
  search.setText("Na");
  EXPECT_FALSE(box.isVisible());
  EXPECT_TRUE(child<QWidget>(page, "atoms.color.Na/button").isVisible());
  search.setText("no such thing");
  EXPECT_TRUE(part<QLabel>("search_text").text().startsWith("No parameter"));
  search.clear();
  EXPECT_FALSE(page.isVisible());
  EXPECT_TRUE(part<QComboBox>("mode_page").isVisible());
}

// A keystroke must not keep the window from its events for longer than 50 ms; the bound leaves room for the sanitizers
// and for a busy machine, the time itself is printed.
TEST_F(Dock, TheSearchIsQuick) {
  auto& search = part<QLineEdit>("parameter_search");
  QElapsedTimer watch;
  qint64 most = 0;
  for (const char* query : {"l", "li", "lig", "c", "co", "color"}) {
    watch.start();
    search.setText(query);
    QCoreApplication::processEvents();
    most = std::max(most, watch.elapsed());
  }
  RecordProperty("most_ms", static_cast<int>(most));
  std::printf("slowest keystroke: %lld ms\n", static_cast<long long>(most));
  EXPECT_LT(most, 1000);
}

TEST_F(Dock, ButtonsAskForWhatOthersDo) {
  QSignalSpy map(&dock_, &RenderingParameters::edit_color_map_requested);
  QSignalSpy histogram(&dock_, &RenderingParameters::create_histogram_requested);
  QSignalSpy help(&dock_, &RenderingParameters::help_requested);
  workspace_.set("mode", "volume");
  click("volume.color_map/preview");
  click("create_histogram");
  click("help_page");
  EXPECT_EQ(map.count(), 1);
  EXPECT_EQ(histogram.count(), 1);
  ASSERT_EQ(help.count(), 1);
  EXPECT_EQ(help[0][0].toString(), "Volume");
}

TEST_F(Dock, AModeIsResetAlone) {
  workspace_.set("atoms.scale", "0.5");
  workspace_.set("atoms.color.Na", "#ff0000");
  workspace_.set("xray.alpha_length", "0.5");
  click("reset_page");
  EXPECT_EQ(workspace_.parameters().atoms, AtomsParameters{});
  EXPECT_EQ(workspace_.parameters().xray.alpha_length, 0.5);
  workspace_.undo();
  EXPECT_EQ(workspace_.parameters().atoms.scale, 0.5);
}

// A drag of the view changes parameters at every event, which both docks follow.
TEST_F(Dock, FollowingADragIsCheap) {
  DisplayOptions options(workspace_, nullptr);
  set_light_count_of(workspace_, 8);
  part<QLineEdit>("parameter_search").setText("color");  // and the rows of a search
  test::show(options);
  QElapsedTimer watch;
  watch.start();
  constexpr int steps = 100;
  for (int step = 0; step < steps; ++step) {
    Parameters parameters = workspace_.parameters();
    parameters.azimuth = step;
    workspace_.change(parameters, "turn", "view");
    QCoreApplication::processEvents();
  }
  const double ms = static_cast<double>(watch.nsecsElapsed()) * 1e-6 / steps;
  std::printf("a change of the view: %.2f ms\n", ms);
  EXPECT_LT(ms, 50.0);  // the bound for any event, sanitizers included
}

TEST_F(Dock, ALargeFontFits) {
  const QFont usual = QApplication::font();
  QFont large = usual;
  large.setPointSizeF(2.0 * usual.pointSizeF());
  QApplication::setFont(large);
  RenderingParameters dock(workspace_, nullptr);
  dock.resize(840, 1400);
  test::show(dock);
  workspace_.set("mode", "volume-surface");
  QCoreApplication::processEvents();
  test::keep_screenshot(dock.grab().toImage(), "rendering_parameters_large_font");
  for (const QWidget* widget : dock.findChildren<QWidget*>()) {
    if (!widget->isVisible()) continue;
    EXPECT_LE(widget->mapTo(&dock, QPoint(widget->width(), 0)).x(), dock.width()) << widget->objectName().toStdString();
  }
  QApplication::setFont(usual);
}

TEST_F(Dock, LooksRightInEveryMode) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    ThemeKeeper keeper;
    keeper.choose(theme);
    for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
      workspace_.set("mode", std::string(mode_name(mode)));
      workspace_.set("volume_surface.face_alpha", "0.4");
      QCoreApplication::processEvents();
      // Nothing wider than the dock: no scrolling sideways.
      const QWidget& page = part<QWidget>(("page_" + std::string(mode_name(mode))).c_str());
      for (const QWidget* widget : page.findChildren<QWidget*>()) {
        if (!widget->isVisible()) continue;
        EXPECT_LE(widget->mapTo(&dock_, QPoint(widget->width(), 0)).x(), dock_.width())
            << mode_name(mode) << ' ' << widget->objectName().toStdString();
      }
      test::keep_screenshot(dock_.grab().toImage(), std::string("rendering_parameters_") +
                                                        (theme == Theme::dark ? "dark_" : "light_") +
                                                        std::string(mode_name(mode)));
    }
    keeper.choose(Theme::system);
  }
}

}  // namespace
}  // namespace atomesh::gui
