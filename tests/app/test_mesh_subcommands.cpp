// The program on mesh files, as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/mesh_files.h"
#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;
using test::Plot3dGrid;

// A PLOT3D grid of 5 × 4 × 6 points a centimetre apart, and its solution.
class MeshSubcommands : public ::testing::Test {
 protected:
  void SetUp() override {
    const Plot3dGrid grid{{5, 4, 6}, [](int i, int j, int k) { return Vec3(i, j, k) * 0.01; }, nullptr};
    place.write("boxxyz.bin", test::plot3d_grid({.big_endian = true}, {grid}));
    place.write("boxq.bin", test::plot3d_solution({.big_endian = true}, {grid}));
  }
  Outcome succeed(const std::vector<std::string>& arguments) const {
    const Outcome outcome = place.run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments[0] << " " << outcome.err;
    return outcome;
  }
  void fail(const std::vector<std::string>& arguments, int exit_code, const std::string& words) const {
    const Outcome outcome = place.run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments[0] << " " << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << arguments[0] << " says " << outcome.err;
  }

  Workplace place;
};

const std::string opaque = "volume.alpha_length=50";

TEST_F(MeshSubcommands, InfoCountsCellsAndRanges) {
  const json info = json::parse(succeed({"info", "boxxyz.bin", "--json", "-"}).out);
  EXPECT_EQ(info["kind"], "plot3d");
  EXPECT_EQ(info["atoms"], 0);
  EXPECT_EQ(info["tetrahedra"], 300);
  EXPECT_EQ(info["scalars"]["Density"], (json::array({1.0, 5.0})));
  EXPECT_EQ(info["valid"], true);
  EXPECT_EQ(info["provenance"]["counts"]["cells"], 60);
  const std::string text = succeed({"info", "boxxyz.bin"}).out;
  for (const char* words : {"(plot3d)", "cells        60 of 120 points", "0.0400 0.0300 0.0500", "Momentum_x"}) {
    EXPECT_NE(text.find(words), std::string::npos) << words << " is not in " << text;
  }
  EXPECT_EQ(text.find("Å"), std::string::npos) << "nobody said in which unit the mesh is";
}

TEST_F(MeshSubcommands, EveryFormatGivesTheSamePicture) {
  succeed({"render", "boxxyz.bin", "-o", "a.png", "--mode", "volume", "--size", "60x50", "--set", opaque});
  for (const char* file : {"b.crb", "b.crt", "b.vtu"}) {
    succeed({"convert", "boxxyz.bin", file});
    succeed({"render", file, "-o", "b.png", "--mode", "volume", "--size", "60x50", "--set", opaque, "--reference",
             "a.png"});
  }
  const json render =
      json::parse(succeed({"render", "b.crb", "-o", "b.png", "--mode", "volume", "--json", "-", "--set", opaque}).out);
  EXPECT_EQ(render["tetrahedra"], 300);
  for (const char* mode : {"volume-surface", "surface", "xray"}) {
    succeed({"render", "boxxyz.bin", "-o", "c.png", "--mode", mode, "--size", "40x30"});
  }
}

TEST_F(MeshSubcommands, TheJudgeSeesTheSame) {
  for (const char* mode : {"volume", "volume-surface", "surface"}) {
    const std::vector<std::string> picture{"--mode", mode, "--size", "48x36", "--set", opaque};
    std::vector<std::string> judge{"render", "boxxyz.bin", "-o", "judge.png", "--renderer", "reference"};
    judge.insert(judge.end(), picture.begin(), picture.end());
    succeed(judge);
    std::vector<std::string> cpu{"render",      "boxxyz.bin", "-o",          "cpu.png",
                                 "--reference", "judge.png",  "--tolerance", "1/255"};
    cpu.insert(cpu.end(), picture.begin(), picture.end());
    succeed(cpu);
  }
}

TEST_F(MeshSubcommands, FieldsAreChosenByName) {
  succeed({"render", "boxxyz.bin", "-o", "a.png", "--mode", "volume", "--size", "40x30", "--field", "Momentum_z",
           "--set", opaque});
  succeed({"render", "boxxyz.bin", "-o", "b.png", "--mode", "volume", "--size", "40x30", "--set",
           "volume.field=Momentum_z", opaque, "--reference", "a.png"});
  EXPECT_EQ(place.run({"compare", "a.png", "b.png"}).exit_code, 0);
  succeed({"render", "boxxyz.bin", "-o", "c.png", "--mode", "volume", "--size", "40x30", "--set", opaque});
  EXPECT_EQ(place.run({"compare", "a.png", "c.png"}).exit_code, 4) << "the first field, not this one";
  fail({"render", "boxxyz.bin", "-o", "d.png", "--mode", "volume", "--field", "Dnsity"}, 1, "did you mean Density?");
  fail({"render", "boxxyz.bin", "-o", "d.png", "--mode", "volume", "--set", "volume.range_low=9"}, 1,
       "Density goes from 1 to 5");
}

TEST_F(MeshSubcommands, WhatAMeshHasNotIsSaidClearly) {
  fail({"preprocess", "boxxyz.bin", "-o", "a.crb"}, 1, "is a mesh, which needs no preprocessing");
  fail({"defects", "boxxyz.bin"}, 2, "is a mesh without atoms");
  fail({"convert", "boxxyz.bin", "a.xyz"}, 2, "is a mesh without atoms");
  fail({"render", "boxxyz.bin", "-o", "a.png", "--mode", "atoms"}, 2, "needs the atoms");
  fail({"render", "boxxyz.bin", "-o", "a.png", "--carve", "off"}, 1, "--carve has no effect on boxxyz.bin");
  succeed({"convert", "boxxyz.bin", "a.crb"});
  fail({"defects", "a.crb"}, 2, "is a mesh without atoms");
  fail({"render", "a.crb", "-o", "a.png", "--solution", "boxq.bin"}, 1, "no PLOT3D grid");
  fail({"info", "boxq.bin"}, 2, "is a PLOT3D solution");
}

TEST_F(MeshSubcommands, AnExtinctionThatDoesNotSuitTheMeshIsNamed) {
  const Outcome outcome = succeed({"render", "boxxyz.bin", "-o", "a.png", "--mode", "volume", "--size", "40x30"});
  EXPECT_NE(outcome.err.find("nearly transparent"), std::string::npos) << outcome.err;
  const std::size_t at = outcome.err.find("volume.alpha_length=");
  ASSERT_NE(at, std::string::npos) << outcome.err;
  const std::string proposed = outcome.err.substr(at, outcome.err.find_first_of(" \n", at) - at);
  EXPECT_EQ(succeed({"render", "boxxyz.bin", "-o", "a.png", "--mode", "volume", "--size", "40x30", "--set", proposed})
                .err.find("transparent"),
            std::string::npos);
  // And what would be a black box, of a mesh in nanometres of a metre's size.
  const Plot3dGrid grid{{3, 3, 3}, [](int i, int j, int k) { return Vec3(i, j, k) * 1e6; }, nullptr};
  place.write("large.x", test::plot3d_grid({}, {grid}));
  place.write("large.q", test::plot3d_solution({}, {grid}));
  EXPECT_NE(succeed({"render", "large.x", "-o", "a.png", "--size", "40x30"}).err.find("all opaque"), std::string::npos);
}

}  // namespace
}  // namespace atomesh::testing
