// The colour map's editor, driven as a user drives it: mouse, keys and typing; every gesture one step that is undone.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QColorDialog>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSpinBox>
#include <QTableView>
#include <QTest>
#include <filesystem>

#include "app/gui/color_map_canvas.h"
#include "app/gui/color_map_editor.h"
#include "app/gui/color_map_table.h"
#include "core/parameter_text.h"
#include "tests/app/gui/window_test.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

// Eight vertices with a field from 10 to 20.
Document field_document() {
  Material material;
  material.mesh = test::cube_of_six(2.0);
  material.fields.push_back({"pressure", {10, 20, 11, 14, 15, 19, 12, 12}});
  Document document;
  document.path = "/nowhere/field.vtu";
  document.kind = FileKind::mesh;
  document.material = std::make_shared<const Material>(std::move(material));
  return document;
}

class ColorMapEditorTest : public ::testing::Test {
 protected:
  ColorMapEditorTest() {
    editor.resize(640, 640);
    set_map({{{0.0, {1, 0, 0, 0}}, {0.5, {0, 1, 0, 0.5F}}, {1.0, {0, 0, 1, 1}}}});
    test::show(editor);
  }
  void set_map(const ColorMap& map) {
    Parameters to = workspace.parameters();
    to.volume.color_map = map;
    workspace.change(to, "map");
    workspace.end_gesture();
  }
  const ColorMap& map() const { return workspace.parameters().volume.color_map; }
  ColorMapCanvas& canvas() { return child<ColorMapCanvas>(editor, "color_map_canvas"); }
  QTableView& table() { return child<QTableView>(editor, "color_map_table"); }
  QPoint handle(std::size_t i) { return canvas().handle_position(i).toPoint(); }
  QPoint place(double scalar, double opacity) {
    const QRectF plot = canvas().plot_area();
    return QPointF(plot.left() + scalar * plot.width(), plot.bottom() - opacity * plot.height()).toPoint();
  }
  void drag(QPoint from, const std::vector<QPoint>& by, Qt::KeyboardModifiers modifiers = {}) {
    QTest::mousePress(&canvas(), Qt::LeftButton, modifiers, from);
    for (const QPoint& to : by) move(to, modifiers);
    QTest::mouseRelease(&canvas(), Qt::LeftButton, modifiers, by.back());
  }
  // QTest::mouseMove() carries no buttons on some platforms.
  void move(QPoint to, Qt::KeyboardModifiers modifiers) {
    QMouseEvent event(QEvent::MouseMove, QPointF(to), canvas().mapToGlobal(QPointF(to)), Qt::NoButton, Qt::LeftButton,
                      modifiers);
    QApplication::sendEvent(&canvas(), &event);
  }
  void choose(const QString& menu, const QString& action) {
    child<QAction>(child<QMenu>(editor, menu), action).trigger();
  }
  QString refusal() { return child<QLabel>(editor, "refusal").text(); }

  Workspace workspace;
  ColorMapEditor editor{workspace};
};

// Half a pixel of the canvas, in scalars or opacities.
constexpr double pixel = 0.004;

TEST_F(ColorMapEditorTest, DraggingAHandleIsOneStep) {
  const ColorMap before = map();
  const std::string steps = workspace.history().undo_name();
  drag(handle(1), {place(0.6, 0.6), place(0.7, 0.7), place(0.25, 0.75)});
  EXPECT_NEAR(map().entries[1].scalar, 0.25, pixel);
  EXPECT_NEAR(map().entries[1].color.a, 0.75, pixel);
  EXPECT_EQ(Vec3f(map().entries[1].color), Vec3f(0, 1, 0));
  EXPECT_EQ(canvas().selected(), 1U);
  EXPECT_EQ(table().currentIndex().row(), 1);
  workspace.undo();
  EXPECT_EQ(map(), before) << "one step brings back what was before the drag";
  EXPECT_EQ(canvas().color_map(), before);
  EXPECT_EQ(workspace.history().undo_name(), steps);
  workspace.redo();
  EXPECT_NEAR(map().entries[1].scalar, 0.25, pixel);
}

TEST_F(ColorMapEditorTest, TwoDragsAreTwoSteps) {
  const ColorMap before = map();
  drag(handle(1), {place(0.4, 0.5), place(0.3, 0.5)});
  const ColorMap between = map();
  drag(handle(1), {place(0.5, 0.2), place(0.6, 0.1)});
  workspace.undo();
  EXPECT_EQ(map(), between);
  workspace.undo();
  EXPECT_EQ(map(), before);
}

