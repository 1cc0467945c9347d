// The rules of the house: which room may include which, heavy headers in one file each, the fixed top level.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = ATOMESH_SOURCE_DIR;

// The rooms table: a room includes itself and these.
const std::map<std::string, std::set<std::string>> may_include{
    {"core", {}},
    {"samples", {"core"}},
    {"preprocess", {"core"}},
    {"render", {"core"}},
    {"app", {"core", "samples", "preprocess", "render"}},
    {"tests", {"core", "samples", "preprocess", "render", "app"}},
};

struct Include {
  std::string header;
  bool quoted;  // "ours", not <theirs>
};

std::vector<Include> includes_of(std::istream& source) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> includes;
  for (std::string line; std::getline(source, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) includes.push_back({match[2], match[1] == "\""});
  }
  return includes;
}

// Why a file of this room must not include this, or "".
std::string complaint(const std::string& room, const Include& include) {
  const std::string first = include.header.substr(0, include.header.find('/'));
  if (!may_include.contains(first) || first == include.header) return "";
  if (!include.quoted) return "our own header in <>";
  if (first == room || may_include.at(room).contains(first)) return "";
  return room + " may not include " + first;
}

struct HeavyLibrary {
  const char* name;
  std::regex headers;
  std::set<std::string> rooms;  // that may use it
  std::size_t files = 1;        // that may include it
  std::string folder = {};      // where all files may, headers too
};

const std::vector<HeavyLibrary>& heavy_libraries() {
  static const std::vector<HeavyLibrary> libraries{
      {"CGAL", std::regex("^CGAL/"), {"preprocess"}},
      {"TetGen", std::regex("^tetgen\\.h$"), {"preprocess"}},
      {"spglib", std::regex("^spglib\\.h$"), {"preprocess"}},
      {"Embree", std::regex("^embree[0-9]/"), {"render"}},
      {"FreeType", std::regex("^(ft2build\\.h$|freetype/)"), {"render"}},
      // three files of readers, a writer, two peers of the benches; six of the window's scene on the graphics card; a
      // writer of movies
      {"VTK", std::regex("^vtk[A-Z]"), {"app"}, 13},
      {"toml++", std::regex("^toml(\\+\\+|plusplus|/|\\.)"), {"core"}},
      {"nlohmann-json", std::regex("^nlohmann/"), {"app"}},
      {"Qt", std::regex("^(Q[A-Z]|Qt)"), {"app"}, 0, "app/gui/"},
  };
  return libraries;
}

struct SourceFile {
  std::string path;  // relative to the root
  std::string room;
  std::vector<Include> includes;
};

const std::vector<SourceFile>& sources() {
  static const std::vector<SourceFile> files = [] {
    std::vector<SourceFile> found;
    for (const auto& [room, others] : may_include) {
      for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp" && extension != ".inl" && extension != ".cu") continue;
        std::ifstream source(entry.path());
        found.push_back({fs::relative(entry.path(), root).string(), room, includes_of(source)});
      }
    }
    return found;
  }();
  return files;
}

TEST(House, ComplaintsCatchWrongArrows) {
  EXPECT_EQ(complaint("core", {"core/atoms.h", true}), "");
  EXPECT_EQ(complaint("render", {"core/atoms.h", true}), "");
  EXPECT_EQ(complaint("core", {"vector", false}), "");
  EXPECT_NE(complaint("core", {"preprocess/carve.h", true}), "");
  EXPECT_NE(complaint("render", {"preprocess/carve.h", true}), "");
  EXPECT_NE(complaint("preprocess", {"render/scene.h", true}), "");
  EXPECT_NE(complaint("samples", {"app/cli/json.h", true}), "");
  EXPECT_NE(complaint("app", {"tests/support/lattices.h", true}), "");
  EXPECT_NE(complaint("render", {"core/atoms.h", false}), "");
}

TEST(House, EveryIncludeFollowsTheArrows) {
  ASSERT_GT(sources().size(), 50U) << "the test does not see the sources";
  for (const SourceFile& file : sources()) {
    for (const Include& include : file.includes) {
      EXPECT_EQ(complaint(file.room, include), "") << file.path << " includes " << include.header;
    }
  }
}

