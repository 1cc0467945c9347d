// A picture brings back its view, and finds its data wherever that may lie.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/gui/picture_state.h"
#include "app/gui/save_picture.h"
#include "core/error.h"
#include "core/image.h"
#include "core/parameter_file.h"
#include "tests/app/gui/diamond.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::gui {
namespace {

namespace fs = std::filesystem;
using Match = PictureData::Match;
using test::TemporaryFolder;

// Nothing as it is by default.
Parameters unusual_parameters() {
  Parameters parameters;
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"mode", "volume"},
           {"background", "0.1,0.2,0.3,0.7"},
           {"view.azimuth", "-123.456789012345"},
           {"view.pan", "0.1,-0.2,1e-7"},
           {"view.projection", "parallel"},
           {"cut_plane.2.enabled", "true"},
           {"cut_plane.2.normal", "1,-2,0.333333333333333"},
           {"light.3.enabled", "true"},
           {"volume.color_map", "0:#00000000 0.25:0.1,0.2,0.3,0.4 0.25:#ff0000 1:#ffffffff"},
           {"volume.field", "a=b c"},
           {"volume.range_low", "-1e-30"},
           {"atoms.color.C", "#123456"},
           {"atoms.visible.C", "false"},
           {"atoms.radius.C", "1.2345678901234567"},
           {"quality.supersampling", "3"}}) {
    set_parameter(parameters, key, value);
  }
  return parameters;
}

class PictureStateTest : public DiamondTest {
 protected:
  static void save(const std::string& name, const std::string& data = "d.crb") {
    Parameters parameters;
    parameters.mode = Mode::atoms;
    save_picture(path(name), open(data), parameters, {.width = 8, .height = 6}, no_progress());
  }
};

TEST_F(PictureStateTest, EveryParameterComesBack) {
  const Parameters parameters = unusual_parameters();
  write_png(path("p.png"), Image(2, 2),
            cli::picture_text(path("p.png"), path("d.crb"), cli::hash_of_data(path("d.crb")), *open().material,
                              parameters, "cpu", {.legend = true, .tripod = true}));
  const PictureState state = read_picture_state(path("p.png"));
  EXPECT_EQ(state.origin.parameters, parameters);
  EXPECT_EQ(state.origin.parts, (cli::PictureParts{.legend = true, .scale_bar = false, .tripod = true}));
  EXPECT_EQ(state.origin.renderer, "cpu");
  EXPECT_TRUE(state.origin.program.starts_with("atomesh "));
  EXPECT_EQ(state.origin.data, "d.crb");  // nothing of this machine
  ASSERT_TRUE(state.data);
  EXPECT_EQ(state.data->match, Match::same);
  EXPECT_EQ(state.data->path, path("d.crb"));
}

TEST_F(PictureStateTest, ThePicturesOfTheCommandLineToo) {
  cli({"render", "d.crb", "-o", "c.png", "--size", "20x10", "--mode", "xray", "--set", "xray.color=#102030",
       "--legend"});
  const PictureState state = read_picture_state(path("c.png"));
  Parameters wanted;
  wanted.mode = Mode::xray;
  set_parameter(wanted, "xray.color", "#102030");
  EXPECT_EQ(state.origin.parameters, wanted);
  EXPECT_TRUE(state.origin.parts.legend);
  ASSERT_TRUE(state.data);
  EXPECT_EQ(state.data->match, Match::same);
  EXPECT_TRUE(shows(state, open()));

  // And back: a picture is as good as a .crf for the command line.
  save_picture(path("w.png"), open(), state.origin.parameters, {.width = 30, .height = 30}, no_progress());
  cli({"render", "d.crb", "-o", "again.png", "--size", "30x30", "--params", "c.png"});
  EXPECT_EQ(read_png(path("w.png")).pixels, read_png(path("again.png")).pixels);
  write_crf(path("c.crf"), state.origin.parameters);
  cli({"render", "d.crb", "-o", "again.png", "--size", "30x30", "--params", "c.crf"});
  EXPECT_EQ(read_png(path("w.png")).pixels, read_png(path("again.png")).pixels);
}

