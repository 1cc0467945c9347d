#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "core/parameter_file.h"
#include "tests/core/random_parameters.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

const std::vector<std::string> some_species{"Na", "Cl", "1", "O.w", "a\"b\\c", "#x"};

TEST(Crf, EveryParameterComesBackExactly) {
  const TemporaryFolder folder;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Parameters random = test::random_parameters(seed, some_species);
    const std::string path = folder.file(std::to_string(seed) + ".crf");
    write_crf(path, random);
    EXPECT_EQ(read_crf(path), random) << seed;
    // Over any other base: the file names every value (only species that are "auto" are the base's).
    Parameters base = test::random_parameters(seed + 1000, {});
    EXPECT_EQ(read_crf(path, base), random) << seed;
  }
}

TEST(Crf, WritingOverAFileSaysTheSameAsWritingAfresh) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Parameters random = test::random_parameters(seed, some_species);
    write_crf(path, random);
    EXPECT_EQ(read_crf(path), random) << seed;
    const std::string bytes = read_bytes(path);
    write_crf(path, random);
    EXPECT_EQ(read_bytes(path), bytes) << "nothing new to say, yet the file changed";
  }
}

TEST(Crf, AFreshFileExplainsItself) {
  const TemporaryFolder folder;
  write_crf(folder.file("a.crf"), Parameters());
  const std::string text = read_bytes(folder.file("a.crf"));
  EXPECT_NE(text.find("\n# Face alpha constant. "), std::string::npos);
  EXPECT_NE(text.find("(0 to 1)\nface_alpha = 0.15\n"), std::string::npos);
  EXPECT_NE(text.find("\n[light.8]\n"), std::string::npos);
  EXPECT_NE(text.find("color_map = \"viridis\"\n"), std::string::npos);
  EXPECT_NE(text.find("mode = \"volume-surface\"\n"), std::string::npos);
}

TEST(Crf, ReadsWhatAPersonWrites) {
  const TemporaryFolder folder;
  write_bytes(folder.file("a.crf"), R"(# my view
mode = "xray"
background = "#00000000"
xray.color = [1, 0.5, 0]      # orange
light = { 3 = { enabled = true, position = [0, 0, 1] } }
[view]
zoom = 2
pan = [1, -2.5, 3e0]
[volume]
color_map = [ [0, 0, 0, 0, 0],
              [1, 1, 1, 1] ]   # opaque where A is left out
[atoms]
color.Na = "#ff0000"
radius = { Na = 1.5, "O.w" = "auto" }
visible.Cl = false
)");
  const Parameters p = read_crf(folder.file("a.crf"));
  EXPECT_EQ(p.mode, Mode::xray);
  EXPECT_EQ(p.background, Vec4f(0, 0, 0, 0));
  EXPECT_EQ(p.xray.color, Vec3f(1, 0.5F, 0));
  EXPECT_TRUE(p.lights[2].enabled);
  EXPECT_EQ(p.zoom, 2.0);
  EXPECT_EQ(p.pan, Vec3(1, -2.5, 3));
  EXPECT_EQ(p.volume.color_map.entries.at(1).color, Vec4f(1, 1, 1, 1));
  EXPECT_EQ(p.atoms.colors.at("Na"), Vec3f(1, 0, 0));
  EXPECT_EQ(p.atoms.radii.at("Na"), 1.5);
  EXPECT_FALSE(p.atoms.visible.at("Cl"));
  EXPECT_EQ(p.elevation, Parameters().elevation);
  Parameters base;
  base.roll = 12.0;
  EXPECT_EQ(read_crf(folder.file("a.crf"), base).roll, 12.0);
}

TEST(Crf, CommentsAndOrderOfAnExistingFileStay) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  write_bytes(path, R"(# the paper's figure 3
[view]   # seen from above
zoom = 2          # close
azimuth = +30.00  # as it was

# the rest
[volume]
color_map = [[0, 0, 0, 0, 0],  # nothing
             [1, 1, 1, 1, 1]]  # everything
[light.1]
enabled = true
)");
  Parameters p = read_crf(path);
  p.zoom = 3.5;
  p.lights[0].intensity = 0.5F;
  write_crf(path, p);
  EXPECT_EQ(read_crf(path), p);
  const std::string text = read_bytes(path);
  EXPECT_NE(text.find("# the paper's figure 3\n[view]   # seen from above\nzoom = 3.5          # close\n"
                      "azimuth = +30.00  # as it was\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("[1, 1, 1, 1, 1]]  # everything\n"), std::string::npos) << text;
  EXPECT_LT(text.find("# the rest"), text.find("[volume]"));
  EXPECT_LT(text.find("zoom ="), text.find("elevation ="));      // a missing key joins its table …
  EXPECT_LT(text.find("elevation ="), text.find("# the rest"));  // … and does not land in the next
  EXPECT_EQ(text.find("[view]"), text.rfind("[view]"));          // no table twice
  p.volume.color_map = preset_color_map("cividis");
  p.zoom = 4.0;
  write_crf(path, p);
  EXPECT_EQ(read_crf(path), p);
  EXPECT_NE(read_bytes(path).find("color_map = \"cividis\"  # everything\n"), std::string::npos) << read_bytes(path);
}

