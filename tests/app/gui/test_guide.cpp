// The pictures of the user guide are what the window shows today: each is made anew by using the window as the guide
// says, and compared with the one in app/gui/guide. Where that has changed on purpose, renew them:
//   ATOMESH_GUIDE_PICTURES=app/gui/guide build/dev/tests/app/gui/test_guide     (then look at them)
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QFile>
#include <QFont>
#include <QLabel>
#include <QLockFile>
#include <QPainter>
#include <QPushButton>
#include <QRegularExpression>
#include <QSettings>
#include <QSpinBox>
#include <QTableView>
#include <cstdlib>
#include <filesystem>

#include "app/gui/copy_picture.h"
#include "app/gui/defect_dock.h"
#include "app/gui/help_window.h"
#include "app/gui/loader_page.h"
#include "app/gui/main_window.h"
#include "app/gui/movie_dialog.h"
#include "app/gui/picture_form.h"
#include "app/gui/preprocessing_page.h"
#include "app/gui/save_picture_dialog.h"
#include "app/gui/theme.h"
#include "app/gui/viewport.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/window_test.h"

namespace {

namespace fs = std::filesystem;
using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

const fs::path guide = fs::path(ATOMESH_SOURCE_DIR) / "app/gui/guide";

// A folder whose name can stand in a picture; one test at a time.
class Crystals {
 public:
  Crystals() : lock_(QString::fromStdString((fs::temp_directory_path() / "crystals.lock").string())) {
    lock_.lock();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const auto& [name, kind] : {std::pair("nacl.dat", "nacl-cracked"), {"diamond.dat", "diamond-vacancy"}}) {
      const Sample sample = make_sample(kind, {.atoms = 6000});
      write_atoms(file(name), sample.atoms, sample.unit_cell);
    }
  }
  ~Crystals() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Crystals(const Crystals&) = delete;
  Crystals& operator=(const Crystals&) = delete;
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

 private:
  QLockFile lock_;
  fs::path folder_ = fs::temp_directory_path() / "crystals";
};

// Seen from so far that letters are gray: fonts, times and the theme's small print may differ, nothing else.
double resemblance(const QImage& a, const QImage& b) {
  const QSize far(a.width() / 8, a.height() / 8);
  const auto seen = [&](const QImage& image) {
    return test::to_image(
        image.convertToFormat(QImage::Format_RGB32).scaled(far, Qt::IgnoreAspectRatio, Qt::SmoothTransformation));
  };
  return compare_images(seen(a), seen(b)).psnr;
}

// 128 levels a channel: two thirds of the size as a PNG, and nobody sees it.
QImage with_fewer_colors(const QImage& image) {
  QImage fewer = image.convertToFormat(QImage::Format_RGB888);
  for (int row = 0; row < fewer.height(); ++row) {
    uchar* line = fewer.scanLine(row);
    for (int i = 0; i < 3 * fewer.width(); ++i) line[i] = static_cast<uchar>((line[i] * 127 + 127) / 255 * 255 / 127);
  }
  return fewer;
}

class Guide : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { crystals = std::make_unique<Crystals>(); }
  static void TearDownTestSuite() { crystals.reset(); }

  void SetUp() override {
    if (!test::has_opengl()) GTEST_SKIP() << "no display with OpenGL";
    QFont font("DejaVu Sans");
    font.setPointSizeF(9.0);
    font.setStyleStrategy(QFont::NoSubpixelAntialias);
    QApplication::setFont(font);
    QSettings().clear();
    theme = std::make_unique<ThemeKeeper>();
    theme->choose(Theme::light);
    for (const char* made : {"nacl.crb", "diamond.crb"}) fs::remove(crystals->file(made));
    window = std::make_unique<MainWindow>();
    window->resize(1140, 630);
    test::show(*window);
  }
  void TearDown() override { window.reset(); }

  // Preprocessed in the window, as the guide does.
  void open(const std::string& name = "nacl.dat") {
    window->open(QString::fromStdString(crystals->file(name)));
    ASSERT_TRUE(wait_for([&] { return child<PreprocessingPage>(*window, "preprocessing").isVisible(); }));
    go_on();
  }
  void go_on() {
    auto& button = child<QPushButton>(*window, "go_on");
    ASSERT_TRUE(wait_for([&] { return window->workspace().document().has_value() || button.isVisible(); }));
    if (!window->workspace().document()) button.click();
    ASSERT_TRUE(wait_for([&] { return window->workspace().document() && window->viewport().settled(); }));
  }
  void set(const std::string& key, const std::string& value) {
    window->workspace().set(key, value);
    ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  }
  void raise(const char* dock) { child<QDockWidget>(*window, dock).raise(); }

  static void check(const QImage& shown, const std::string& name, double at_least = 26.0) {
    const fs::path kept = guide / (name + ".png");
    if (const char* folder = std::getenv("ATOMESH_GUIDE_PICTURES")) {
      const QString file = QString::fromStdString((fs::path(folder) / (name + ".png")).string());
      ASSERT_TRUE(with_fewer_colors(shown).save(file, "PNG", 0)) << file.toStdString();
      return;
    }
    test::keep_screenshot(shown, "guide-" + name);
    const QImage expected(QString::fromStdString(kept.string()));
    ASSERT_FALSE(expected.isNull()) << kept << " is missing; see the head of this test";
    EXPECT_LT(fs::file_size(kept), 150'000U) << kept;
    ASSERT_EQ(expected.size(), shown.size()) << kept << " is another picture; see the head of this test";
    EXPECT_GT(resemblance(shown, expected), at_least) << kept << " shows it otherwise; see the head of this test";
  }

  static inline std::unique_ptr<Crystals> crystals;
  std::unique_ptr<ThemeKeeper> theme;
  std::unique_ptr<MainWindow> window;
};