TEST_F(ColorMapEditorTest, HandlesStopAtTheirNeighboursAndAtTheEdges) {
  drag(handle(1), {place(1.0, 0.5) + QPoint(300, 0)});
  EXPECT_EQ(map().entries[1].scalar, 1.0);
  drag(handle(0), {place(0.3, 0.0) + QPoint(0, 500)});
  EXPECT_NEAR(map().entries[0].scalar, 0.3, pixel);
  EXPECT_EQ(map().entries[0].color.a, 0.0F);
  drag(handle(0), {place(0.0, 0.5) - QPoint(300, 0)});
  EXPECT_EQ(map().entries[0].scalar, 0.0);
  check_color_map(map());
}

TEST_F(ColorMapEditorTest, ShiftKeepsOneOfTheTwoAndControlSnaps) {
  drag(handle(1), {place(0.62, 0.55)}, Qt::ShiftModifier);
  EXPECT_NEAR(map().entries[1].scalar, 0.62, pixel);
  EXPECT_EQ(map().entries[1].color.a, 0.5F) << "to the very number";
  drag(handle(1), {place(0.64, 0.9)}, Qt::ShiftModifier);
  EXPECT_NEAR(map().entries[1].scalar, 0.62, pixel);
  EXPECT_NEAR(map().entries[1].color.a, 0.9, pixel);
  drag(handle(1), {place(0.33, 0.22)}, Qt::ControlModifier);
  EXPECT_DOUBLE_EQ(map().entries[1].scalar, 0.35);
  EXPECT_FLOAT_EQ(map().entries[1].color.a, 0.2F);
}

TEST_F(ColorMapEditorTest, EscapeTakesADragBack) {
  const ColorMap before = map();
  QTest::mousePress(&canvas(), Qt::LeftButton, {}, handle(1));
  move(place(0.8, 0.8), {});
  EXPECT_NE(map(), before);
  QTest::keyClick(&canvas(), Qt::Key_Escape);
  EXPECT_EQ(map(), before);
  move(place(0.2, 0.2), {});
  EXPECT_EQ(map(), before) << "the drag is over";
}

TEST_F(ColorMapEditorTest, ADoubleClickAddsAnEntryThere) {
  QTest::mouseDClick(&canvas(), Qt::LeftButton, {}, place(0.25, 0.9));
  ASSERT_EQ(map().entries.size(), 4U);
  EXPECT_NEAR(map().entries[1].scalar, 0.25, pixel);
  EXPECT_NEAR(map().entries[1].color.a, 0.9, pixel);
  EXPECT_NEAR(map().entries[1].color.r, 0.5, 2 * pixel);
  EXPECT_NEAR(map().entries[1].color.g, 0.5, 2 * pixel);
  EXPECT_EQ(canvas().selected(), 1U);
  QTest::keyClick(&canvas(), Qt::Key_Delete);
  ASSERT_EQ(map().entries.size(), 3U);
  EXPECT_EQ(map().entries[1].scalar, 0.5);
  workspace.undo();
  workspace.undo();
  EXPECT_EQ(map().entries.size(), 3U);
}

TEST_F(ColorMapEditorTest, TheLastTwoCannotBeRemovedAndThe33rdNotAdded) {
  QTest::mouseClick(&canvas(), Qt::LeftButton, {}, handle(1));
  child<QPushButton>(editor, "remove_entry").click();
  ASSERT_EQ(map().entries.size(), 2U);
  EXPECT_FALSE(child<QPushButton>(editor, "remove_entry").isEnabled());
  QTest::keyClick(&canvas(), Qt::Key_Delete);
  EXPECT_EQ(map().entries.size(), 2U);
  EXPECT_TRUE(refusal().contains("at least 2")) << refusal().toStdString();
  for (int i = 0; i < 30; ++i) child<QPushButton>(editor, "add_entry").click();
  ASSERT_EQ(map().entries.size(), 32U);
  EXPECT_TRUE(refusal().isEmpty());
  EXPECT_FALSE(child<QPushButton>(editor, "add_entry").isEnabled());
  QTest::keyClick(&canvas(), Qt::Key_Insert);
  EXPECT_EQ(map().entries.size(), 32U);
  EXPECT_TRUE(refusal().contains("at most 32")) << refusal().toStdString();
  EXPECT_EQ(child<QLabel>(editor, "entry_count").text(), "32 of 32 entries");
}

