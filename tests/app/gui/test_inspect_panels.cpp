// The panels of picks, times and the log, driven as a user drives them.
#include <gtest/gtest.h>

#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QRegularExpression>
#include <QStackedWidget>
#include <QTest>
#include <QTreeWidget>

#include "app/gui/log_panel.h"
#include "app/gui/pick_panel.h"
#include "app/gui/pick_report.h"
#include "app/gui/render_worker.h"
#include "app/gui/timing_panel.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"
#include "tests/app/gui/window_test.h"
#include "tests/support/lattices.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

Document salt_document() {
  Material material;
  material.atoms = test::periodic_block(test::lattice("nacl").cell, 4, 4, 4);
  const std::size_t atoms = material.atoms.size();
  material.defects.positional.assign(atoms, 0.125F);
  material.defects.extra.assign(atoms, 0.0F);
  material.defects.vacancy.assign(atoms, 0.0F);
  Document document;
  document.path = "/nowhere/salt.crb";
  document.material = std::make_shared<const Material>(std::move(material));
  document.times = {{"read", 12.0}};
  return document;
}

class PickPanelTest : public ::testing::Test {
 protected:
  PickPanelTest() {
    Parameters parameters;
    parameters.mode = Mode::atoms;
    workspace.show_document(salt_document(), parameters);
    panel.resize(420, 560);
    test::show(panel);
  }
  const Material& material() { return *workspace.document()->material; }
  QTreeWidget& facts() { return child<QTreeWidget>(panel, "pick_facts"); }
  QTreeWidget& neighbours() { return child<QTreeWidget>(panel, "pick_neighbours"); }
  QString fact(const QString& label, int column = 1) {
    const auto found = facts().findItems(label, Qt::MatchExactly, 0);
    return found.isEmpty() ? "no such row" : found.front()->text(column);
  }
  void click_neighbour(int row, Qt::KeyboardModifiers modifiers = {}) {
    const QRect at = neighbours().visualItemRect(neighbours().topLevelItem(row));
    QTest::mouseClick(neighbours().viewport(), Qt::LeftButton, modifiers, at.center());
  }
  Workspace workspace;
  PickPanel panel{workspace};
};

TEST_F(PickPanelTest, SaysWhatIsPickedAndGoesToNeighbours) {
  auto& pages = child<QStackedWidget>(panel, "pick_pages");
  EXPECT_EQ(pages.currentIndex(), 1) << "nothing picked: what to do";
  EXPECT_FALSE(child<QPushButton>(panel, "pick_copy").isEnabled());
  workspace.add_pick(pick_atom(material(), 10), false);
  EXPECT_EQ(pages.currentIndex(), 0);
  EXPECT_EQ(fact("Atom"), "10");
  EXPECT_EQ(fact("Positional defect"), "0.125");
  EXPECT_TRUE(child<QLabel>(panel, "pick_distance").text().isEmpty());
  ASSERT_EQ(neighbours().topLevelItemCount(), 6);
  const QString atom = neighbours().topLevelItem(2)->text(1);
  EXPECT_NE(neighbours().topLevelItem(2)->text(0), fact("Species"));
  click_neighbour(2);
  ASSERT_TRUE(wait_for([&] { return fact("Atom") == atom; }));
  EXPECT_EQ(workspace.picks().size(), 1U);
}

TEST_F(PickPanelTest, MeasuresToASecond) {
  workspace.add_pick(pick_atom(material(), 10), false);
  const auto neighbour = workspace.picks()[0].neighbours[0];
  click_neighbour(0, Qt::ControlModifier);
  ASSERT_TRUE(wait_for([&] { return workspace.picks().size() == 2; }));
  EXPECT_EQ(fact("Atom", 1), "10");
  EXPECT_EQ(fact("Atom", 2), QString::number(neighbour.atom));
  const auto& distance = child<QLabel>(panel, "pick_distance");
  EXPECT_TRUE(distance.isVisible());
  EXPECT_TRUE(
      distance.text().startsWith(QString::fromStdString("Distance " + length_text(neighbour.distance, material()))))
      << distance.text().toStdString();
  test::keep_screenshot(panel.grab().toImage(), "pick_panel");
  panel.setPalette(test::dark_palette());
  test::keep_screenshot(panel.grab().toImage(), "pick_panel_dark");
  child<QPushButton>(panel, "pick_copy").click();
  EXPECT_EQ(QApplication::clipboard()->text().toStdString(), pick_text(workspace.picks(), material()));
  child<QPushButton>(panel, "pick_center").click();
  EXPECT_EQ(workspace.rotation_center(), material().atoms.positions[neighbour.atom]);
  child<QPushButton>(panel, "pick_clear").click();
  EXPECT_TRUE(workspace.picks().empty());
  EXPECT_EQ(child<QStackedWidget>(panel, "pick_pages").currentIndex(), 1);
}

