// The window's parameter files: names, round trip, one step of the history, messages.
#include <gtest/gtest.h>

#include <QDir>
#include <QFile>
#include <QSettings>
#include <QTemporaryDir>

#include "app/gui/parameter_files.h"
#include "app/gui/workspace.h"
#include "core/error.h"
#include "tests/core/random_parameters.h"

namespace atomesh::gui {
namespace {

class ParameterFiles : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(folder_.isValid());
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder_.path());
  }
  std::string path(const char* name) const { return folder_.filePath(name).toStdString(); }
  void write(const char* name, const char* text) const {
    QFile file(folder_.filePath(name));
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(text);
  }
  QTemporaryDir folder_;
};

std::optional<Document> document_at(const std::string& path) {
  Document document;
  document.path = path;
  document.material = std::make_shared<Material>();
  return document;
}

TEST_F(ParameterFiles, NamesFollowTheDataSet) {
  const auto document = document_at("/data/x/nacl.cracked.crb");
  EXPECT_EQ(parameter_file_path("default", document), "/data/x/nacl.cracked.crf");
  EXPECT_EQ(parameter_file_path("", document), "/data/x/nacl.cracked.crf");
  EXPECT_EQ(parameter_file_path(" Default ", document), "/data/x/nacl.cracked.crf");
  EXPECT_EQ(parameter_file_path("mine", document), "/data/x/mine.crf");
  EXPECT_EQ(parameter_file_path("../mine.crf", document), "/data/mine.crf");
  EXPECT_EQ(parameter_file_path("/y/mine.crf", document), "/y/mine.crf");
  EXPECT_EQ(parameter_file_path("/y/mine", std::nullopt), "/y/mine.crf");
  EXPECT_THROW(parameter_file_path("default", std::nullopt), UsageError);
}

TEST_F(ParameterFiles, RandomParametersComeBack) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Workspace workspace;
    const Parameters before = workspace.parameters();
    const Parameters random = test::random_parameters(seed, {"Na", "Cl", "a.b", "1"});
    workspace.change(random, "random");
    save_parameter_file(workspace, path("random.crf"));
    workspace.undo();
    ASSERT_EQ(workspace.parameters(), before);
    load_parameter_file(workspace, path("random.crf"));
    ASSERT_EQ(workspace.parameters(), random) << seed;
    EXPECT_EQ(workspace.history().undo_name(), "Load random.crf");
    workspace.undo();
    ASSERT_EQ(workspace.parameters(), before);
    workspace.redo();
    ASSERT_EQ(workspace.parameters(), random);
  }
}

TEST_F(ParameterFiles, AMistakeIsNamedWithItsLineAndChangesNothing) {
  Workspace workspace;
  workspace.set("xray.alpha_length", "0.5");
  const Parameters before = workspace.parameters();
  write("bad.crf", "mode = \"surface\"\n\n[volume_surface]\nface_alpha = 7\n");
  try {
    load_parameter_file(workspace, path("bad.crf"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(path("bad.crf") + ":4: ")) << error.what();
  }
  EXPECT_EQ(workspace.parameters(), before);
  EXPECT_THROW(load_parameter_file(workspace, path("none.crf")), InputError);
  EXPECT_TRUE(recent_parameter_files().isEmpty());
}

TEST_F(ParameterFiles, AFileOfAnotherKindIsNotReplaced) {
  write("notes.txt", "buy milk\n");
  Workspace workspace;
  EXPECT_THROW(save_parameter_file(workspace, path("notes.txt")), UsageError);
  QFile file(folder_.filePath("notes.txt"));
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  EXPECT_EQ(file.readAll(), "buy milk\n");
  EXPECT_NO_THROW(save_parameter_file(workspace, path("new.txt")));
  EXPECT_NO_THROW(save_parameter_file(workspace, path("new.txt")));
}

TEST_F(ParameterFiles, TheLastOnesAreRemembered) {
  Workspace workspace;
  for (int i = 0; i < 12; ++i) save_parameter_file(workspace, path(("p" + std::to_string(i) + ".crf").c_str()));
  EXPECT_EQ(recent_parameter_files().size(), 10);
  EXPECT_EQ(recent_parameter_files().front(), folder_.filePath("p11.crf"));
  load_parameter_file(workspace, path("p5.crf"));
  EXPECT_EQ(recent_parameter_files().front(), folder_.filePath("p5.crf"));
  EXPECT_EQ(recent_parameter_files().size(), 10);
  QFile::remove(folder_.filePath("p5.crf"));
  EXPECT_EQ(recent_parameter_files().front(), folder_.filePath("p11.crf"));
}

}  // namespace
}  // namespace atomesh::gui