TEST_F(Guide, Loader) {
  window->show_loader();
  auto& loader = child<LoaderPage>(*window, "loader");
  loader.set_file(QString::fromStdString(crystals->file("nacl.dat")));
  ASSERT_TRUE(wait_for([&] { return loader.summary().has_value(); }));
  check(loader.grab().toImage(), "loader");
}

TEST_F(Guide, Preprocessing) {
  auto& page = child<PreprocessingPage>(*window, "preprocessing");
  // Stays to be looked at.
  child<QAbstractButton>(*window, "automatic").setChecked(false);
  window->open(QString::fromStdString(crystals->file("nacl.dat")));
  ASSERT_TRUE(wait_for([&] { return page.isVisible(); }));
  auto& go_on = child<QPushButton>(*window, "go_on");
  ASSERT_TRUE(wait_for([&] { return go_on.isVisible() && go_on.isEnabled(); }));
  check(page.grab().toImage(), "preprocessing");
}

TEST_F(Guide, TheWindow) {
  open();
  check(window->grab().toImage(), "window");
}

TEST_F(Guide, Modes) {
  open();
  QImage row(5 * 220 + 4 * 8, 200, QImage::Format_RGB32);
  row.fill(Qt::white);
  QPainter painter(&row);
  for (int mode = 0; mode < 5; ++mode) {
    Parameters parameters = window->workspace().shown();
    parameters.mode = static_cast<Mode>(mode);
    const PictureStudio studio(*window->workspace().document(), parameters,
                               {.width = 220, .height = 200, .supersampling = 2}, no_progress());
    painter.drawImage(mode * 228, 0, to_clipboard_image(studio.draw(studio.parameters(), std::nullopt, no_progress())));
  }
  painter.end();
  check(row, "modes", 35.0);
}

TEST_F(Guide, DisplayOptions) {
  open();
  raise("display_options_dock");
  window->resize(1240, 630);  // its column is the widest
  auto& dock = child<QDockWidget>(*window, "display_options_dock");
  ASSERT_TRUE(wait_for([&] { return dock.widget()->isVisible() && window->width() == 1240; }));
  window->resizeDocks({&dock}, {440}, Qt::Horizontal);
  set("mode", "surface");
  set("cut_plane.1.enabled", "true");
  set("cut_plane.1.normal", "1,1,0");
  const Vec3 middle = window->workspace().bounds().center();
  set("cut_plane.1.distance", std::to_string(middle.x + middle.y));
  check(window->grab().toImage(), "display-options");
}

TEST_F(Guide, Defects) {
  open("diamond.dat");
  set("mode", "atoms");
  set("atoms.regular_opacity", "0");
  auto& table = child<QTableView>(*window, "defect_table");
  ASSERT_TRUE(wait_for([&] { return table.model()->rowCount() > 0; }));
  table.selectRow(0);
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled() && !window->workspace().marks().empty(); }));
  check(window->grab().toImage(), "defects");
}

TEST_F(Guide, ColorMap) {
  open("diamond.dat");
  set("mode", "volume");
  raise("color_map_editor_dock");
  auto& editor = child<QWidget>(*window, "color_map_editor");
  ASSERT_TRUE(wait_for([&] { return editor.isVisible(); }));
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  check(window->grab().toImage(), "color-map");
}