TEST_F(PickPanelTest, EnterPicksTheNeighbourToo) {
  workspace.add_pick(pick_atom(material(), 10), false);
  const QString atom = neighbours().topLevelItem(1)->text(1);
  neighbours().setFocus();
  neighbours().setCurrentItem(neighbours().topLevelItem(1));
  QTest::keyClick(&neighbours(), Qt::Key_Return);
  ASSERT_TRUE(wait_for([&] { return fact("Atom") == atom; }));
}

TEST_F(PickPanelTest, WhatIsNoAtomHasNoNeighbours) {
  Pick place;
  place.position = {1, 2, 3};
  place.tetrahedron = 5;
  workspace.add_pick(place, false);
  EXPECT_EQ(fact("Tetrahedron"), "5");
  EXPECT_FALSE(neighbours().isVisible());
  panel.pick_atom_by_number(static_cast<Index>(material().atoms.size()), false);
  QString complaint;
  QObject::connect(&workspace, &Workspace::complained, [&](const QString& message) { complaint = message; });
  ASSERT_TRUE(wait_for([&] { return !complaint.isEmpty(); })) << "an atom that there is not";
  workspace.close_document();
  EXPECT_EQ(child<QStackedWidget>(panel, "pick_pages").currentIndex(), 1);
}

TEST(TimingPanel, StagesWithBarsAndMemory) {
  const test::TemporaryFolder folder;
  Workspace workspace;
  TimingPanel panel(workspace);
  panel.resize(460, 480);
  test::show(panel);
  auto& stages = child<QTreeWidget>(panel, "stages");
  EXPECT_EQ(stages.topLevelItemCount(), 0);
  PipelineReport report;
  Material material = preprocess(test::cracked_salt_dat(folder.path().string()), {}, report);
  Document document;
  document.path = folder.file("salt.dat");
  document.kind = FileKind::atoms;
  document.times = material.provenance.stages;
  document.pipeline = report;
  document.material = std::make_shared<const Material>(std::move(material));
  Parameters parameters;
  parameters.mode = Mode::atoms;
  workspace.show_document(document, parameters);
  ASSERT_EQ(stages.topLevelItemCount(), static_cast<int>(document.times.size()));
  ASSERT_GT(document.times.size(), 3U);
  for (std::size_t i = 0; i < document.times.size(); ++i) {
    const QTreeWidgetItem* item = stages.topLevelItem(static_cast<int>(i));
    EXPECT_EQ(item->text(0).toStdString(), document.times[i].name);
    EXPECT_EQ(item->text(1).toStdString(), time_text(document.times[i].ms));
    EXPECT_FALSE(item->text(3).isEmpty()) << "memory of " << document.times[i].name;
  }
  EXPECT_TRUE(child<QLabel>(panel, "stages_title")
                  .text()
                  .contains(QString::fromStdString(time_text(total_ms(document.times)))));
  // Of something else no memory is known.
  workspace.close_document();
  workspace.note_times({{"read", 3.0}});
  EXPECT_EQ(stages.topLevelItemCount(), 1);
  EXPECT_TRUE(stages.isColumnHidden(3));
}

