// The list of defects: what was planted in a sample is in it, where it was planted; and its table, driven by clicks and
// keys.
#include <gtest/gtest.h>

#include <QAbstractItemModelTester>
#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QTableView>
#include <QTest>
#include <algorithm>

#include "app/cli/defect_table.h"
#include "app/gui/defect_dock.h"
#include "app/gui/defect_list.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/crystal.h"
#include "samples/samples.h"
#include "tests/app/gui/window_test.h"
#include "tests/app/program.h"
#include "tests/support/lattices.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

constexpr MaterialParts everything{};
constexpr MaterialParts surface_only{
    .atoms = true, .tetrahedra = false, .surface = true, .defects = false, .fields = false};

// A periodic block of copper with 3 vacancies and a pair of them, two atoms between the others, and one of gold in
// place of copper; preprocessed once for all tests.
class Copper {
 public:
  Copper() {
    const UnitCell cell = fcc_cell("Cu", edge);
    Atoms atoms = test::periodic_block(cell, 12, 12, 12);
    for (const Vec3& place : {Vec3(2.0, 2.0, 2.0), Vec3(9.0, 3.0, 5.0), Vec3(3.0, 9.0, 8.0), Vec3(8.0, 8.0, 2.0)}) {
      vacancies.push_back(test::remove_nearest(atoms, place * edge));
    }
    vacancies.push_back(test::remove_nearest(atoms, vacancies.back() + Vec3(0.5, 0.5, 0.0) * edge));
    for (const Vec3& place : {Vec3(6.5, 6.5, 6.5), Vec3(6.5, 2.5, 9.5)}) {
      extras.push_back(place * edge);
      atoms.positions.push_back(extras.back());
      atoms.species.push_back(0);
    }
    gold = 5 * 4 * 12 * 12 + 5 * 4 * 12 + 4 * 9;  // an atom inside, not near any of the others
    atoms.species[gold] = atoms.add_species("Au");
    gold_place = atoms.positions[gold];
    const std::string text = folder.file("copper.dat");
    write_atoms(text, atoms, cell);
    PipelineReport report;
    path = folder.file("copper.crb");
    write_material(path, preprocess(text, {}, report));
  }
  static constexpr double edge = 3.615;
  std::vector<Vec3> vacancies;
  std::vector<Vec3> extras;
  Index gold = 0;
  Vec3 gold_place{0.0};
  test::TemporaryFolder folder;
  std::string path;
};

const Copper& copper() {
  static const Copper made;
  return made;
}

class DefectListTest : public ::testing::Test {
 protected:
  void open(const MaterialParts& parts = everything) {
    Parameters parameters;
    parameters.mode = Mode::surface;
    workspace.show_document(open_document(copper().path, parts, no_progress()), parameters);
  }
  void open_and_wait(DefectList& list) {
    open();
    list.set_wanted(true);
    ASSERT_TRUE(wait_for([&] { return list.state() == DefectList::State::ready; }));
  }
  Workspace workspace;
};

TEST_F(DefectListTest, EverythingPlantedIsARowAtItsPlace) {
  DefectList list(workspace);
  const QAbstractItemModelTester tester(&list, QAbstractItemModelTester::FailureReportingMode::Fatal);
  open_and_wait(list);
  // Of the one row whose middle is there.
  const auto row_at = [&](const Vec3& place) {
    std::optional<int> found;
    for (int row = 0; row < list.rowCount(); ++row) {
      if (glm::length(list.cluster(row).centre - place) > 0.01) continue;
      EXPECT_FALSE(found) << "two rows at one place";
      found = row;
    }
    if (!found) throw std::runtime_error("no row there");
    return *found;
  };
  const auto text = [&](int row, int column) { return list.index(row, column).data().toString(); };
  const Copper& planted = copper();
  for (int i = 0; i < 3; ++i) {
    const int row = row_at(planted.vacancies[static_cast<std::size_t>(i)]);
    EXPECT_EQ(text(row, DefectList::kind), "Vacancy");
    EXPECT_EQ(text(row, DefectList::vacancies), "1");
    EXPECT_EQ(text(row, DefectList::extras), "0");
    EXPECT_NEAR(list.cluster(row).centre.x, planted.vacancies[static_cast<std::size_t>(i)].x, 0.001);
    EXPECT_EQ(text(row, DefectList::x), QString::number(list.cluster(row).centre.x, 'f', 2));
  }
  const int pair = row_at(0.5 * (planted.vacancies[3] + planted.vacancies[4]));
  EXPECT_EQ(text(pair, DefectList::vacancies), "2");
  for (const Vec3& place : planted.extras) {
    const int row = row_at(place);
    EXPECT_EQ(text(row, DefectList::kind), "Extra atom");
    EXPECT_EQ(text(row, DefectList::extras), "1");
  }
  const int substituted = row_at(planted.gold_place);
  EXPECT_EQ(text(substituted, DefectList::kind), "Substitution");
  EXPECT_EQ(text(substituted, DefectList::substitutions), "1");
  EXPECT_EQ(list.rowCount(), 7) << "and nothing else";
  EXPECT_EQ(list.count(DefectKind::vacancy), 4U);
  EXPECT_EQ(list.count(DefectKind::extra), 2U);
  EXPECT_EQ(list.count(DefectKind::substitution), 1U);
  EXPECT_EQ(list.message(), "");
}

