// The dialogs that save pictures and movies, and the picture in the clipboard.
#include <gtest/gtest.h>

#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QFileInfo>
#include <QGuiApplication>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTest>
#include <cstdlib>
#include <filesystem>

#include "app/gui/copy_picture.h"
#include "app/gui/movie_dialog.h"
#include "app/gui/picture_form.h"
#include "app/gui/save_picture_dialog.h"
#include "tests/app/gui/window_test.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;

class OutputDialogs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<test::TemporaryFolder>();
    crb = test::cracked_salt_crb(folder->path().string());
  }
  static void TearDownTestSuite() { folder.reset(); }
  void SetUp() override {
    workspace.set_view_size(300, 200);
    Parameters parameters;
    parameters.mode = Mode::surface;
    workspace.show_document(open_document(crb, {}, no_progress()), parameters);
  }
  static QString file(const std::string& name) { return QString::fromStdString(folder->file(name)); }
  static void press(OutputDialog& dialog, const char* button) {
    QTest::mouseClick(&child<QPushButton>(dialog, button), Qt::LeftButton);
  }
  static bool saves(OutputDialog& dialog) {
    QSignalSpy saved(&dialog, &OutputDialog::saved);
    dialog.save();
    return wait_for([&] { return saved.count() == 1; });
  }

  static inline std::unique_ptr<test::TemporaryFolder> folder;
  static inline std::string crb;
  Workspace workspace;
};

TEST_F(OutputDialogs, ThePictureIsThatOfTheModel) {
  SavePictureDialog dialog(workspace, nullptr);
  test::show(dialog);
  EXPECT_EQ(child<QSpinBox>(dialog, "picture_width").value(), 300);
  EXPECT_EQ(child<QSpinBox>(dialog, "picture_height").value(), 200);
  child<QCheckBox>(dialog, "picture_transparent").setChecked(true);
  child<QCheckBox>(dialog, "picture_scale_bar").setChecked(false);
  child<QSpinBox>(dialog, "picture_supersampling").setValue(2);
  dialog.set_path(file("dialog.png"));
  ASSERT_TRUE(saves(dialog));
  save_picture(folder->file("model.png"), *workspace.document(), workspace.shown(),
               {.width = 300,
                .height = 200,
                .transparent = true,
                .supersampling = 2,
                .parts = {.legend = true, .scale_bar = false, .tripod = true}},
               no_progress());
  EXPECT_EQ(test::read_bytes(folder->file("dialog.png")), test::read_bytes(folder->file("model.png")));
  EXPECT_FALSE(dialog.isVisible());
}

TEST_F(OutputDialogs, TheNameIsReadyToBeTypedAndFollowsWhatIsOpen) {
  MovieDialog dialog(workspace, nullptr);
  dialog.set_path(file("salt.webm"));
  test::show(dialog);
  auto& name = child<QLineEdit>(dialog, "movie_file");
  ASSERT_TRUE(wait_for([&] { return name.hasFocus(); }));
  QTest::keyClicks(&name, "turning");
  EXPECT_EQ(dialog.path(), file("turning.webm"));
  std::filesystem::copy_file(crb, folder->file("other.crb"));
  workspace.show_document(open_document(folder->file("other.crb"), {}, no_progress()));
  EXPECT_EQ(QFileInfo(dialog.path()).fileName(), "other.webm");
}

TEST_F(OutputDialogs, SizesByNameAndInRatio) {
  SavePictureDialog dialog(workspace, nullptr);
  auto& preset = child<QComboBox>(dialog, "picture_preset");
  auto& width = child<QSpinBox>(dialog, "picture_width");
  auto& height = child<QSpinBox>(dialog, "picture_height");
  auto& lock = child<QCheckBox>(dialog, "picture_lock");
  const auto choose = [&](int index) {
    preset.setCurrentIndex(index);
    emit preset.activated(index);
  };
  choose(2);
  EXPECT_EQ(width.value(), 1200);
  EXPECT_EQ(height.value(), 800);
  choose(5);
  EXPECT_EQ(width.value(), 3840);
  EXPECT_EQ(height.value(), 2160);
  width.setValue(1920);
  EXPECT_EQ(height.value(), 1080);
  EXPECT_EQ(preset.currentText(), "Free");
  height.setValue(2160);
  EXPECT_EQ(width.value(), 3840);
  lock.setChecked(false);
  height.setValue(1000);
  EXPECT_EQ(width.value(), 3840);
  lock.setChecked(true);
  width.setValue(384);
  EXPECT_EQ(height.value(), 100);
  // The view's size is followed while it is what is asked for.
  choose(0);
  workspace.set_view_size(640, 480);
  EXPECT_EQ(width.value(), 640);
  choose(3);
  workspace.set_view_size(300, 200);
  EXPECT_EQ(width.value(), 1280);
}

