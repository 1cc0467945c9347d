// Round values along an axis, with their texts: for the legends of pictures and the plots of reports.
#pragma once

#include <string>
#include <vector>

namespace atomesh {

struct AxisTick {
  double value = 0.0;
  std::string text;  // UTF-8: "0.25", "1,000", "−2", "1.5×10⁶", "10⁻³"
};

// The multiples of the smallest step 1, 2 or 5 times a power of ten of which no more than `at_most` lie in [min, max],
// upwards. Texts have as many decimals as the step needs. A range that holds none, or too narrow to tell its ends
// apart, gives its ends; one that is empty or not finite gives nothing. at_most is at least 2.
std::vector<AxisTick> linear_ticks(double min, double max, int at_most);

// 1, 2 and 5 times the powers of ten in [min, max]; where there are more than `at_most` the powers alone, every second,
// third … of them; where that leaves fewer than two, linear ticks. min must be above 0.
std::vector<AxisTick> logarithmic_ticks(double min, double max, int at_most);

// Rounded to that many significant digits, 1 to 17: "83.7", "1,230", "−0.05", "4.57×10⁷", "3×10⁻⁶". What is not finite
// as C writes it.
std::string rounded_text(double value, int digits);

// 10 to the `exponent`: "10⁻³".
std::string power_of_ten_text(int exponent);

}  // namespace atomesh
