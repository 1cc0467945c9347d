// What `cmake --install` puts where, and that desktops understand it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

class Desktop : public ::testing::Test {
 protected:
  static int run(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static bool have(const std::string& program) { return run("command -v " + program + " >/dev/null 2>&1") == 0; }
  void SetUp() override {
    ASSERT_EQ(run(std::string(ATOMESH_CMAKE) + " --install " + ATOMESH_BUILD_DIR + " --prefix " + prefix() + " >" +
                  folder.file("log") + " 2>&1"),
              0)
        << atomesh::test::read_bytes(folder.file("log"));
  }
  std::string prefix() const { return folder.file("usr"); }
  std::string file(const std::string& name) const { return prefix() + "/" + name; }

  atomesh::test::TemporaryFolder folder;
  const std::string entry = "share/applications/atomesh.desktop";
  const std::string types = "share/mime/packages/atomesh.xml";
  const std::string icon = "share/icons/hicolor/scalable/apps/atomesh.svg";
};

TEST_F(Desktop, EverythingIsInItsPlace) {
  for (const std::string& name : {std::string("bin/atomesh"), entry, types, icon}) {
    EXPECT_TRUE(fs::is_regular_file(file(name))) << name;
  }
  EXPECT_EQ(run(file("bin/atomesh") + " --version >/dev/null"), 0);
}

TEST_F(Desktop, TheEntryNamesTheProgramTheIconAndTheTypes) {
  const std::string text = atomesh::test::read_bytes(file(entry));
  EXPECT_NE(text.find("Exec=atomesh %F\n"), std::string::npos);
  EXPECT_NE(text.find("Icon=atomesh\n"), std::string::npos);
  // Every type of ours that it opens is one that is registered.
  const std::string registered = atomesh::test::read_bytes(file(types));
  const std::regex type("application/x-atomesh-[a-z]+");
  std::set<std::string> names(std::sregex_token_iterator(text.begin(), text.end(), type), {});
  EXPECT_GE(names.size(), 3U);
  for (const std::string& name : names) EXPECT_NE(registered.find('"' + name + '"'), std::string::npos) << name;
  if (have("desktop-file-validate")) {
    EXPECT_EQ(run("desktop-file-validate " + file(entry)), 0);
  }
}

TEST_F(Desktop, FilesAreKnownByTheirTypes) {
  if (!have("update-mime-database")) GTEST_SKIP() << "update-mime-database is not installed";
  ASSERT_EQ(run("XDG_DATA_DIRS=" + file("share") + " update-mime-database " + file("share/mime") + " >/dev/null 2>" +
                folder.file("said")),
            0);
  EXPECT_EQ(atomesh::test::read_bytes(folder.file("said")), "");
  const std::string globs = atomesh::test::read_bytes(file("share/mime/globs2"));
  for (const char* ending : {"crb", "crt", "crf"}) {
    EXPECT_NE(globs.find(std::string("application/x-atomesh-") + ending + ":*." + ending), std::string::npos) << globs;
  }
  // The magic of a .crb: eight bytes, the last of them zero.
  const std::string magic = atomesh::test::read_bytes(file("share/mime/magic"));
  EXPECT_NE(magic.find(std::string("\0\x08", 2) + std::string("ATOMESH\0", 8)), std::string::npos);
}

}  // namespace