TEST(House, HeavyHeadersStayInTheirSourceFiles) {
  for (const HeavyLibrary& library : heavy_libraries()) {
    std::set<std::string> users;
    for (const SourceFile& file : sources()) {
      if (file.room == "tests") continue;
      for (const Include& include : file.includes) {
        if (!std::regex_search(include.header, library.headers)) continue;
        if (!library.folder.empty() && file.path.starts_with(library.folder)) continue;
        users.insert(file.path);
        EXPECT_TRUE(library.rooms.contains(file.room)) << file.path << " uses " << library.name;
        EXPECT_TRUE(file.path.ends_with(".cpp")) << file.path << " spreads " << library.name << " to who includes it";
      }
    }
    EXPECT_LE(users.size(), library.files) << library.name << " is in " << *users.begin() << " and " << *users.rbegin();
  }
}

// The classes that a source defines in namespaces that others see too, by their full names.
std::set<std::string> types_of(std::istream& source) {
  static const std::regex opening(R"(^(inline )?namespace( [A-Za-z0-9_:]+)? \{$)");
  static const std::regex closing(R"(^\}  // namespace)");
  static const std::regex type(R"(^(class|struct|enum class) ([A-Za-z0-9_]+)( final)?( : .*)?( \{.*)$)");
  std::vector<std::string> spaces;
  std::set<std::string> types;
  for (std::string line; std::getline(source, line);) {
    std::smatch match;
    if (std::regex_match(line, match, opening)) {
      spaces.push_back(match[2].str().empty() ? "" : match[2].str().substr(1));
    } else if (std::regex_search(line, closing) && !spaces.empty()) {
      spaces.pop_back();
    } else if (std::regex_match(line, match, type)) {
      if (std::find(spaces.begin(), spaces.end(), "") != spaces.end()) continue;
      std::string name;
      for (const std::string& space : spaces) name += space + "::";
      types.insert(name + match[2].str());
    }
  }
  return types;
}

// The linker keeps one of two inline functions or destructors of one name, and says nothing.
TEST(House, NoTwoTypesHaveOneName) {
  std::istringstream sample(
      "namespace a {\nstruct One {\nstruct Two;\nnamespace {\nclass Mine {\n}  // namespace\n"
      "class Three : public One {\n}  // namespace a\n");
  EXPECT_EQ(types_of(sample), (std::set<std::string>{"a::One", "a::Three"}));
  std::map<std::string, std::string> home;
  for (const SourceFile& file : sources()) {
    if (file.room == "tests") continue;
    std::ifstream source(root / file.path);
    for (const std::string& type : types_of(source)) {
      const auto [place, fresh] = home.try_emplace(type, file.path);
      EXPECT_TRUE(fresh) << type << " is defined in " << place->second << " and in " << file.path;
    }
  }
  EXPECT_GT(home.size(), 100U) << "the test does not see the types";
}

TEST(House, SharedCodeOfTheRenderersStandsAlone) {
  for (const SourceFile& file : sources()) {
    if (!file.path.starts_with("render/shared/")) continue;
    for (const Include& include : file.includes) {
      EXPECT_FALSE(include.header.starts_with("render/cpu/") || include.header.starts_with("render/gl/") ||
                   include.header.starts_with("render/cuda/"))
          << file.path << " includes " << include.header;
    }
  }
}

TEST(House, EveryHeaderIsGuardedAndSaysWhatItIs) {
  for (const SourceFile& file : sources()) {
    if (!file.path.ends_with(".h")) continue;
    std::ifstream source(root / file.path);
    std::string first;
    std::getline(source, first);
    EXPECT_TRUE(first.starts_with("// ")) << file.path << " does not begin with what it is";
    std::string line;
    bool guarded = false;
    while (!guarded && std::getline(source, line)) guarded = line == "#pragma once";
    EXPECT_TRUE(guarded) << file.path;
  }
}

TEST(House, TopLevelIsFixed) {
  const std::set<std::string> allowed{"CMakeLists.txt",    "app",     "core",   "preprocess", "render",  "tests",
                                      "samples",           "build",   "demo",   "README.md",  "LICENSE", "CHANGELOG.md",
                                      "CMakePresets.json", "demo.sh", "test.sh"};
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.starts_with(".") || allowed.contains(name)) << name << " has no place at the top";
  }
}

TEST(House, NoFileOutgrowsItsIdea) {
  for (const SourceFile& file : sources()) {
    std::ifstream source(root / file.path);
    const auto lines = std::count(std::istreambuf_iterator<char>(source), std::istreambuf_iterator<char>(), '\n');
    EXPECT_LE(lines, 500) << file.path << ": split it by idea";
  }
}

}  // namespace