TEST_F(PictureStateTest, DataAreFoundWhereTheyAreNow) {
  save("p.png");
  const TemporaryFolder elsewhere;
  const std::string png = elsewhere.file("p.png");
  fs::copy_file(path("p.png"), png);

  PictureState state = read_picture_state(png);
  EXPECT_FALSE(state.data);
  const std::string text = missing_data_text(state, png);
  EXPECT_NE(text.find("p.png shows d.crb, which was not found"), std::string::npos) << text;
  EXPECT_NE(text.find(elsewhere.file("d.crb")), std::string::npos) << text;
  EXPECT_TRUE(shows(state, open()));  // it may be open already

  // The atoms it was made from.
  fs::copy_file(path("d.dat"), elsewhere.file("d.dat"));
  state = read_picture_state(png);
  ASSERT_TRUE(state.data);
  EXPECT_EQ(state.data->match, Match::atoms);
  EXPECT_EQ(state.data->path, elsewhere.file("d.dat"));
  const auto options = picture_options(state);
  EXPECT_NE(std::find(options.begin(), options.end(), std::pair<std::string, std::string>("carve", "auto")),
            options.end());

  // Another file of that name is worse than those atoms, and alone it is said to be another.
  cli({"preprocess", "d.dat", "-o", "other.crb", "--carve", "off"});
  fs::copy_file(path("other.crb"), elsewhere.file("d.crb"));
  EXPECT_EQ(read_picture_state(png).data->match, Match::atoms);
  fs::remove(elsewhere.file("d.dat"));
  state = read_picture_state(png);
  ASSERT_TRUE(state.data);
  EXPECT_EQ(state.data->match, Match::other);
  EXPECT_NE(missing_data_text(state, png).find("has another content"), std::string::npos);
  EXPECT_FALSE(shows(state, open_document(elsewhere.file("d.crb"), {}, no_progress())));

  // The same atoms by the same options, though the stage times in the file differ.
  cli({"preprocess", "d.dat", "-o", "remade.crb"});
  fs::copy_file(path("remade.crb"), elsewhere.file("d.crb"), fs::copy_options::overwrite_existing);
  ASSERT_NE(test::read_bytes(elsewhere.file("d.crb")), place->read("d.crb"));
  EXPECT_EQ(read_picture_state(png).data->match, Match::remade);

  // The very file.
  fs::copy_file(path("d.crb"), elsewhere.file("d.crb"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(read_picture_state(png).data->match, Match::same);
}

TEST_F(PictureStateTest, PlacesAreSeenFromThePicture) {
  fs::create_directories(place->path("a/pictures"));
  fs::create_directories(place->path("b/1/2/3"));
  save("a/pictures/p.png");
  EXPECT_EQ(cli::read_picture_origin(path("a/pictures/p.png")).data, "../../d.crb");
  EXPECT_EQ(read_picture_state(path("a/pictures/p.png")).data->path, path("d.crb"));
  save("b/1/2/3/p.png");
  EXPECT_EQ(cli::read_picture_origin(path("b/1/2/3/p.png")).data, path("d.crb"));
  EXPECT_EQ(read_picture_state(path("b/1/2/3/p.png")).data->match, Match::same);
}

TEST_F(PictureStateTest, APictureOfAtomsOpensWhatWasMadeOfThem) {
  const TemporaryFolder folder;
  fs::copy_file(path("d.dat"), folder.file("d.dat"));
  cli({"render", folder.file("d.dat"), "-o", folder.file("p.png"), "--size", "8x6"});
  EXPECT_EQ(read_picture_state(folder.file("p.png")).data->match, Match::atoms);
  cli({"preprocess", folder.file("d.dat"), "-o", folder.file("d.crb")});
  const PictureState state = read_picture_state(folder.file("p.png"));
  EXPECT_EQ(state.data->match, Match::remade);
  EXPECT_EQ(state.data->path, folder.file("d.crb"));
  cli({"preprocess", folder.file("d.dat"), "-o", folder.file("d.crb"), "--carve", "off"});
  EXPECT_EQ(read_picture_state(folder.file("p.png")).data->match, Match::atoms);
}

TEST_F(PictureStateTest, DataDamagedSinceAreNotTaken) {
  const TemporaryFolder folder;
  fs::copy_file(path("d.crb"), folder.file("d.crb"));
  Parameters parameters;
  parameters.mode = Mode::atoms;
  save_picture(folder.file("p.png"), open_document(folder.file("d.crb"), {}, no_progress()), parameters,
               {.width = 8, .height = 6}, no_progress());
  std::string bytes = test::read_bytes(folder.file("d.crb"));
  bytes[20] = static_cast<char>(bytes[20] ^ 1);  // the size in the header
  test::write_bytes(folder.file("d.crb"), bytes);
  EXPECT_EQ(read_picture_state(folder.file("p.png")).data->match, Match::other);
}

TEST_F(PictureStateTest, OtherPicturesAreRefusedClearly) {
  const auto message = [](const std::string& png) -> std::string {
    try {
      read_picture_state(png);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  write_png(path("plain.png"), Image(2, 2));
  EXPECT_NE(message(path("plain.png")).find("a picture of another program"), std::string::npos);
  write_png(path("gimp.png"), Image(2, 2), {{"Software", "GIMP 2.10"}});
  EXPECT_NE(message(path("gimp.png")).find("a picture of GIMP 2.10"), std::string::npos);
  write_png(path("newer.png"), Image(2, 2),
            {{"Software", "atomesh 9.9"}, {"atomesh parameters", "mode=xray\nxray.colour_of_magic=1\n"}});
  EXPECT_NE(message(path("newer.png")).find("made by atomesh 9.9"), std::string::npos) << message(path("newer.png"));
  EXPECT_NE(message(path("d.crb")).find("not a PNG file"), std::string::npos);
  EXPECT_NE(message(path("none.png")), "");
  const testing::Outcome outcome = place->run({"render", "d.crb", "-o", "x.png", "--params", "plain.png"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("plain.png"), std::string::npos) << outcome.err;

  // Before pictures said where their data are, they gave the name: beside the picture it is found.
  write_png(path("old.png"), Image(2, 2), {{"Source", "d.crb"}, {"atomesh parameters", "mode=xray\n"}});
  const PictureState old = read_picture_state(path("old.png"));
  ASSERT_TRUE(old.data);
  EXPECT_EQ(old.data->path, path("d.crb"));
  EXPECT_EQ(old.data->match, Match::other);
}

}  // namespace
}  // namespace atomesh::gui