TEST_F(ColorMapEditorTest, TheMenuOfTheRightButton) {
  const auto menu_at = [&](QPoint at) -> QMenu& {
    QContextMenuEvent event(QContextMenuEvent::Mouse, at, canvas().mapToGlobal(at));
    QApplication::sendEvent(&canvas(), &event);
    return child<QMenu>(canvas(), "color_map_menu");
  };
  QMenu& on_handle = menu_at(handle(1));
  child<QAction>(on_handle, "menu_remove").trigger();
  on_handle.close();
  EXPECT_EQ(map().entries.size(), 2U);
  ASSERT_TRUE(wait_for([&] { return canvas().findChild<QMenu*>("color_map_menu") == nullptr; }));
  QMenu& beside = menu_at(place(0.75, 0.1));
  child<QAction>(beside, "menu_add").trigger();
  beside.close();
  ASSERT_EQ(map().entries.size(), 3U);
  EXPECT_NEAR(map().entries[1].scalar, 0.75, pixel);
  EXPECT_NEAR(map().entries[1].color.a, 0.1, pixel);
}

TEST_F(ColorMapEditorTest, TheKeyboardReachesEverything) {
  canvas().setFocus(Qt::TabFocusReason);
  EXPECT_EQ(canvas().selected(), 0U);
  QTest::keyClick(&canvas(), Qt::Key_PageDown);
  EXPECT_EQ(canvas().selected(), 1U);
  for (int i = 0; i < 5; ++i) QTest::keyClick(&canvas(), Qt::Key_Right);
  QTest::keyClick(&canvas(), Qt::Key_Left, Qt::ShiftModifier);
  QTest::keyClick(&canvas(), Qt::Key_Up, Qt::ControlModifier);
  EXPECT_NEAR(map().entries[1].scalar, 0.45, 1e-12);
  EXPECT_NEAR(map().entries[1].color.a, 0.501, 1e-6);
  workspace.undo();
  EXPECT_EQ(map().entries[1].scalar, 0.5) << "moving one entry by keys is one step";
  QTest::keyClick(&canvas(), Qt::Key_End);
  EXPECT_EQ(canvas().selected(), 2U);
  QTest::keyClick(&canvas(), Qt::Key_Insert);
  ASSERT_EQ(map().entries.size(), 4U);
  EXPECT_EQ(map().entries[2].scalar, 0.75);
  EXPECT_EQ(canvas().selected(), 2U);
  QTest::keyClick(&canvas(), Qt::Key_Return);
  auto& dialog = child<QColorDialog>(editor, "entry_color_dialog");
  dialog.reject();
  // Tab goes from the canvas on, and not round in the table's cells.
  table().setFocus();
  QTest::keyClick(&table(), Qt::Key_Tab);
  EXPECT_TRUE(child<QPushButton>(editor, "add_entry").hasFocus());
}

TEST_F(ColorMapEditorTest, TheColorDialogIsOneStepAndCancelTakesItBack) {
  const ColorMap before = map();
  editor.ask_color(1);
  {
    auto& dialog = child<QColorDialog>(editor, "entry_color_dialog");
    EXPECT_EQ(dialog.currentColor(), QColor(0, 255, 0));
    dialog.setCurrentColor(QColor(10, 20, 30));
    EXPECT_EQ(Vec3f(map().entries[1].color), Vec3f(10, 20, 30) / 255.0F) << "seen while it is chosen";
    dialog.setCurrentColor(QColor(255, 255, 0));
    dialog.accept();
  }
  EXPECT_EQ(map().entries[1].color, Vec4f(1, 1, 0, 0.5F)) << "the opacity stays";
  workspace.undo();
  EXPECT_EQ(map(), before);
  ASSERT_TRUE(wait_for([&] { return editor.findChild<QColorDialog*>() == nullptr; }));
  editor.ask_color(1);
  auto& dialog = child<QColorDialog>(editor, "entry_color_dialog");
  dialog.setCurrentColor(QColor(10, 20, 30));
  dialog.reject();
  EXPECT_EQ(map(), before);
}

