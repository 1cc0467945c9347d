// Round values along an axis: known answers, then what holds for any range.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/axis_ticks.h"

namespace atomesh {
namespace {

std::vector<std::string> texts(const std::vector<AxisTick>& ticks) {
  std::vector<std::string> all;
  for (const AxisTick& tick : ticks) all.push_back(tick.text);
  return all;
}

using Texts = std::vector<std::string>;

TEST(AxisTicks, LinearKnownAnswers) {
  EXPECT_EQ(texts(linear_ticks(0.0, 1.0, 6)), (Texts{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(texts(linear_ticks(0.0, 1.0, 5)), (Texts{"0", "0.5", "1.0"}));
  EXPECT_EQ(texts(linear_ticks(0.0, 83.7, 6)), (Texts{"0", "20", "40", "60", "80"}));
  EXPECT_EQ(texts(linear_ticks(-3.0, 3.0, 4)), (Texts{"−2", "0", "2"}));
  EXPECT_EQ(texts(linear_ticks(0.0, 4200.0, 6)), (Texts{"0", "1,000", "2,000", "3,000", "4,000"}));
  EXPECT_EQ(texts(linear_ticks(0.0, 2.4e6, 6)), (Texts{"0", "5×10⁵", "1.0×10⁶", "1.5×10⁶", "2.0×10⁶"}));
  EXPECT_EQ(texts(linear_ticks(0.0, 3.1e-7, 4)), (Texts{"0", "10⁻⁷", "2×10⁻⁷", "3×10⁻⁷"}));
  // An end that is a tick but for rounding is one.
  EXPECT_EQ(texts(linear_ticks(0.0, 0.1 + 0.2, 4)), (Texts{"0", "0.1", "0.2", "0.3"}));
}

TEST(AxisTicks, LogarithmicKnownAnswers) {
  EXPECT_EQ(texts(logarithmic_ticks(0.4, 3000.0, 8)), (Texts{"1", "10", "100", "1,000"}));
  EXPECT_EQ(texts(logarithmic_ticks(18.0, 3000.0, 8)), (Texts{"20", "50", "100", "200", "500", "1,000", "2,000"}));
  EXPECT_EQ(texts(logarithmic_ticks(1.9e-6, 2e-5, 8)), (Texts{"2×10⁻⁶", "5×10⁻⁶", "10⁻⁵", "2×10⁻⁵"}));
  EXPECT_EQ(texts(logarithmic_ticks(3e-7, 0.2, 8)), (Texts{"10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"}));
  EXPECT_EQ(texts(logarithmic_ticks(3e-7, 2.0, 4)), (Texts{"10⁻⁶", "10⁻⁴", "10⁻²", "1"}));
  EXPECT_EQ(texts(logarithmic_ticks(1.5, 30.0, 8)), (Texts{"2", "5", "10", "20"}));
  EXPECT_EQ(texts(logarithmic_ticks(2.1, 3.9, 4)), (Texts{"2.5", "3.0", "3.5"}));
  EXPECT_EQ(power_of_ten_text(-12), "10⁻¹²");
}

TEST(AxisTicks, RoundedKnownAnswers) {
  EXPECT_EQ(rounded_text(83.68, 3), "83.7");
  EXPECT_EQ(rounded_text(1234.5, 3), "1,230");
  EXPECT_EQ(rounded_text(-0.05, 3), "−0.05");
  EXPECT_EQ(rounded_text(4.567e7, 3), "4.57×10⁷");
  EXPECT_EQ(rounded_text(3e-6, 3), "3×10⁻⁶");
  EXPECT_EQ(rounded_text(1e6, 3), "10⁶");
  EXPECT_EQ(rounded_text(999999.0, 3), "10⁶");
  EXPECT_EQ(rounded_text(0.0, 3), "0");
  EXPECT_EQ(rounded_text(std::numeric_limits<double>::infinity(), 3), "inf");
}

TEST(AxisTicks, NothingOfNothing) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(linear_ticks(1.0, 0.0, 5).empty());
  EXPECT_TRUE(linear_ticks(0.0, inf, 5).empty());
  EXPECT_TRUE(linear_ticks(nan, 1.0, 5).empty());
  EXPECT_TRUE(logarithmic_ticks(0.0, 1.0, 5).empty());
  EXPECT_TRUE(logarithmic_ticks(-1.0, 1.0, 5).empty());
  ASSERT_EQ(linear_ticks(7.5, 7.5, 5).size(), 1U);
  EXPECT_EQ(linear_ticks(7.5, 7.5, 5)[0].text, "7.5");
  EXPECT_EQ(linear_ticks(1e9, 1e9 + 1e-6, 5).size(), 2U);
  EXPECT_FALSE(linear_ticks(-1e308, 1e308, 5).empty());
  EXPECT_FALSE(logarithmic_ticks(5e-324, 1e308, 5).empty());
}

TEST(AxisTicks, AnyRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> power(-12.0, 12.0);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const double min = sign(random) * std::pow(10.0, power(random));
    const double max = min + std::pow(10.0, power(random));
    const int at_most = 2 + i % 11;
    for (const auto& ticks : {linear_ticks(min, max, at_most), logarithmic_ticks(std::abs(min), max, at_most)}) {
      for (std::size_t t = 0; t < ticks.size(); ++t) {
        const double slack = 1e-8 * (max - min);
        EXPECT_GE(ticks[t].value, min - slack);
        EXPECT_LE(ticks[t].value, max + slack);
        EXPECT_FALSE(ticks[t].text.empty());
        if (t == 0) continue;
        EXPECT_GT(ticks[t].value, ticks[t - 1].value);
        EXPECT_NE(ticks[t].text, ticks[t - 1].text) << min << " to " << max;
      }
    }
    const auto ticks = linear_ticks(min, max, at_most);
    EXPECT_GE(ticks.size(), 1U);
    EXPECT_LE(ticks.size(), static_cast<std::size_t>(at_most)) << min << " to " << max;
  }
}

}  // namespace
}  // namespace atomesh
