// What comes into the window and goes out of it: atoms by way of preprocessing, drops, parameter files, picks.
#include <QAction>
#include <QComboBox>
#include <QDropEvent>
#include <QLineEdit>
#include <QMimeData>
#include <QPushButton>
#include <QSpinBox>
#include <QStackedWidget>
#include <QTableView>

#include "app/gui/crystal_view_dialog.h"
#include "app/gui/loader_page.h"
#include "app/gui/preprocessing_page.h"
#include "app/gui/save_picture.h"
#include "app/gui/view_input.h"
#include "core/parameter_file.h"
#include "tests/app/gui/window_fixture.h"
#include "tests/core/random_parameters.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

class WindowFiles : public test::WindowFixture {
 protected:
  QWidget* page() { return child<QStackedWidget>(*window, "pages").currentWidget(); }
  void drop(const QStringList& files) {
    QMimeData data;
    QList<QUrl> urls;
    for (const QString& file : files) urls << QUrl::fromLocalFile(file);
    data.setUrls(urls);
    QWidget& target = window->viewport();
    QDragEnterEvent enter(QPoint(5, 5), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&target, &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent dropped(QPointF(5, 5), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&target, &dropped);
  }
};

TEST_F(WindowFiles, AtomsArePreprocessedThenShownAndTheResultIsTheCommandLines) {
  const std::string atoms = test::cracked_salt_dat(folder.path().string());
  window->open(QString::fromStdString(atoms));
  auto* preprocessing = window->findChild<PreprocessingPage*>();
  ASSERT_NE(preprocessing, nullptr);
  ASSERT_TRUE(wait_for([&] { return page() == preprocessing; }));
  ASSERT_TRUE(wait_for([&] { return preprocessing->run().state() == Preprocessing::State::done; }));
  test::keep_screenshot(window->grab().toImage(), "window-preprocessed");
  if (page() == preprocessing) QTest::mouseClick(&child<QPushButton>(*preprocessing, "go_on"), Qt::LeftButton);
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  EXPECT_EQ(window->workspace().document()->kind, FileKind::atoms);
  EXPECT_TRUE(std::filesystem::exists(folder.file("salt.crb")));
  EXPECT_EQ(window->viewport().worker_picture()->image.size(),
            QSize(window->workspace().width(), window->workspace().height()));
  // The file beside it opens to the very same picture.
  const QImage of_atoms = window->viewport().worker_picture()->image;
  window->open(QString::fromStdString(folder.file("salt.crb")));
  ASSERT_TRUE(wait_for(
      [&] { return window->workspace().document()->kind == FileKind::material && window->viewport().settled(); }));
  EXPECT_EQ(window->viewport().worker_picture()->image, of_atoms);
}

TEST_F(WindowFiles, DropsOpenAndApply) {
  const std::string material = test::cracked_salt_crb(folder.path().string());
  Parameters parameters = test::random_parameters(3, {"Na", "Cl"});
  parameters.mode = Mode::xray;
  parameters.volume.field.clear();
  write_crf(folder.file("view.crf"), parameters);
  window->show_view();
  drop({QString::fromStdString(material)});
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  EXPECT_EQ(window->workspace().document()->path, material);
  drop({QString::fromStdString(folder.file("view.crf"))});
  EXPECT_TRUE(wait_for([&] { return window->workspace().parameters() == parameters; }));
  child<QAction>(*window, "action_undo").trigger();
  EXPECT_EQ(window->workspace().parameters(), Parameters());
  child<QAction>(*window, "action_redo").trigger();
  EXPECT_EQ(window->workspace().parameters(), parameters);
  // A picture of the view brings it back, with what lay over it.
  save_picture(folder.file("view.png"), *window->workspace().document(), parameters,
               {.width = 40, .height = 30, .parts = {.legend = false, .scale_bar = true, .tripod = false}},
               no_progress());
  child<QAction>(*window, "action_undo").trigger();
  window->workspace().set_view_options({});
  drop({QString::fromStdString(folder.file("view.png"))});
  EXPECT_TRUE(wait_for([&] { return window->workspace().parameters() == parameters; }));
  EXPECT_EQ(window->workspace().view_options(), (ViewOptions{.legend = false, .scale_bar = true, .tripod = false}));
}

TEST_F(WindowFiles, AClickPicksTwoMeasureAndEscapeForgets) {
  open_salt();
  Workspace& workspace = window->workspace();
  workspace.set("mode", "atoms");
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  Viewport& view = window->viewport();
  const QPoint middle = view.rect().center();
  QTest::mouseClick(&view, Qt::LeftButton, Qt::NoModifier, middle);
  ASSERT_TRUE(wait_for([&] { return workspace.picks().size() == 1; }));
  const Atoms& atoms = workspace.document()->material->atoms;
  const Pick& first = workspace.picks().front();
  EXPECT_EQ(first.position, atoms.positions[first.atom]);
  // The atom is where the mouse was: within its radius.
  const Vec3 at = project(workspace.camera(), first.position);
  const Camera camera = workspace.camera();
  const double radius = atoms.species_table[atoms.species[first.atom]].radius;
  EXPECT_LT(std::hypot(at.x - camera.x_of(middle.x()), at.y - camera.y_of(middle.y())) * at.z, 1.1 * radius);
  QTest::mouseClick(&view, Qt::LeftButton, Qt::ShiftModifier, middle + QPoint(40, 10));
  ASSERT_TRUE(wait_for([&] { return workspace.picks().size() == 2; }));
  EXPECT_NE(workspace.picks()[0].atom, workspace.picks()[1].atom);
  test::keep_screenshot(window->grab().toImage(), "window-measured");
  press(Qt::Key_Escape);
  EXPECT_TRUE(workspace.picks().empty());
  QTest::mouseClick(&view, Qt::LeftButton, Qt::NoModifier, QPoint(3, 3));  // nothing there
  QTest::mouseDClick(&view, Qt::LeftButton, Qt::NoModifier, middle);
  ASSERT_TRUE(wait_for([&] { return workspace.rotation_center() != workspace.bounds().center(); }));
}

TEST_F(WindowFiles, ADragTurnsTheViewAsOneStep) {
  open_salt();
  Viewport& view = window->viewport();
  const Parameters before = window->workspace().parameters();
  const QPoint start = view.rect().center();
  QTest::mousePress(&view, Qt::LeftButton, Qt::NoModifier, start);
  for (int step = 1; step <= 5; ++step) QTest::mouseMove(&view, start + QPoint(12 * step, 4 * step));
  QTest::mouseRelease(&view, Qt::LeftButton, Qt::NoModifier, start + QPoint(60, 20));
  EXPECT_NE(window->workspace().parameters().azimuth, before.azimuth);
  EXPECT_NE(window->workspace().parameters().elevation, before.elevation);
  ASSERT_TRUE(wait_for([&] { return view.settled(); }));
  EXPECT_EQ(view.worker_picture()->image, to_qimage(picture_of_cli()));
  child<QAction>(*window, "action_undo").trigger();
  EXPECT_EQ(window->workspace().parameters(), before);
}

TEST_F(WindowFiles, LooksAlongTheCrystal) {
  open_salt();
  child<QAction>(*window, "action_crystal_view").trigger();
  auto& dialog = child<CrystalViewDialog>(*window, "crystal_view");
  child<QSpinBox>(dialog, "crystal_view_1").setValue(1);
  child<QSpinBox>(dialog, "crystal_view_2").setValue(1);
  child<QSpinBox>(dialog, "crystal_view_3").setValue(0);
  QTest::mouseClick(&child<QPushButton>(dialog, "crystal_view_look"), Qt::LeftButton);
  const UnitCell& cell = *window->workspace().document()->material->unit_cell;
  const Vec3 along = glm::normalize(cell.primitive[0] + cell.primitive[1]);
  EXPECT_NEAR(glm::dot(window->workspace().camera().forward, along), 1.0, 1e-12);
  test::keep_screenshot(dialog.grab().toImage(), "window-crystal");
}

TEST_F(WindowFiles, AClusterIsFlownToAndMarked) {
  open_salt();
  auto& table = child<QTableView>(*window, "defect_table");
  ASSERT_TRUE(wait_for([&] { return table.model()->rowCount() > 0; }));
  const Parameters before = window->workspace().parameters();
  table.selectRow(0);
  ASSERT_TRUE(wait_for([&] { return !window->workspace().marks().empty(); }));
  EXPECT_NE(window->workspace().parameters(), before);
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  test::keep_screenshot(window->grab().toImage(), "window-cluster");
}

}  // namespace
