// Every vacancy and extra atom planted in the samples is found at its place, and none is invented.
#include "samples/samples.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

constexpr double near_enough = 0.5;  // Å

Sample small_sample(std::string_view name) {
  SampleOptions options;
  options.atoms = 20000;
  return make_sample(name, options);
}

std::vector<std::pair<Vec3, std::string>> sites(const Sample& sample) {
  std::vector<std::pair<Vec3, std::string>> result;
  for (const SampleTruth::Site& site : sample.truth.vacancies) result.emplace_back(site.position, site.species);
  return result;
}

class SampleDefects : public testing::TestWithParam<std::string_view> {};

TEST_P(SampleDefects, AreFoundAndNoneIsInvented) {
  const Sample sample = small_sample(GetParam());
  if (!sample.unit_cell) {
    EXPECT_EQ(GetParam(), "sponge");
    return;
  }
  const Quantified q = quantify(sample.atoms, *sample.unit_cell);
  EXPECT_GT(q.report.matched_fraction, 0.9);
  expect_vacancies(q, sample.atoms, sites(sample), near_enough, std::string(GetParam()));
  expect_extras(q, sample.truth.extras, std::string(GetParam()));
  // What was pulled off its site shows.
  for (const Index atom : sample.truth.displaced) {
    ASSERT_TRUE(q.defects.defective(atom)) << "displaced atom " << atom;
  }
  EXPECT_EQ(q.report.positional_atoms == 0, sample.truth.displaced.empty());
}

std::vector<std::string_view> names() {
  std::vector<std::string_view> result;
  for (const SampleInfo& info : sample_table()) result.push_back(info.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(Samples, SampleDefects, testing::ValuesIn(names()), [](const auto& test) {
  std::string name(test.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace atomesh::test