TEST_F(ColorMapEditorTest, NumbersAreTyped) {
  QAbstractItemModel& entries = *table().model();
  EXPECT_TRUE(entries.setData(entries.index(1, ColorMapTable::scalar), "0.125"));
  EXPECT_EQ(map().entries[1].scalar, 0.125);
  EXPECT_TRUE(entries.setData(entries.index(1, ColorMapTable::opacity), "0.1"));
  EXPECT_EQ(map().entries[1].color.a, 0.1F);
  EXPECT_TRUE(entries.setData(entries.index(1, ColorMapTable::color), "#ff8000"));
  EXPECT_EQ(Vec3f(map().entries[1].color), Vec3f(255, 128, 0) / 255.0F);
  // Past another entry: the row moves, and stays selected.
  EXPECT_TRUE(entries.setData(entries.index(0, ColorMapTable::scalar), "0.5"));
  EXPECT_EQ(map().entries[1].scalar, 0.5);
  EXPECT_EQ(Vec3f(map().entries[1].color), Vec3f(1, 0, 0));
  EXPECT_EQ(canvas().selected(), 1U);
  for (int i = 0; i < 4; ++i) workspace.undo();
  EXPECT_EQ(map().entries[1].scalar, 0.5);
  EXPECT_EQ(map().entries[1].color, Vec4f(0, 1, 0, 0.5F));
}

TEST_F(ColorMapEditorTest, WhatIsNoNumberIsRefusedWithWords) {
  const ColorMap before = map();
  QAbstractItemModel& entries = *table().model();
  for (const auto& [column, text] : std::vector<std::pair<int, QString>>{{ColorMapTable::scalar, "1.5"},
                                                                         {ColorMapTable::scalar, "0.5x"},
                                                                         {ColorMapTable::opacity, "-1"},
                                                                         {ColorMapTable::opacity, "nan"},
                                                                         {ColorMapTable::color, "reddish"},
                                                                         {ColorMapTable::value, "7"}}) {
    EXPECT_FALSE(entries.setData(entries.index(1, column), text)) << text.toStdString();
    EXPECT_FALSE(refusal().isEmpty()) << text.toStdString();
    EXPECT_EQ(map(), before) << text.toStdString();
  }
  EXPECT_TRUE(entries.setData(entries.index(1, ColorMapTable::scalar), "0.25"));
  EXPECT_TRUE(refusal().isEmpty());
}

TEST_F(ColorMapEditorTest, PresetsWholeOrInPart) {
  choose("presets_menu", "preset_seed-figure-5.8");
  EXPECT_EQ(map(), preset_color_map("seed-figure-5.8"));
  EXPECT_TRUE(child<QPushButton>(editor, "presets").text().contains("seed-figure-5.8"));
  set_map({{{0.0, {1, 0, 0, 0}}, {0.5, {0, 1, 0, 0.9F}}, {1.0, {0, 0, 1, 0}}}});
  child<QComboBox>(editor, "preset_part").setCurrentIndex(1);
  choose("presets_menu", "preset_cividis");
  EXPECT_EQ(Vec3f(map()(0.5)), Vec3f(preset_color_map("cividis")(0.5)));
  EXPECT_EQ(map()(0.5).a, 0.9F) << "the opacities stayed";
  child<QComboBox>(editor, "preset_part").setCurrentIndex(2);
  choose("presets_menu", "preset_gray");
  EXPECT_FLOAT_EQ(map()(0.5).a, 0.5F);
  EXPECT_EQ(Vec3f(map()(1.0)), Vec3f(preset_color_map("cividis")(1.0)));
  choose("opacity_menu", "opacity_threshold");
  EXPECT_EQ(map()(0.499).a, 0.0F);
  child<QComboBox>(editor, "preset_part").setCurrentIndex(0);
  child<QPushButton>(editor, "reverse").click();
  EXPECT_EQ(map()(0.501).a, 0.0F);
  EXPECT_EQ(Vec3f(map()(0.0)), Vec3f(preset_color_map("cividis")(1.0)));
  for (int i = 0; i < 6; ++i) workspace.undo();
  EXPECT_EQ(map().entries[1].color, Vec4f(0, 1, 0, 0.5F));
}

TEST_F(ColorMapEditorTest, TextGoesOutAndIn) {
  choose("presets_menu", "copy_color_map");
  EXPECT_EQ(QApplication::clipboard()->text().toStdString(), color_map_text(map()));
  QApplication::clipboard()->setText("0:#000000 1:#ffffff80");
  choose("presets_menu", "paste_color_map");
  EXPECT_EQ(map(), read_color_map("0:#000000 1:#ffffff80"));
  QApplication::clipboard()->setText("1:#000000 0:#ffffff80");
  choose("presets_menu", "paste_color_map");
  EXPECT_FALSE(refusal().isEmpty());
  EXPECT_EQ(map(), read_color_map("0:#000000 1:#ffffff80"));
}