TEST_F(OutputDialogs, SaysWhatItWillBeAndWhatIsWrong) {
  SavePictureDialog dialog(workspace, nullptr);
  test::show(dialog);
  auto& says = child<QLabel>(dialog, "save_picture_says");
  auto& save = child<QPushButton>(dialog, "save_picture_save");
  EXPECT_TRUE(save.isEnabled());
  dialog.form().set_size(9000, 7000);
  EXPECT_TRUE(says.text().contains("63") && says.text().contains("passes")) << says.text().toStdString();
  dialog.set_path(file("a.jpg"));
  EXPECT_TRUE(says.text().contains(".png"));
  EXPECT_FALSE(save.isEnabled());
  dialog.set_path(file("no/such/a.png"));
  EXPECT_TRUE(says.text().contains("does not exist"));
  EXPECT_FALSE(save.isEnabled());
  dialog.set_path("");
  EXPECT_FALSE(save.isEnabled());
  dialog.set_path(file("a.png"));
  EXPECT_TRUE(save.isEnabled());
  workspace.close_document();
  EXPECT_FALSE(save.isEnabled());
}

TEST_F(OutputDialogs, AsksBeforeReplacing) {
  const std::string there = folder->file("there.png", "something of mine");
  SavePictureDialog dialog(workspace, nullptr);
  test::show(dialog);
  dialog.set_path(QString::fromStdString(there));
  press(dialog, "save_picture_save");
  auto& box = child<QMessageBox>(dialog, "replace");
  EXPECT_FALSE(dialog.working());
  box.reject();
  EXPECT_EQ(test::read_bytes(there), "something of mine");
  ASSERT_TRUE(wait_for([&] { return dialog.findChild<QMessageBox*>("replace") == nullptr; }));
  press(dialog, "save_picture_save");
  QSignalSpy saved(&dialog, &OutputDialog::saved);
  child<QPushButton>(dialog, "replace_yes").click();
  ASSERT_TRUE(wait_for([&] { return saved.count() == 1; }));
  EXPECT_EQ(read_png(there).width, 300);
}

TEST_F(OutputDialogs, CancellingLeavesNothingAndTheDialogOpen) {
  for (const bool movie : {false, true}) {
    std::unique_ptr<OutputDialog> dialog;
    if (movie) {
      dialog = std::make_unique<MovieDialog>(workspace, nullptr);
      child<QSpinBox>(*dialog, "movie_frames").setValue(10000);
    } else {
      dialog = std::make_unique<SavePictureDialog>(workspace, nullptr);
    }
    test::show(*dialog);
    child<PictureForm>(*dialog, "picture_form").set_size(movie ? 400 : 9000, movie ? 300 : 7000);
    dialog->set_path(file(movie ? "never.ogv" : "never.png"));
    const std::size_t before = folder->count();
    auto& progress = child<QProgressBar>(*dialog, movie ? "movie_progress" : "save_picture_progress");
    dialog->save();
    ASSERT_TRUE(wait_for([&] { return progress.maximum() > 0 && progress.value() > 0; }));
    EXPECT_TRUE(dialog->working());
    QElapsedTimer clock;
    clock.start();
    press(*dialog, movie ? "movie_cancel" : "save_picture_cancel");
    ASSERT_TRUE(wait_for([&] { return !dialog->working(); }));
    EXPECT_LT(clock.elapsed(), 2000);
    EXPECT_TRUE(dialog->isVisible());
    EXPECT_TRUE(wait_for([&] { return folder->count() == before; }));
    press(*dialog, movie ? "movie_cancel" : "save_picture_cancel");
    EXPECT_FALSE(dialog->isVisible());
  }
}