// The samples' own truth.
TEST_F(DefectListTest, VacanciesOfASampleAreRows) {
  const test::TemporaryFolder folder;
  const Sample sample = make_sample("diamond-vacancy", {.atoms = 4000});
  write_atoms(folder.file("diamond.dat"), sample.atoms, sample.unit_cell);
  PipelineReport report;
  write_material(folder.file("diamond.crb"), preprocess(folder.file("diamond.dat"), {}, report));
  DefectList list(workspace);
  workspace.show_document(open_document(folder.file("diamond.crb"), everything, no_progress()));
  list.set_wanted(true);
  ASSERT_TRUE(wait_for([&] { return list.state() == DefectList::State::ready; }));
  ASSERT_FALSE(sample.truth.vacancies.empty());
  EXPECT_EQ(list.count(), sample.truth.vacancies.size());
  for (const SampleTruth::Site& site : sample.truth.vacancies) {
    bool found = false;
    for (int row = 0; row < list.rowCount(); ++row) {
      found = found || glm::length(site.position - list.cluster(row).centre) < 0.01;
    }
    EXPECT_TRUE(found) << site.position.x << ' ' << site.position.y << ' ' << site.position.z;
  }
}

TEST_F(DefectListTest, TextIsThatOfTheCommandLine) {
  DefectList list(workspace);
  open_and_wait(list);
  const atomesh::testing::Workplace workplace;
  const auto from_program = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"defects", copper().path, "--csv", "cli.csv"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const atomesh::testing::Outcome outcome = workplace.run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return workplace.read("cli.csv");
  };
  list.write_csv(workplace.path("window.csv").string());
  EXPECT_EQ(workplace.read("window.csv"), from_program({}));
  for (const DefectKind kind : defect_kinds) {
    list.set_kind(kind);
    EXPECT_EQ(list.csv(), from_program({"--kind", std::string(defect_kind_name(kind))}));
  }
}

TEST_F(DefectListTest, SortsByEveryColumnAndBack) {
  DefectList list(workspace);
  const QAbstractItemModelTester tester(&list, QAbstractItemModelTester::FailureReportingMode::Fatal);
  open_and_wait(list);
  ASSERT_GT(list.rowCount(), 2);
  const std::string as_found = list.csv();
  for (int column = 1; column < DefectList::columns; ++column) {
    list.sort(column, Qt::AscendingOrder);
    for (int row = 1; row < list.rowCount(); ++row) {
      EXPECT_LE(list.index(row - 1, column).data().toDouble(), list.index(row, column).data().toDouble()) << column;
    }
    list.sort(column, Qt::DescendingOrder);
    for (int row = 1; row < list.rowCount(); ++row) {
      EXPECT_GE(list.index(row - 1, column).data().toDouble(), list.index(row, column).data().toDouble()) << column;
    }
  }
  list.sort(-1);
  EXPECT_EQ(list.csv(), as_found);
}

TEST_F(DefectListTest, WhoHoldsARowKeepsItWhenRowsAreSorted) {
  DefectList list(workspace);
  open_and_wait(list);
  const QPersistentModelIndex kept = list.index(1, DefectList::x);
  const QString x = kept.data().toString();
  const QString z = kept.sibling(kept.row(), DefectList::z).data().toString();
  list.sort(DefectList::z, Qt::DescendingOrder);
  ASSERT_TRUE(kept.isValid());
  EXPECT_EQ(kept.data().toString(), x);
  EXPECT_EQ(kept.sibling(kept.row(), DefectList::z).data().toString(), z);
}

TEST_F(DefectListTest, CountsOfKindsAddUp) {
  DefectList list(workspace);
  open_and_wait(list);
  std::size_t sum = 0;
  for (const DefectKind kind : defect_kinds) {
    list.set_kind(kind);
    EXPECT_EQ(static_cast<std::size_t>(list.rowCount()), list.count(kind));
    sum += list.count(kind);
    EXPECT_EQ(list.message().isEmpty(), list.count(kind) > 0);
  }
  EXPECT_EQ(sum, list.count());
}

