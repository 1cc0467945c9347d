// Every subcommand from end to end, as a user and as a machine reading --json sees it.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "core/material_file.h"
#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

const std::vector<std::string> modes{"volume-surface", "volume", "surface", "xray", "atoms"};

void expect_keys(const json& object, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << "no key " << key << " in " << object.dump(1);
}

double distance(const json& a, const json& b) {
  return std::hypot(a[0].get<double>() - b[0].get<double>(), a[1].get<double>() - b[1].get<double>(),
                    a[2].get<double>() - b[2].get<double>());
}

// A small diamond with planted vacancies, grown and preprocessed once for all tests.
class Subcommands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<Workplace>();
    grown = run({"sample", "diamond-vacancy", "--atoms", "4000", "-o", "d.dat", "--truth", "truth.json"});
    preprocessed = run({"preprocess", "d.dat", "-o", "d.crb", "--json", "preprocess.json"});
  }
  static void TearDownTestSuite() { place.reset(); }

  void SetUp() override {
    ASSERT_EQ(grown.exit_code, 0) << grown.err;
    ASSERT_EQ(preprocessed.exit_code, 0) << preprocessed.err;
  }

  static Outcome run(const std::vector<std::string>& arguments) { return place->run(arguments); }
  static json run_json(std::vector<std::string> arguments, int exit_code = 0) {
    arguments.insert(arguments.end(), {"--json", "-"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    const json parsed = json::parse(outcome.out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << "standard output is not JSON alone:\n" << outcome.out;
    return parsed;
  }

  static inline std::unique_ptr<Workplace> place;
  static inline Outcome grown;
  static inline Outcome preprocessed;
};

TEST_F(Subcommands, SampleTellsTheTruth) {
  const json truth = json::parse(place->read("truth.json"));
  expect_keys(truth, {"atoms", "unit_cell", "vacancies", "extras", "displaced"});
  EXPECT_GT(truth["vacancies"].size(), 0U);
  EXPECT_EQ(truth["unit_cell"]["primitive"].size(), 3U);
  EXPECT_GT(truth["unit_cell"]["basis"].size(), 0U);
}

TEST_F(Subcommands, SampleListNamesTen) {
  EXPECT_EQ(run_json({"sample", "--list"})["samples"].size(), 10U);
  EXPECT_NE(run({"sample", "--list"}).out.find("nacl-cracked"), std::string::npos);
}

TEST_F(Subcommands, SampleRepeatsWithTheSameSeedOnly) {
  ASSERT_EQ(run({"sample", "diamond-vacancy", "--atoms", "4000", "-o", "same.dat"}).exit_code, 0);
  ASSERT_EQ(run({"sample", "diamond-vacancy", "--atoms", "4000", "--seed", "2", "-o", "other.dat"}).exit_code, 0);
  EXPECT_EQ(place->read("same.dat"), place->read("d.dat"));
  EXPECT_NE(place->read("other.dat"), place->read("d.dat"));
}

TEST_F(Subcommands, PreprocessReportsEveryStage) {
  const json report = json::parse(place->read("preprocess.json"));
  expect_keys(report, {"input", "unit_cell", "mesh", "surface", "defects", "simplify", "stages", "total_ms",
                       "peak_memory_mb", "output"});
  expect_keys(report["input"], {"file", "format", "atoms", "skipped", "duplicates", "species", "periodic"});
  expect_keys(report["unit_cell"], {"source", "primitive", "basis"});
  expect_keys(report["mesh"], {"mesher", "vertices", "tetrahedra", "carved", "volume", "min_dihedral_deg"});
  expect_keys(report["surface"], {"triangles", "area", "closed"});
  expect_keys(report["defects"], {"positional_atoms", "vacancy_atoms", "extra_atoms", "vacancies", "extras"});
  expect_keys(report["simplify"], {"tetrahedra_before", "tetrahedra_after", "volume_change"});
  expect_keys(report["output"], {"file", "bytes"});
  EXPECT_EQ(report["unit_cell"]["source"], "file");
  EXPECT_EQ(report["surface"]["closed"], true);
  EXPECT_EQ(report["output"]["bytes"], std::filesystem::file_size(place->path("d.crb")));
  EXPECT_GT(report["peak_memory_mb"], 1.0);
  std::vector<std::string> names;
  for (const json& stage : report["stages"]) names.push_back(stage["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"read_atoms", "find_unit_cell", "tetrahedralize", "carve",
                                             "extract_surface", "quantify_defects", "measure", "write_material"}));
}

TEST_F(Subcommands, SimplifyingPrintsItsCertificate) {
  ASSERT_EQ(run({"sample", "diamond-vacancy", "--atoms", "8000", "-o", "s.dat"}).exit_code, 0);
  const auto result = run({"preprocess", "s.dat", "-o", "s.crb", "--simplify"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("certificate"), std::string::npos);
  for (const std::string strategy : {"collapse", "remove"}) {
    const json report = run_json({"preprocess", "s.dat", "-o", "s.crb", "--simplify-by", strategy});
    const json& simplify = report["simplify"];
    EXPECT_EQ(simplify["strategy"], strategy);
    EXPECT_LT(simplify["tetrahedra_after"], simplify["tetrahedra_before"]);
    EXPECT_GE(simplify["tetrahedra_after"], simplify["least_tetrahedra"]);
    EXPECT_LT(simplify["volume_change"], 1e-12);
    EXPECT_EQ(simplify["surface_identical"], true);
    EXPECT_EQ(simplify["defect_tetrahedra_identical"], true);
    EXPECT_EQ(simplify["scalar_error"], 0.0);
    EXPECT_LT(simplify["picture_difference"], 1.0 / 255.0);
    double in_stages = 0.0;
    for (const json& stage : report["stages"]) in_stages += stage["ms"].get<double>();
    EXPECT_GT(in_stages, 0.9 * report["total_ms"].get<double>()) << "every stage that takes long is told";
    EXPECT_EQ(run_json({"info", "s.crb"})["valid"], true);
  }
  EXPECT_EQ(run({"preprocess", "s.dat", "-o", "s.crb", "--simplify-by", "magic"}).exit_code, 1);
}

TEST_F(Subcommands, UnitCellIsFoundAndNamed) {
  // The same atoms without their cell.
  ASSERT_EQ(run({"convert", "d.dat", "bare.xyz"}).exit_code, 0);
  const json report = run_json({"preprocess", "bare.xyz", "-o", "bare.crb"});
  EXPECT_EQ(report["unit_cell"]["source"], "found");
  EXPECT_EQ(report["unit_cell"]["basis"], 2);
  EXPECT_GT(report["unit_cell"]["explained"], 0.99);
  EXPECT_EQ(report["unit_cell"]["grains"].size(), 1U);
  EXPECT_EQ(report["defects"]["vacancies"], json::parse(place->read("truth.json"))["vacancies"].size());
  const json cell = run_json({"info", "bare.crb"})["unit_cell"];
  EXPECT_EQ(cell["space_group"]["number"], 227);
  EXPECT_EQ(cell["space_group"]["symbol"], "Fd-3m");
  EXPECT_NEAR(cell["space_group"]["lengths"][0].get<double>(), 3.567, 1e-3);
  EXPECT_EQ(run_json({"preprocess", "bare.xyz", "-o", "bare.crb", "--unit-cell", "none"})["unit_cell"]["source"],
            "none");
}

TEST_F(Subcommands, PreprocessDoesNotDependOnThreads) {
  ASSERT_EQ(run({"preprocess", "d.dat", "-o", "t1.crb", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(run({"preprocess", "d.dat", "-o", "t2.crb", "--threads", "2"}).exit_code, 0);
  // Stage times are the only thing that may differ.
  for (const std::string name : {"t1", "t2"}) {
    Material material = read_material(place->path(name + ".crb").string());
    EXPECT_FALSE(material.provenance.stages.empty());
    material.provenance.stages.clear();
    write_material(place->path(name + "-timeless.crb").string(), material);
  }
  EXPECT_EQ(place->read("t1-timeless.crb"), place->read("t2-timeless.crb"));
}

TEST_F(Subcommands, DefectsFindWhatWasPlanted) {
  const json truth = json::parse(place->read("truth.json"));
  const json found = run_json({"defects", "d.crb"});
  expect_keys(found, {"vacancies", "extras", "positional", "clusters"});
  expect_keys(found["positional"], {"atoms", "max", "mean"});
  EXPECT_EQ(found["vacancies"].size(), truth["vacancies"].size());
  EXPECT_EQ(found["extras"].size(), 0U);
  for (const json& planted : truth["vacancies"]) {
    const bool here = std::any_of(found["vacancies"].begin(), found["vacancies"].end(),
                                  [&](const json& vacancy) { return distance(vacancy["position"], planted) < 0.5; });
    EXPECT_TRUE(here) << "no vacancy found at " << planted;
  }
  ASSERT_GT(found["clusters"].size(), 0U);
  expect_keys(found["clusters"][0], {"kind", "centre", "radius", "atoms", "peak"});
}

TEST_F(Subcommands, DefectsSelectAndExport) {
  const json all = run_json({"defects", "d.crb"});
  EXPECT_EQ(run_json({"defects", "d.crb", "--top", "1"})["clusters"].size(), 1U);
  EXPECT_EQ(run_json({"defects", "d.crb", "--kind", "extra"})["clusters"].size(), 0U);
  ASSERT_EQ(run({"defects", "d.crb", "--csv", "d.csv"}).exit_code, 0);
  const std::string csv = place->read("d.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "kind,x,y,z,radius,atoms,vacancies,extras,substitutions,peak");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), all["clusters"].size() + 1);
  EXPECT_EQ(run({"defects", "d.crb", "--csv", "-"}).out, csv);
}

TEST_F(Subcommands, DefectsListTheSites) {
  const json sites = run_json({"defects", "d.crb"})["vacancies"];
  const std::string csv = run({"defects", "d.crb", "--sites", "--csv", "-"}).out;
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "kind,species,x,y,z,atom,votes,expected");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), sites.size() + 1);
  char first[64];
  std::snprintf(first, sizeof first, "vacancy,C,%.3f,%.3f,%.3f,", sites[0]["position"][0].get<double>(),
                sites[0]["position"][1].get<double>(), sites[0]["position"][2].get<double>());
  EXPECT_NE(csv.find(first), std::string::npos) << csv;
  EXPECT_EQ(run({"defects", "d.crb", "--sites", "--csv", "-", "--kind", "extra"}).out,
            csv.substr(0, csv.find('\n') + 1));
  const std::string one = run({"defects", "d.crb", "--sites", "--csv", "-", "--top", "1"}).out;
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 2);
}

TEST_F(Subcommands, DefectsOfAnAtomsFileAreTheSame) {
  EXPECT_EQ(run_json({"defects", "d.dat"}), run_json({"defects", "d.crb"}));
}

TEST_F(Subcommands, RenderDrawsEveryMode) {
  for (const std::string& mode : modes) {
    const json report = run_json({"render", "d.crb", "-o", mode + ".png", "--mode", mode, "--size", "60x40"});
    expect_keys(report,
                {"mode", "renderer", "size", "ms", "tetrahedra", "triangles", "atoms", "steps", "peak_memory_mb"});
    expect_keys(report["ms"], {"load", "setup", "render", "total"});
    EXPECT_EQ(report["mode"], mode);
    EXPECT_EQ(report["size"], json::array({60, 40}));
    const Image image = read_png(place->path(mode + ".png").string());
    EXPECT_EQ(image.width, 60);
    EXPECT_EQ(image.height, 40);
    const Vec4f corner = image.at(0, 0);
    const bool something = std::any_of(image.pixels.begin(), image.pixels.end(),
                                       [&](const Vec4f& pixel) { return glm::distance(pixel, corner) > 0.05F; });
    EXPECT_TRUE(something) << "mode " << mode << " drew nothing but background";
  }
}

TEST_F(Subcommands, RenderNeedsOnlyWhatTheModeNeeds) {
  const json balls = run_json({"render", "d.dat", "-o", "balls.png", "--mode", "atoms", "--size", "20x20"});
  EXPECT_EQ(balls["tetrahedra"], 0);
  EXPECT_EQ(balls["triangles"], 0);
  const json surface = run_json({"render", "d.crb", "-o", "s.png", "--mode", "surface", "--size", "20x20"});
  EXPECT_EQ(surface["tetrahedra"], 0);
  EXPECT_GT(surface["triangles"], 0);
}

TEST_F(Subcommands, RenderFromAtomsEqualsRenderFromCrb) {
  for (const std::string& mode : modes) {
    ASSERT_EQ(run({"render", "d.crb", "-o", "a.png", "--mode", mode, "--size", "50x50"}).exit_code, 0);
    const Outcome same =
        run({"render", "d.dat", "-o", "b.png", "--mode", mode, "--size", "50x50", "--reference", "a.png"});
    EXPECT_EQ(same.exit_code, 0) << mode << ": " << same.out << same.err;
  }
}

TEST_F(Subcommands, PictureCarriesWhatMadeIt) {
  ASSERT_EQ(
      run({"render", "d.crb", "-o", "text.png", "--size", "8x8", "--set", "volume_surface.face_alpha=0.625"}).exit_code,
      0);
  const std::string bytes = place->read("text.png");
  EXPECT_NE(bytes.find("volume_surface.face_alpha=0.625"), std::string::npos);
  EXPECT_NE(bytes.find("input=d.dat"), std::string::npos);
}

TEST_F(Subcommands, SettingsWinOverFileAndDefaults) {
  place->write("p.crf", "mode = \"surface\"\n[surface]\nshininess = 7.0\n");
  ASSERT_EQ(run({"render", "d.crb", "-o", "crf.png", "--size", "8x8", "--params", "p.crf"}).exit_code, 0);
  EXPECT_NE(place->read("crf.png").find("surface.shininess=7\n"), std::string::npos);
  const json report = run_json({"render", "d.crb", "-o", "set.png", "--size", "8x8", "--params", "p.crf", "--mode",
                                "xray", "--set", "surface.shininess=9", "xray.alpha_length=0.5"});
  EXPECT_EQ(report["mode"], "xray");
  EXPECT_NE(place->read("set.png").find("surface.shininess=9\n"), std::string::npos);
  EXPECT_NE(place->read("set.png").find("xray.alpha_length=0.5\n"), std::string::npos);
}

TEST_F(Subcommands, RenderWritesChannels) {
  ASSERT_EQ(run({"render", "d.crb", "-o", "x.png", "--mode", "xray", "--size", "6x4", "--channel", "thickness=x.npy"})
                .exit_code,
            0);
  const std::string npy = place->read("x.npy");
  EXPECT_EQ(npy.substr(1, 5), "NUMPY");
  EXPECT_NE(npy.find("(4, 6)"), std::string::npos);
  EXPECT_EQ(npy.size() % 64, (6 * 4 * sizeof(float)) % 64);
}

TEST_F(Subcommands, TransparentBackgroundIsTransparent) {
  ASSERT_EQ(
      run({"render", "d.crb", "-o", "clear.png", "--mode", "atoms", "--size", "40x40", "--transparent"}).exit_code, 0);
  EXPECT_EQ(read_png(place->path("clear.png").string()).at(0, 0).a, 0.0F);
}

TEST_F(Subcommands, LegendsAreDrawnAndReported) {
  const std::vector<std::string> xray{"render", "d.crb", "-o", "x.png", "--mode", "xray", "--size", "240x180"};
  const auto with = [&xray](std::vector<std::string> more) {
    more.insert(more.begin(), xray.begin(), xray.end());
    return more;
  };
  EXPECT_FALSE(run_json(xray).contains("legend"));
  const std::string plain = place->read("x.png");
  const json report = run_json(with({"--legend", "--scale-bar", "--channel", "thickness=x.npy"}));
  EXPECT_NE(place->read("x.png"), plain);
  EXPECT_EQ(report["legend"]["title"], "thickness, Å");
  EXPECT_EQ(report["legend"]["range"][0], 0.0);
  EXPECT_GT(report["legend"]["range"][1], 10.0);
  EXPECT_TRUE(report["scale_bar"]["text"].get<std::string>().ends_with("Å at center"));
  EXPECT_GT(report["scale_bar"]["pixels"], 10.0);
  // The channel is the sample's, whatever is drawn over it.
  const std::string thickness = place->read("x.npy");
  run_json(with({"--channel", "thickness=x.npy"}));
  EXPECT_EQ(place->read("x.npy"), thickness);

  const json atoms = run_json({"render", "d.crb", "-o", "a.png", "--mode", "atoms", "--size", "240x180", "--legend"});
  EXPECT_EQ(atoms["legend"]["entries"][0]["name"], "C");
  EXPECT_EQ(atoms["legend"]["entries"][0]["color"], "#909090");
  const json volume = run_json({"render", "d.crb", "-o", "v.png", "--mode", "volume", "--size", "240x180", "--legend"});
  EXPECT_EQ(volume["legend"]["range"], json::array({0.0, 1.0}));
  // Drawn in passes: the same picture, the scale of thickness included.
  EXPECT_EQ(run({"render", "d.crb", "-o", "p.png", "--mode", "volume", "--size", "240x180", "--legend", "--pass-rows",
                 "31", "--reference", "v.png"})
                .exit_code,
            0);
  run_json(with({"--legend"}));
  place->write("whole.png", place->read("x.png"));
  const json passes = run_json(with({"--legend", "--pass-rows", "31", "--reference", "whole.png"}));
  EXPECT_EQ(passes["reference"]["max"], 0.0);
  EXPECT_EQ(passes["legend"]["range"], report["legend"]["range"]);
  // No number, no budget.
  EXPECT_EQ(run(with({"--progressive", "4", "--time-budget", "nan"})).exit_code, 1);
  // What has no legend, and what has no room for one, is drawn without and says so.
  const Outcome surface = run({"render", "d.crb", "-o", "s.png", "--mode", "surface", "--size", "240x180", "--legend"});
  EXPECT_EQ(surface.exit_code, 0);
  EXPECT_NE(surface.err.find("--legend: mode surface"), std::string::npos) << surface.err;
  const Outcome small = run({"render", "d.crb", "-o", "s.png", "--mode", "xray", "--size", "24x18", "--legend"});
  EXPECT_EQ(small.exit_code, 0);
  EXPECT_NE(small.err.find("no room"), std::string::npos) << small.err;
}

TEST_F(Subcommands, TripodsAreDrawnAndReported) {
  const std::vector<std::string> balls{"render", "d.crb", "-o", "t.png", "--mode", "atoms", "--size", "240x180"};
  const auto with = [&balls](std::vector<std::string> more) {
    more.insert(more.begin(), balls.begin(), balls.end());
    return more;
  };
  EXPECT_FALSE(run_json(balls).contains("tripod"));
  const std::string plain = place->read("t.png");
  const json report = run_json(with({"--tripod", "--scale-bar"}));
  EXPECT_NE(place->read("t.png"), plain);
  // The sample's cell is a cube along the axes: a, b, c would say nothing else.
  EXPECT_EQ(report["tripod"]["arrows"], json::array({"x", "y", "z"}));
  EXPECT_LE(report["tripod"]["box"][3], report["scale_bar"]["box"][1]);
  place->write("whole.png", place->read("t.png"));
  const json passes = run_json(with({"--tripod", "--scale-bar", "--pass-rows", "31", "--reference", "whole.png"}));
  EXPECT_EQ(passes["reference"]["max"], 0.0);
  const Outcome small = run({"render", "d.crb", "-o", "s.png", "--mode", "atoms", "--size", "24x18", "--tripod"});
  EXPECT_EQ(small.exit_code, 0);
  EXPECT_NE(small.err.find("--tripod: the picture of 24x18 pixels has no room"), std::string::npos) << small.err;
}

TEST_F(Subcommands, InfoSaysWhatIsThere) {
  const json crb = run_json({"info", "d.crb"});
  expect_keys(crb, {"file", "kind", "version", "atoms", "tetrahedra", "triangles", "box", "species", "scalars",
                    "provenance", "valid"});
  EXPECT_EQ(crb["kind"], "crb");
  EXPECT_EQ(crb["version"], 3);
  EXPECT_EQ(crb["valid"], true) << crb["problems"];
  EXPECT_EQ(crb["scalars"]["vacancy"].size(), 2U);
  EXPECT_EQ(crb["provenance"]["input"], "d.dat");
  EXPECT_GT(crb["sections"].size(), 3U);
  const json dat = run_json({"info", "d.dat"});
  EXPECT_EQ(dat["kind"], "dat");
  EXPECT_TRUE(dat["version"].is_null());
  EXPECT_EQ(dat["tetrahedra"], crb["tetrahedra"]);
  EXPECT_NE(run({"info", "d.crb"}).out.find("valid"), std::string::npos);
  // Without substitutions and fields the text of version 3 is that of version 1.
  ASSERT_EQ(run({"convert", "d.crb", "v3.crt"}).exit_code, 0);
  std::string text = place->read("v3.crt");
  ASSERT_EQ(text.find("\nsubstitutions"), std::string::npos);
  ASSERT_TRUE(text.starts_with("atomesh-crt 3\n"));
  place->write("v1.crt", text.replace(0, 14, "atomesh-crt 1\n"));
  EXPECT_EQ(run_json({"info", "v3.crt"})["version"], 3);
  EXPECT_EQ(run_json({"info", "v1.crt"})["version"], 1);
}

TEST_F(Subcommands, ConvertGoesRound) {
  // .crb → .crt → .crb: not a bit changes.
  ASSERT_EQ(run({"convert", "d.crb", "round.crt"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "round.crt", "round.crb"}).exit_code, 0);
  EXPECT_EQ(place->read("round.crb"), place->read("d.crb"));
  // .crb → .dat: the atoms the sample had.
  ASSERT_EQ(run({"convert", "d.crb", "round.dat"}).exit_code, 0);
  EXPECT_EQ(place->read("round.dat"), place->read("d.dat"));
  // .xyz made from a .crb carries the defects, and their sum can be shown from it.
  ASSERT_EQ(run({"convert", "d.crb", "d.xyz"}).exit_code, 0);
  EXPECT_NE(place->read("d.xyz").find("vacancy_defect"), std::string::npos);
  EXPECT_EQ(run({"preprocess", "d.xyz", "-o", "scalar.crb", "--scalar", "vacancy_defect"}).exit_code, 0);
  const Material scalar = read_material(place->path("scalar.crb").string());
  EXPECT_EQ(scalar.defects.positional, read_material(place->path("d.crb").string()).defects.vacancy);
}

TEST_F(Subcommands, ConvertWritesVtu) {
  ASSERT_EQ(run({"convert", "d.crb", "d.vtu"}).exit_code, 0);
  const Material material = read_material(place->path("d.crb").string());
  const std::string vtu = place->read("d.vtu");
  EXPECT_NE(vtu.find("UnstructuredGrid"), std::string::npos);
  EXPECT_NE(vtu.find("NumberOfPoints=\"" + std::to_string(material.mesh.vertices.size()) + "\""), std::string::npos);
  EXPECT_NE(vtu.find("NumberOfCells=\"" + std::to_string(material.mesh.tetrahedra.size()) + "\""), std::string::npos);
  for (const char* name : {"species", "positional", "vacancy", "extra"}) {
    EXPECT_NE(vtu.find("Name=\"" + std::string(name) + "\""), std::string::npos) << name;
  }
}

TEST_F(Subcommands, CompareMeasuresAndDecides) {
  ASSERT_EQ(run({"render", "d.crb", "-o", "one.png", "--mode", "atoms", "--size", "30x30"}).exit_code, 0);
  ASSERT_EQ(run({"render", "d.crb", "-o", "two.png", "--mode", "atoms", "--size", "30x30", "--view", "top"}).exit_code,
            0);
  const json same = run_json({"compare", "one.png", "one.png"});
  EXPECT_EQ(same["max"], 0.0);
  EXPECT_TRUE(same["psnr"].is_null());
  const json different = run_json({"compare", "one.png", "two.png", "-o", "difference.png"}, 4);
  expect_keys(different, {"max", "rmse", "psnr", "pixels_over"});
  EXPECT_GT(different["max"], 0.1);
  EXPECT_GT(different["pixels_over"], 0);
  EXPECT_TRUE(place->exists("difference.png"));
  EXPECT_EQ(run({"compare", "one.png", "two.png", "--tolerance", "255/255"}).exit_code, 0);
}

TEST_F(Subcommands, RenderAgainstAWrongReferenceFailsAndLeavesThePictures) {
  ASSERT_EQ(run({"render", "d.crb", "-o", "good.png", "--mode", "atoms", "--size", "30x30"}).exit_code, 0);
  const json report = run_json({"render", "d.crb", "-o", "bad.png", "--mode", "atoms", "--size", "30x30", "--view",
                                "top", "--reference", "good.png"},
                               4);
  EXPECT_GT(report["reference"]["max"], 0.1);
  EXPECT_TRUE(place->exists("bad.png"));
  EXPECT_TRUE(place->exists("bad-difference.png"));
}

TEST_F(Subcommands, BenchMeasuresTheSeedsTable) {
  const json bench = run_json({"bench", "seed-table", "--sample", "nacl-cracked", "--atoms", "1000", "--size", "32x32",
                               "--repeats", "1", "--markdown", "table.md"});
  expect_keys(bench, {"machine", "commit", "rows"});
  ASSERT_EQ(bench["rows"].size(), 6U);
  for (const json& row : bench["rows"]) {
    expect_keys(row, {"suite", "case", "what", "settings", "peer", "ms_median", "ms_min", "ms_max", "max_error", "rmse",
                      "psnr"});
    EXPECT_LE(row["ms_min"], row["ms_median"]);
    EXPECT_LE(row["ms_median"], row["ms_max"]);
  }
  EXPECT_NE(place->read("table.md").find("| nacl-cracked |"), std::string::npos);
}

TEST_F(Subcommands, HelpOfEachHasAnExample) {
  for (const std::string name : {"sample", "preprocess", "render", "defects", "info", "convert", "compare", "bench"}) {
    const Outcome help = run({name, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Example:\n  atomesh " + name), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("--threads"), std::string::npos);
    EXPECT_NE(help.out.find("--json"), std::string::npos);
    EXPECT_EQ(help.err, "");
  }
  EXPECT_NE(run({"render", "--help-parameters"}).out.find("volume_surface.face_alpha"), std::string::npos);
}

}  // namespace
}  // namespace atomesh::testing
