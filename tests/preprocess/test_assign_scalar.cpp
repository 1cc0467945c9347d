// A value of the user's choice in the place of quantified defects.
#include <gtest/gtest.h>

#include "core/error.h"
#include "preprocess/assign_scalar.h"

namespace atomesh {
namespace {

Atoms three_atoms() {
  Atoms atoms;
  atoms.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  atoms.species = {atoms.add_species("Ga"), atoms.add_species("In"), atoms.add_species("Ga")};
  atoms.columns.push_back({"energy", {-3.5, -3.25, -1.5}});
  return atoms;
}

TEST(AssignScalar, ColumnStartsAtZero) {
  const Defects defects = assign_scalar(three_atoms(), "energy");
  EXPECT_EQ(defects.positional, (std::vector<float>{0.0F, 0.25F, 2.0F}));
  EXPECT_EQ(defects.vacancy, (std::vector<float>{0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(defects.extra, (std::vector<float>{0.0F, 0.0F, 0.0F}));
  EXPECT_TRUE(defects.vacancies.empty());
  EXPECT_TRUE(defects.extras.empty());
}

TEST(AssignScalar, ValuesBySpecies) {
  EXPECT_EQ(assign_scalar(three_atoms(), "Ga=0,In=1").positional, (std::vector<float>{0.0F, 1.0F, 0.0F}));
  EXPECT_EQ(assign_scalar(three_atoms(), "In=2.5").positional, (std::vector<float>{0.0F, 2.5F, 0.0F}));
  // The smallest value is shifted to zero, so that a negative one is seen too.
  EXPECT_EQ(assign_scalar(three_atoms(), "In=-1").positional, (std::vector<float>{1.0F, 0.0F, 1.0F}));
}

std::string complaint(const std::string& scalar) {
  try {
    assign_scalar(three_atoms(), scalar);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(AssignScalar, WhatTheFileLacksIsNamed) {
  EXPECT_NE(complaint("enrgy").find("did you mean \"energy\""), std::string::npos) << complaint("enrgy");
  EXPECT_NE(complaint("Im=1").find("did you mean \"In\""), std::string::npos) << complaint("Im=1");
  EXPECT_NE(complaint("In=one").find("In=one"), std::string::npos) << complaint("In=one");
  EXPECT_NE(complaint("In=1,Ga").find("\"Ga\""), std::string::npos) << complaint("In=1,Ga");
  EXPECT_NE(complaint("In=1,,Ga=2"), "");
}

}  // namespace
}  // namespace atomesh