TEST_F(ColorMapEditorTest, MapsAreSavedAndLoaded) {
  const test::TemporaryFolder folder;
  const QString path = QString::fromStdString(folder.file("mine.json"));
  const ColorMap mine = map();
  editor.save_color_map(path);
  choose("presets_menu", "preset_gray");
  editor.load_color_map(path);
  EXPECT_EQ(map(), mine);
  workspace.undo();
  EXPECT_EQ(map(), preset_color_map("gray"));
  // A strip without opacities changes the colours alone.
  Image strip(2, 1);
  strip.at(0, 0) = {0, 0, 1, 1};
  strip.at(1, 0) = {1, 0, 0, 1};
  write_png(folder.file("strip.png"), strip);
  editor.load_color_map(QString::fromStdString(folder.file("strip.png")));
  EXPECT_EQ(map(), (ColorMap{{{0.0, {0, 0, 1, 0}}, {1.0, {1, 0, 0, 1}}}}));
  QString complaint;
  QObject::connect(&workspace, &Workspace::complained, [&](const QString& message) { complaint = message; });
  editor.load_color_map(QString::fromStdString(folder.file("damaged.json", "[{]")));
  EXPECT_TRUE(complaint.contains("damaged.json")) << complaint.toStdString();
}

TEST_F(ColorMapEditorTest, ApplyWaitsWhereAutoApplyIsOff) {
  auto& apply = child<QPushButton>(editor, "apply");
  EXPECT_FALSE(apply.isEnabled());
  child<QCheckBox>(editor, "auto_apply").click();
  EXPECT_FALSE(workspace.auto_apply(Mode::volume));
  choose("presets_menu", "preset_gray");
  EXPECT_NE(workspace.shown().volume.color_map, map());
  ASSERT_TRUE(apply.isEnabled());
  apply.click();
  EXPECT_EQ(workspace.shown().volume.color_map, preset_color_map("gray"));
  EXPECT_FALSE(apply.isEnabled());
}

TEST_F(ColorMapEditorTest, TheHistogramIsCountedAndWritten) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(child<QPushButton>(editor, "create_histogram").isEnabled());
  workspace.show_document(field_document());
  ASSERT_TRUE(wait_for([&] { return editor.histogram() != nullptr && !editor.counting(); }));
  EXPECT_EQ(editor.histogram()->name, "pressure");
  EXPECT_EQ(editor.histogram()->total(), 8U);
  child<QSpinBox>(editor, "bins").setValue(5);
  ASSERT_TRUE(wait_for([&] { return !editor.counting(); }));
  ASSERT_EQ(editor.histogram()->counts.size(), 5U);
  // Typed values are the field's.
  QAbstractItemModel& entries = *table().model();
  EXPECT_TRUE(entries.setData(entries.index(1, ColorMapTable::value), "12.5"));
  EXPECT_EQ(map().entries[1].scalar, 0.25);
  EXPECT_EQ(entries.index(1, ColorMapTable::value).data().toString(), "12.5");
  // A range of one's own.
  auto& low = child<QLineEdit>(editor, "range_low");
  EXPECT_TRUE(low.isVisible());
  QTest::keyClicks(&low, "12");
  QTest::keyClick(&low, Qt::Key_Return);
  ASSERT_TRUE(wait_for([&] { return !editor.counting(); }));
  EXPECT_EQ(workspace.parameters().volume.range_low, 12.0);
  EXPECT_EQ(editor.histogram()->below, 2U);
  low.setText("30");
  QTest::keyClick(&low, Qt::Key_Return);
  ASSERT_TRUE(wait_for([&] { return !editor.counting(); }));
  EXPECT_EQ(editor.histogram(), nullptr) << "30 is above the largest: there is none";
  workspace.undo();
  ASSERT_TRUE(wait_for([&] { return editor.histogram() != nullptr && !editor.counting(); }));

  const std::string path = folder.file("histogram.csv");
  editor.write_histogram(QString::fromStdString(path));
  EXPECT_EQ(test::read_bytes(path), histogram_csv(*editor.histogram()));
  QString complaint;
  QObject::connect(&workspace, &Workspace::complained, [&](const QString& message) { complaint = message; });
  editor.write_histogram(QString::fromStdString(folder.file("none/histogram.csv")));
  EXPECT_FALSE(complaint.isEmpty());
}