TEST_F(DefectListTest, MissingPartsAreReadOnceSomebodyLooks) {
  DefectList list(workspace);
  open(surface_only);
  EXPECT_EQ(list.state(), DefectList::State::nothing_open);
  EXPECT_FALSE(workspace.has_parts({.atoms = false, .tetrahedra = false, .surface = false, .defects = true}));
  list.set_wanted(true);
  EXPECT_EQ(list.state(), DefectList::State::working);
  EXPECT_FALSE(list.message().isEmpty());
  ASSERT_TRUE(wait_for([&] { return list.state() == DefectList::State::ready; }));
  EXPECT_GT(list.count(), 0U);
}

TEST_F(DefectListTest, WithoutDefectsItSaysWhatToDo) {
  DefectList list(workspace);
  list.set_wanted(true);
  EXPECT_EQ(list.state(), DefectList::State::nothing_open);
  EXPECT_TRUE(list.message().contains("Open a file"));
  Document document = open_document(copper().path, everything, no_progress());
  Material material = *document.material;
  material.defects = {};
  document.material = std::make_shared<const Material>(material);
  workspace.show_document(document);
  EXPECT_EQ(list.state(), DefectList::State::no_defect_values);
  EXPECT_TRUE(list.message().contains("unit cell"));
  material.defects.positional.assign(material.atoms.size(), 0.0F);
  material.defects.extra = material.defects.vacancy = material.defects.positional;
  document.material = std::make_shared<const Material>(material);
  workspace.show_document(document);
  ASSERT_TRUE(wait_for([&] { return list.state() == DefectList::State::ready; }));
  EXPECT_EQ(list.count(), 0U);
  EXPECT_TRUE(list.message().contains("No defects"));
  material.atoms = {};
  material.defects = {};
  document.kind = FileKind::mesh;
  document.material = std::make_shared<const Material>(material);
  workspace.show_document(document);
  EXPECT_EQ(list.state(), DefectList::State::no_atoms);
}

TEST_F(DefectListTest, AnotherDocumentMeanwhileIsTheOneThatCounts) {
  DefectList list(workspace);
  list.set_wanted(true);
  open();
  EXPECT_EQ(list.state(), DefectList::State::working);
  open();
  workspace.close_document();
  open();
  ASSERT_TRUE(wait_for([&] { return list.state() == DefectList::State::ready; }));
  EXPECT_GT(list.count(), 0U);
  workspace.close_document();
  EXPECT_EQ(list.state(), DefectList::State::nothing_open);
  EXPECT_EQ(list.rowCount(), 0);
}

TEST_F(DefectListTest, AnAtomKnowsItsRow) {
  DefectList list(workspace);
  open_and_wait(list);
  for (int row = 0; row < list.rowCount(); ++row) {
    for (const Index atom : list.cluster(row).atoms) EXPECT_EQ(list.row_of_atom(atom), row);
  }
  EXPECT_EQ(list.row_of_atom(no_index), std::nullopt);
}

class DefectDockTest : public DefectListTest {
 protected:
  DefectDockTest() {
    dock.resize(760, 360);
    test::show(dock);
  }
  void open_and_wait() {
    open();
    ASSERT_TRUE(wait_for([&] { return dock.list().state() == DefectList::State::ready; }));
  }
  QTableView& table() { return child<QTableView>(dock, "defect_table"); }
  void click(int row) {
    const QModelIndex index = table().model()->index(row, DefectList::atoms);
    table().scrollTo(index);
    QTest::mouseClick(table().viewport(), Qt::LeftButton, {}, table().visualRect(index).center());
  }
  // The point looked at.
  Vec3 focus() const { return workspace.bounds().center() + workspace.parameters().pan; }
  DefectDock dock{workspace};
};

TEST_F(DefectDockTest, AClickFliesThereAndMarksIt) {
  open_and_wait();
  const Parameters before = workspace.parameters();
  click(1);
  const DefectCluster& cluster = dock.list().cluster(1);
  EXPECT_LT(glm::length(focus() - cluster.centre), 1e-9);
  EXPECT_GT(workspace.parameters().zoom, before.zoom);
  EXPECT_EQ(workspace.rotation_center(), cluster.centre);
  ASSERT_EQ(workspace.marks().size(), 1U);
  EXPECT_EQ(workspace.marks()[0].position, cluster.centre);
  EXPECT_EQ(workspace.marks()[0].radius, cluster.radius);
  EXPECT_EQ(workspace.marks()[0].text, defect_kind_label(cluster.kind).toStdString());
  test::keep_screenshot(dock.grab().toImage(), "defect_dock_clicked");
  // Away, and back by the same row.
  workspace.set("view.pan", "1,2,3");
  click(1);
  EXPECT_LT(glm::length(focus() - cluster.centre), 1e-9);
}

