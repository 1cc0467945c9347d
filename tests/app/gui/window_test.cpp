#include "tests/app/gui/window_test.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QDir>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QSettings>
#include <QTest>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/virtual_display.h"
#include "app/gui/run_window.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/model_test.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::test {

bool wait_for(const std::function<bool()>& condition, int deadline_ms) {
  return wait_until(condition, deadline_ms);
}

void show(QWidget& widget) {
  widget.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&widget, 30000));
}

std::string cracked_salt_dat(const std::string& folder) {
  const std::string path = folder + "/salt.dat";
  const Sample sample = make_sample("nacl-cracked", {.atoms = 1800});
  write_atoms(path, sample.atoms, sample.unit_cell);
  return path;
}

std::string cracked_salt_crb(const std::string& folder) {
  PipelineOptions options;
  options.carve_options.radius = 2.6;
  PipelineReport report;
  const Material material = preprocess(cracked_salt_dat(folder), options, report);
  const std::string path = folder + "/salt.crb";
  write_material(path, material);
  return path;
}

Image to_image(const QImage& picture) {
  const QImage bytes = picture.convertToFormat(QImage::Format_RGBA8888);
  Image image(bytes.width(), bytes.height());
  for (int row = 0; row < image.height; ++row) {
    const uchar* byte = bytes.constScanLine(row);
    for (int column = 0; column < image.width; ++column, byte += 4) {
      image.at(column, row) = Vec4f(byte[0], byte[1], byte[2], byte[3]) / 255.0F;
    }
  }
  return image;
}

void keep_screenshot(const QImage& image, const std::string& name) {
  const char* const folder = std::getenv("ATOMESH_SCREENSHOTS");
  if (folder == nullptr) return;
  EXPECT_TRUE(image.save(QDir(folder).filePath(QString::fromStdString(name + ".png"))));
}

QPalette dark_palette() {
  QPalette dark(QColor(53, 53, 53));
  const QColor text(235, 235, 235);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText}) {
    dark.setColor(role, text);
    dark.setColor(QPalette::Disabled, role, QColor(120, 120, 120));
  }
  dark.setColor(QPalette::Base, QColor(35, 35, 35));
  dark.setColor(QPalette::AlternateBase, QColor(45, 45, 45));
  dark.setColor(QPalette::ToolTipBase, QColor(35, 35, 35));
  dark.setColor(QPalette::PlaceholderText, QColor(140, 140, 140));
  dark.setColor(QPalette::Highlight, QColor(42, 130, 218));
  dark.setColor(QPalette::HighlightedText, Qt::white);
  return dark;
}

bool has_opengl() {
  if (QGuiApplication::platformName() != "xcb") return false;
  QOpenGLContext context;
  return context.create() && context.format().version() >= std::pair(3, 2);
}

}  // namespace atomesh::test

// Tests that need no OpenGL say so by QT_QPA_PLATFORM=offscreen in their environment.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  std::optional<atomesh::cli::VirtualDisplay> display;
  if (qEnvironmentVariable("QT_QPA_PLATFORM") != "offscreen") {
    display.emplace();
    qputenv("QT_QPA_PLATFORM", display->available() ? "xcb" : "offscreen");
    if (!display->available()) {
      std::printf("no display (%s): what needs OpenGL is skipped\n", display->why_not().c_str());
    }
  }
  const atomesh::test::TemporaryFolder settings;
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, QString::fromStdString(settings.path().string()));
  std::filesystem::permissions(settings.path(), std::filesystem::perms::owner_all);
  qputenv("XDG_RUNTIME_DIR", settings.path().string().c_str());
  atomesh::gui::set_surface_format();
  int result = 0;
  {
    QApplication application(argc, argv);
    QApplication::setApplicationName("atomesh");
    QApplication::setOrganizationName("atomesh");
    result = RUN_ALL_TESTS();
  }
  return result;
}