TEST_F(OutputDialogs, AMovieIsWrittenAndItsFormatGoesByTheName) {
  MovieDialog dialog(workspace, nullptr);
  test::show(dialog);
  auto& format = child<QComboBox>(dialog, "movie_format");
  auto& transparent = child<QCheckBox>(dialog, "picture_transparent");
  EXPECT_TRUE(dialog.path().endsWith(".ogv"));
  EXPECT_FALSE(transparent.isEnabled());
  dialog.set_path(file("turn.png"));
  EXPECT_TRUE(format.currentText().contains("png"));
  EXPECT_TRUE(transparent.isEnabled());
  format.setCurrentIndex(0);
  emit format.activated(0);
  EXPECT_EQ(dialog.path(), file("turn.ogv"));
  child<QSpinBox>(dialog, "movie_frames").setValue(6);
  child<QSpinBox>(dialog, "movie_rate").setValue(3);
  EXPECT_TRUE(child<QLabel>(dialog, "movie_lasts").text().contains("2"));
  child<QComboBox>(dialog, "movie_axis").setCurrentIndex(1);
  child<QComboBox>(dialog, "movie_direction").setCurrentIndex(1);
  dialog.form().set_size(64, 48);
  const TurntableSettings settings = dialog.settings();
  EXPECT_EQ(settings.axis, TurntableAxis::picture);
  EXPECT_EQ(settings.degrees, -360.0);
  EXPECT_EQ(settings.frames, 6);
  ASSERT_TRUE(saves(dialog));
  save_turntable(folder->file("model.ogv"), *workspace.document(), workspace.shown(), workspace.rotation_center(),
                 settings, no_progress());
  // But for the stream's number, which is drawn by chance.
  EXPECT_EQ(QFileInfo(file("turn.ogv")).size(), QFileInfo(file("model.ogv")).size());
}

TEST_F(OutputDialogs, WithoutFfmpegTheDialogSaysSo) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  MovieDialog dialog(workspace, nullptr);
  dialog.set_path(file("turn.mp4"));
  EXPECT_TRUE(child<QLabel>(dialog, "movie_says").text().contains("ffmpeg, which is not installed"));
  EXPECT_FALSE(child<QPushButton>(dialog, "movie_save").isEnabled());
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(OutputDialogs, TheClipboardHasTheViewWithItsOpacity) {
  Parameters parameters = workspace.parameters();
  parameters.background = Vec4f(1.0F, 1.0F, 1.0F, 0.0F);
  workspace.change(parameters, "Background");
  ViewOptions options = workspace.view_options();
  options.legend = options.scale_bar = options.tripod = false;
  workspace.set_view_options(options);
  PictureCopier copier(workspace, nullptr);
  QSignalSpy copied(&copier, &PictureCopier::copied);
  copier.copy();
  ASSERT_TRUE(wait_for([&] { return copied.count() == 1; }));
  const QImage image = QGuiApplication::clipboard()->image();
  ASSERT_EQ(image.size(), QSize(300, 200));
  EXPECT_EQ(qAlpha(image.pixel(0, 0)), 0);
  EXPECT_EQ(qAlpha(image.pixel(150, 100)), 255);
  save_picture(folder->file("saved.png"), *workspace.document(), workspace.shown(), {.width = 300, .height = 200},
               no_progress());
  EXPECT_LE(compare_images(test::to_image(image), read_png(folder->file("saved.png"))).max, 1e-6);
}

TEST_F(OutputDialogs, Looks) {
  for (const bool dark : {false, true}) {
    const QPalette before = QGuiApplication::palette();
    if (dark) QApplication::setPalette(test::dark_palette());
    SavePictureDialog picture(workspace, nullptr);
    test::show(picture);
    test::keep_screenshot(picture.grab().toImage(), dark ? "save-picture-dark" : "save-picture");
    MovieDialog movie(workspace, nullptr);
    movie.set_path(file("turn.mp4"));
    test::show(movie);
    test::keep_screenshot(movie.grab().toImage(), dark ? "movie-dark" : "movie");
    EXPECT_LT(movie.sizeHint().width(), 900);
    EXPECT_LT(movie.sizeHint().height(), 700);
    QApplication::setPalette(before);
  }
}

}  // namespace