TEST(Crf, DottedKeysStayDotted) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  write_bytes(path, "# mine\nview.zoom = 2 # close\nlight.1.enabled = true\natoms.color.Na = \"#ff0000\"\n");
  Parameters p = read_crf(path);
  p.zoom = 7.0;
  p.atoms.colors["Na"] = Vec3f(0, 1, 0);
  p.atoms.colors["Cl"] = Vec3f(0, 0, 1);
  write_crf(path, p);
  EXPECT_EQ(read_crf(path), p);
  const std::string text = read_bytes(path);
  EXPECT_EQ(text.find("# mine\nview.zoom = 7 # close\nview.azimuth ="), text.find("# mine")) << text;
  EXPECT_NE(text.find("atoms.color.Na = [0, 1, 0]\natoms.color.Cl = [0, 0, 1]\n"), std::string::npos) << text;
}

TEST(Crf, SpeciesThatGoBackToTheirOwnLeaveTheFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  Parameters p;
  p.atoms.colors["Na"] = Vec3f(1, 0, 0);
  p.atoms.radii["Na"] = 2.0;
  write_crf(path, p);
  p.atoms.colors.clear();
  write_crf(path, p);
  EXPECT_EQ(read_crf(path), p);
  EXPECT_EQ(read_bytes(path).find("Na = [1"), std::string::npos);
}

TEST(Crf, AFileThatIsNoneIsReplaced) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  Parameters p;
  p.zoom = 3.0;
  for (const char* text : {"", "\n", "not toml at all [", "unknown = 3\n", "zoom = 3\n", "\xff\xfe"}) {
    write_bytes(path, text);
    write_crf(path, p);
    EXPECT_EQ(read_crf(path), p) << text;
  }
  EXPECT_EQ(folder.count(), 1U);
}

TEST(Crf, MistakesAreNamedWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crf");
  const auto message = [&](std::string_view text) -> std::string {
    write_bytes(path, text);
    try {
      read_crf(path);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(path + ":")) << what;
      return what.substr(path.size() + 1);
    }
    return "";
  };
  EXPECT_EQ(message("\n[view]\nzoom = -1\n"), "3: view.zoom = \"-1\": expected a number from 0.001 to 10000");
  EXPECT_EQ(message("[view]\n\nzoom = \"2\"\n"), "3: view.zoom: expected a number");
  EXPECT_EQ(message("shading = true\n"), "1: shading: expected one of its words in quotes");
  EXPECT_EQ(message("light.1.enabled = \"true\"\n"), "1: light.1.enabled: expected true or false, without quotes");
  EXPECT_EQ(message("quality.supersampling = 2.0\n"), "1: quality.supersampling: expected a whole number");
  EXPECT_NE(message("view.zom = 1\n").find("did you mean view.zoom"), std::string::npos);
  EXPECT_EQ(message("view.zoom = 2\n view.zoom = 3\n").substr(0, 2), "2:");
  EXPECT_EQ(message("mode = \"xray\"\nview = 7\n").substr(0, 2), "2:");
  EXPECT_NE(message("view.zoom = nan\n"), "");
  EXPECT_NE(message("view.zoom = inf\n"), "");
  EXPECT_NE(message("view.pan = [1, 2]\n"), "");
  EXPECT_NE(message("view.pan = [1, 2, \"3\"]\n"), "");
  EXPECT_NE(message("view.pan = []\n"), "");
  EXPECT_NE(message("volume.color_map = []\n"), "");
  EXPECT_NE(message("volume.color_map = [[0, 0, 0, 0, 0]]\n"), "");
  EXPECT_NE(message("volume.color_map = [[0, 0, 0], [1, 1, 1]]\n"), "");
  EXPECT_NE(message("volume.color_map = [0, 1]\n"), "");
  EXPECT_NE(message("view.zoom = 1979-05-27\n"), "");
  EXPECT_NE(message("background = [0, 0, 0, 2]\n"), "");
  EXPECT_NE(message("view.zoom = \n"), "");
  EXPECT_NE(message("# one\nmode = \"xray\"\nview.zoom = ,\nview.roll = 1\n").find("expected value"),
            std::string::npos);
  EXPECT_EQ(message("# one\nmode = \"xray\"\nview.pan = [1, }]\nview.roll = 1\n"), "3: expected a value");
  EXPECT_EQ(message("view.zoom = ]").substr(0, 2), "1:");
  EXPECT_EQ(message("view.pan = [1,,2]").substr(0, 2), "1:");
  // Of two mistakes the first in the file is reported, whatever the order of the keys.
  EXPECT_EQ(message("view.zoom = 0\nlight.1.enabled = 3\n").substr(0, 2), "1:");
  EXPECT_THROW(read_crf(folder.file("none.crf")), InputError);
}

TEST(Crf, ValuesOutOfRangeAreNotWritten) {
  const TemporaryFolder folder;
  Parameters p;
  p.zoom = 0.0;
  EXPECT_THROW(write_crf(folder.file("a.crf"), p), UsageError);
  EXPECT_EQ(folder.count(), 0U);
}

}  // namespace
}  // namespace atomesh