TEST_F(ColorMapEditorTest, OnlyWhatIsLookedAtIsCounted) {
  editor.hide();
  workspace.show_document(field_document());
  EXPECT_FALSE(editor.counting());
  test::show(editor);
  EXPECT_TRUE(wait_for([&] { return editor.histogram() != nullptr; }));
}

TEST_F(ColorMapEditorTest, TheHistogramIsWrittenWhileNobodyLooks) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("histogram.csv");
  QStringList complaints;
  QObject::connect(&workspace, &Workspace::complained, [&](const QString& message) { complaints << message; });
  editor.hide();
  editor.write_histogram(QString::fromStdString(path));
  ASSERT_EQ(complaints.size(), 1) << "nothing is open";
  workspace.show_document(field_document());
  editor.write_histogram(QString::fromStdString(path));
  ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(path); }));
  EXPECT_EQ(test::read_bytes(path), histogram_csv(*editor.histogram()));
  // Of what is chosen now, not of what was counted before.
  workspace.set("volume.range_low", "12");
  EXPECT_FALSE(editor.counting()) << "nobody looks again";
  std::filesystem::remove(path);
  editor.write_histogram(QString::fromStdString(path));
  ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(path); }));
  EXPECT_TRUE(test::read_bytes(path).starts_with("scalar_from,scalar_to,value_from,value_to,count\n-inf,0,-inf,12,2\n"))
      << test::read_bytes(path).substr(0, 200);
  std::filesystem::remove(path);
  workspace.set("volume.field", "no such field");
  editor.write_histogram(QString::fromStdString(path));
  ASSERT_TRUE(wait_for([&] { return complaints.size() == 2; }));
  EXPECT_TRUE(complaints[1].contains("no such field")) << complaints[1].toStdString();
  EXPECT_FALSE(std::filesystem::exists(path));
}

// A .crb of which only the surface was read: the editor asks for the rest.
TEST_F(ColorMapEditorTest, OfASampleTheMissingPartsAreRead) {
  const test::TemporaryFolder folder;
  const std::string path = test::cracked_salt_crb(folder.path().string());
  const MaterialParts few{.atoms = true, .tetrahedra = false, .surface = true, .defects = false, .fields = false};
  Parameters surface = workspace.parameters();
  surface.mode = Mode::surface;
  workspace.show_document(open_document(path, few, no_progress()), surface);
  ASSERT_TRUE(wait_for([&] { return editor.histogram() != nullptr && !editor.counting(); }));
  EXPECT_TRUE(editor.histogram()->of_atoms);
  EXPECT_EQ(editor.histogram()->total(), workspace.document()->material->atoms.size());
  EXPECT_GT(editor.histogram()->high, 0.0);
  test::keep_screenshot(editor.grab().toImage(), "color_map_editor");
  // Other weights, another count.
  const double before = editor.histogram()->high;
  workspace.set("volume.positional_multiplier", "3");
  ASSERT_TRUE(wait_for([&] { return !editor.counting(); }));
  EXPECT_GT(editor.histogram()->high, before);
  workspace.close_document();
  EXPECT_EQ(editor.histogram(), nullptr);
}

TEST_F(ColorMapEditorTest, PicturesInBothThemes) {
  workspace.show_document(field_document());
  ASSERT_TRUE(wait_for([&] { return editor.histogram() != nullptr; }));
  canvas().select(1);
  const QImage light = canvas().grab().toImage();
  editor.setPalette(test::dark_palette());
  const QImage in_the_dark = canvas().grab().toImage();
  test::keep_screenshot(editor.grab().toImage(), "color_map_editor_dark");
  // The plot's ground follows the theme; the strip of colours does not.
  const auto pixel_at = [&](const QImage& image, QPointF at) {
    return image.pixelColor((at * image.devicePixelRatio()).toPoint());
  };
  const QPointF empty = canvas().plot_area().topLeft() + QPointF(5, 5);
  EXPECT_GT(pixel_at(light, empty).lightness(), 200);
  EXPECT_LT(pixel_at(in_the_dark, empty).lightness(), 80);
  const QRectF strip = canvas().strip_area();
  const QPointF middle(strip.center().x(), strip.top() + 0.25 * strip.height());
  EXPECT_EQ(pixel_at(light, middle), pixel_at(in_the_dark, middle));
  const QColor green = pixel_at(light, middle);
  EXPECT_GT(green.green(), 250);
  EXPECT_LT(green.red() + green.blue(), 10);
}

}  // namespace