TEST_F(DefectDockTest, ArrowKeysGoThroughTheListInOneStep) {
  open_and_wait();
  const Parameters before = workspace.parameters();
  ASSERT_GE(dock.list().rowCount(), 3);
  click(0);
  QTest::keyClick(&table(), Qt::Key_Down);
  EXPECT_LT(glm::length(focus() - dock.list().cluster(1).centre), 1e-9);
  QTest::keyClick(&table(), Qt::Key_Down);
  EXPECT_LT(glm::length(focus() - dock.list().cluster(2).centre), 1e-9);
  EXPECT_EQ(workspace.marks()[0].position, dock.list().cluster(2).centre);
  workspace.undo();
  EXPECT_EQ(workspace.parameters(), before);
}

TEST_F(DefectDockTest, OnlyMarkedWhereFlyingIsOff) {
  open_and_wait();
  child<QCheckBox>(dock, "defect_flying").click();
  const Parameters before = workspace.parameters();
  click(0);
  EXPECT_EQ(workspace.parameters(), before);
  EXPECT_EQ(workspace.marks().size(), 1U);
}

TEST_F(DefectDockTest, KindsFilterAndTakeTheMarkAway) {
  open_and_wait();
  click(0);
  auto& kinds = child<QComboBox>(dock, "defect_kinds");
  ASSERT_EQ(kinds.count(), 6);
  EXPECT_TRUE(kinds.itemText(0).contains(QString::number(dock.list().count()))) << kinds.itemText(0).toStdString();
  kinds.setFocus();
  QTest::keyClick(&kinds, Qt::Key_Down);  // vacancies
  EXPECT_EQ(dock.list().shown_kind(), DefectKind::vacancy);
  EXPECT_TRUE(workspace.marks().empty());
  EXPECT_EQ(dock.list().rowCount(), 4);
  for (int i = 0; i < 3; ++i) QTest::keyClick(&kinds, Qt::Key_Down);  // positional: there are none
  EXPECT_EQ(dock.list().shown_kind(), DefectKind::positional);
  EXPECT_EQ(dock.list().rowCount(), 0);
  EXPECT_EQ(child<QStackedWidget>(dock, "defect_pages").currentWidget()->objectName(), "defect_message");
  EXPECT_FALSE(child<QPushButton>(dock, "defect_export").isEnabled());
  QTest::keyClick(&kinds, Qt::Key_Home);
  EXPECT_EQ(static_cast<std::size_t>(dock.list().rowCount()), dock.list().count());
}

TEST_F(DefectDockTest, AClickOnAHeadingSorts) {
  open_and_wait();
  click(0);
  const Vec3 marked = workspace.marks()[0].position;
  QHeaderView& header = *table().horizontalHeader();
  const QPoint at(header.sectionViewportPosition(DefectList::x) + 10, header.height() / 2);
  QTest::mouseClick(header.viewport(), Qt::LeftButton, {}, at);
  for (int row = 1; row < dock.list().rowCount(); ++row) {
    EXPECT_LE(dock.list().cluster(row - 1).centre.x, dock.list().cluster(row).centre.x);
  }
  EXPECT_EQ(dock.list().cluster(table().currentIndex().row()).centre, marked) << "the same cluster stays selected";
}

TEST_F(DefectDockTest, OfAPickedAtomTheClusterIsSelected) {
  open_and_wait();
  const Index atom = dock.list().cluster(2).atoms.front();
  EXPECT_TRUE(dock.select_atom(atom));
  EXPECT_EQ(table().currentIndex().row(), 2);
  EXPECT_EQ(workspace.marks()[0].position, dock.list().cluster(2).centre);
}

TEST_F(DefectDockTest, LooksRight) {
  test::keep_screenshot(dock.grab().toImage(), "defect_dock_empty");
  open_and_wait();
  click(1);
  test::keep_screenshot(dock.grab().toImage(), "defect_dock");
  dock.setPalette(test::dark_palette());
  test::keep_screenshot(dock.grab().toImage(), "defect_dock_dark");
  EXPECT_TRUE(child<QLabel>(dock, "defect_summary").text().contains(QString::number(dock.list().count())));
}

}  // namespace