TEST_F(Guide, SavingPicturesAndMovies) {
  open();
  child<QAction>(*window, "action_save_picture").trigger();
  auto& picture = child<SavePictureDialog>(*window, "save_picture");
  ASSERT_TRUE(wait_for([&] { return picture.isVisible(); }));
  auto& preset = child<QComboBox>(picture, "picture_preset");
  preset.setCurrentIndex(5);
  emit preset.activated(5);
  picture.adjustSize();
  check(picture.grab().toImage(), "save-picture");
  picture.hide();
  child<QAction>(*window, "action_movie").trigger();
  auto& movie = child<MovieDialog>(*window, "movie");
  ASSERT_TRUE(wait_for([&] { return movie.isVisible(); }));
  movie.form().set_size(1280, 720);
  movie.adjustSize();
  check(movie.grab().toImage(), "movie");
  // And they save what the view shows, from the menu to the file.
  movie.form().set_size(64, 48);
  child<QSpinBox>(movie, "movie_frames").setValue(3);
  movie.set_path(QString::fromStdString(crystals->file("turn.ogv")));
  bool saved = false;
  QObject::connect(&movie, &OutputDialog::saved, [&] { saved = true; });
  movie.save();
  EXPECT_TRUE(wait_for([&] { return saved; }));
  EXPECT_GT(fs::file_size(crystals->file("turn.ogv")), 1000U);
}

// As the guide says: a saved picture brings back its view, also in a window where nothing is open.
TEST_F(Guide, ASavedPictureBringsBackItsView) {
  open();
  set("mode", "surface");
  set("view.azimuth", "77.25");
  set("surface.color", "#123456");
  const Parameters parameters = window->workspace().parameters();
  child<QAction>(*window, "action_save_picture").trigger();
  auto& dialog = child<SavePictureDialog>(*window, "save_picture");
  dialog.form().set_size(120, 90);
  const QString png = QString::fromStdString(crystals->file("view.png"));
  dialog.set_path(png);
  bool saved = false;
  QObject::connect(&dialog, &OutputDialog::saved, [&] { saved = true; });
  dialog.save();
  ASSERT_TRUE(wait_for([&] { return saved; }));
  // Over what is open: one change that can be undone.
  set("view.azimuth", "10");
  window->open(png);
  ASSERT_TRUE(wait_for([&] { return window->workspace().parameters() == parameters; }));
  window->workspace().undo();
  EXPECT_EQ(window->workspace().parameters().azimuth, 10.0);
  window = std::make_unique<MainWindow>();
  test::show(*window);
  window->open(png);
  ASSERT_TRUE(wait_for([&] { return window->workspace().document().has_value(); }));
  EXPECT_EQ(window->workspace().parameters(), parameters);
}

TEST_F(Guide, Help) {
  HelpWindow help;
  help.resize(820, 560);
  test::show(help);
  help.show_topic("volume-surface");
  check(help.grab().toImage(), "help");
}

// Every picture of the text is there, and every picture there is in the text.
TEST(GuideText, ShowsItsPictures) {
  QFile text(QString::fromStdString((guide / "guide.md").string()));
  ASSERT_TRUE(text.open(QIODevice::ReadOnly));
  const QString guide_text = QString::fromUtf8(text.readAll());
  QSet<QString> shown;
  const QRegularExpression picture(R"(!\[[^\]]+\]\(([^)]+)\))");
  for (auto it = picture.globalMatch(guide_text); it.hasNext();) shown << it.next().captured(1);
  QSet<QString> there;
  for (const auto& entry : fs::directory_iterator(guide)) {
    if (entry.path().extension() == ".png") there << QString::fromStdString(entry.path().filename().string());
  }
  EXPECT_EQ(shown, there);
  EXPECT_GE(there.size(), 10);
}

// What the guide calls by name is called so in the window.
TEST(GuideText, NamesWhatTheWindowHas) {
  if (!test::has_opengl()) GTEST_SKIP() << "no display with OpenGL";
  QFile text(QString::fromStdString((guide / "guide.md").string()));
  ASSERT_TRUE(text.open(QIODevice::ReadOnly));
  const QString guide_text = QString::fromUtf8(text.readAll());
  MainWindow window;
  QSet<QString> names;
  for (const QAction* action : window.findChildren<QAction*>()) names << action->text().remove('&').remove(u'…');
  for (const QDockWidget* dock : window.findChildren<QDockWidget*>()) names << dock->windowTitle();
  const QRegularExpression entry(R"(\*\*[A-Z][a-z]+ › ([^*]+)\*\*)");
  int found = 0;
  for (auto it = entry.globalMatch(guide_text); it.hasNext(); ++found) {
    const QString name = it.next().captured(1);
    EXPECT_TRUE(names.contains(name)) << name.toStdString();
  }
  EXPECT_GT(found, 8);
}

}  // namespace