TEST(TimingPanel, FramesOfBothWhoDraw) {
  Workspace workspace;
  TimingPanel panel(workspace);
  panel.resize(460, 520);
  test::show(panel);
  workspace.note_times(
      {{"read_atoms", 210.0}, {"tetrahedralize", 1300.0}, {"carve", 120.0}, {"quantify_defects", 860.0}});
  auto& frame = child<QTreeWidget>(panel, "frame_times");
  EXPECT_EQ(frame.topLevelItemCount(), 0);
  const auto value = [&](const QString& what) {
    const auto found = frame.findItems(what, Qt::MatchExactly, 0);
    return found.isEmpty() ? QString() : found.front()->text(1);
  };
  const auto picture = [](int level, double ms) {
    auto made = std::make_shared<WorkerPicture>();
    made->number = 7;
    made->camera.width = 800;
    made->camera.height = 600;
    made->level = level;
    made->levels = 3;
    made->scene_ms = 40.0;
    made->stats.setup_ms = 5.0;
    made->stats.steps = 1234567;
    made->ms = ms;
    return made;
  };
  panel.note_picture(picture(1, 25.0), 0.0);
  EXPECT_EQ(value("First picture"), "25.0 ms");
  EXPECT_EQ(value("Whole picture"), "drawing 1 of 3");
  panel.note_picture(picture(3, 250.0), 0.0);
  EXPECT_EQ(value("Drawn by"), "CPU");
  EXPECT_EQ(value("Size"), "800 × 600 pixels");
  EXPECT_EQ(value("First picture"), "25.0 ms");
  EXPECT_EQ(value("Whole picture"), "250 ms");
  EXPECT_EQ(value("Making the scene"), "40.0 ms");
  EXPECT_EQ(value("Steps of all rays").remove(QRegularExpression("[^0-9]")), "1234567");
  test::keep_screenshot(panel.grab().toImage(), "timing_panel");
  panel.setPalette(test::dark_palette());
  test::keep_screenshot(panel.grab().toImage(), "timing_panel_dark");
  workspace.set_view_size(320, 200);
  panel.note_picture(nullptr, 4.0);
  EXPECT_EQ(value("Drawn by"), "graphics card");
  EXPECT_EQ(value("Size"), "320 × 200 pixels");
  EXPECT_EQ(value("Whole picture"), "4.00 ms");
  EXPECT_TRUE(value("Steps of all rays").isEmpty());
  // With less detail at first.
  panel.note_picture(nullptr, 6.0, false);
  EXPECT_EQ(value("First picture"), "6.00 ms");
  EXPECT_EQ(value("Whole picture"), "drawing 1 of 2");
  panel.note_picture(nullptr, 80.0, true);
  EXPECT_EQ(value("First picture"), "6.00 ms");
  EXPECT_EQ(value("Whole picture"), "80.0 ms");
  panel.note_picture(nullptr, 4.0, true);
  EXPECT_EQ(value("First picture"), "");
  EXPECT_EQ(value("Whole picture"), "4.00 ms");
  child<QPushButton>(panel, "timing_copy").click();
  const QString text = QApplication::clipboard()->text();
  EXPECT_TRUE(text.contains("tetrahedralize\t1.30 s\n")) << text.toStdString();
  EXPECT_TRUE(text.contains("Whole picture\t4.00 ms\n")) << text.toStdString();
}

TEST(LogPanel, LinesWithTheirTimeCopiedSavedAndCleared) {
  const test::TemporaryFolder folder;
  Workspace workspace;
  LogPanel panel(workspace);
  panel.resize(560, 260);
  test::show(panel);
  EXPECT_FALSE(child<QPushButton>(panel, "log_save").isEnabled());
  EXPECT_EQ(panel.text(), "");
  workspace.say("first");
  workspace.complain("second\nwith a line more");
  const QStringList lines = panel.text().split('\n');
  ASSERT_EQ(lines.size(), 4) << panel.text().toStdString();
  const QRegularExpression stamped("^\\d\\d:\\d\\d:\\d\\d\\.\\d\\d\\d  (first|second)$");
  EXPECT_TRUE(stamped.match(lines[0]).hasMatch()) << lines[0].toStdString();
  EXPECT_TRUE(stamped.match(lines[1]).hasMatch()) << lines[1].toStdString();
  EXPECT_EQ(lines[2], QString(14, ' ') + "with a line more");
  test::keep_screenshot(panel.grab().toImage(), "log_panel");
  panel.setPalette(test::dark_palette());
  test::keep_screenshot(panel.grab().toImage(), "log_panel_dark");

  child<QPushButton>(panel, "log_copy").click();
  EXPECT_EQ(QApplication::clipboard()->text(), panel.text());
  auto& edit = child<QPlainTextEdit>(panel, "log_lines");
  QTextCursor cursor(edit.document());
  cursor.select(QTextCursor::Document);
  edit.setTextCursor(cursor);
  panel.copy();
  EXPECT_EQ(QApplication::clipboard()->text() + '\n', panel.text()) << "the selection, its lines apart";

  panel.write(QString::fromStdString(folder.file("atomesh.log")));
  EXPECT_EQ(test::read_bytes(folder.file("atomesh.log")), panel.text().toStdString());
  const QString before = panel.text();
  panel.write(QString::fromStdString(folder.file("none/atomesh.log")));
  EXPECT_TRUE(panel.text().size() > before.size()) << "a complaint is a line too";
  child<QPushButton>(panel, "log_clear").click();
  EXPECT_EQ(panel.text(), "");
  EXPECT_FALSE(child<QPushButton>(panel, "log_clear").isEnabled());
  for (int i = 0; i < 10050; ++i) workspace.say(QString::number(i));
  EXPECT_EQ(edit.blockCount(), 10000);
  EXPECT_TRUE(panel.text().endsWith("  10049\n"));
}

}  // namespace
