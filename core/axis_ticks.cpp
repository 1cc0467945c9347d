#include "core/axis_ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace atomesh {

namespace {

// digits · 10^exponent, the way it is kept exactly.
struct Decimal {
  double digits = 0.0;  // a whole number
  int exponent = 0;
  // Dividing by an exact power rounds once: 3 · 10^-1 is 0.3, which 3 · 0.1 is not.
  double value() const { return exponent < 0 ? digits / std::pow(10.0, -exponent) : digits * std::pow(10.0, exponent); }
};

std::string fixed(double value, int decimals) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", std::max(0, decimals), std::abs(value));
  return text.data();
}

// "1234567.5" → "1,234,567.5".
std::string with_groups(const std::string& number) {
  const std::size_t whole = std::min(number.find('.'), number.size());
  std::string out;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (i > 0 && i < whole && (whole - i) % 3 == 0) out += ',';
    out += number[i];
  }
  return out;
}

// `largest` is that of all the ticks of the axis, which are written alike.
std::string tick_text(const Decimal& tick, double largest) {
  if (tick.digits == 0.0) return "0";
  const std::string sign = tick.digits < 0.0 ? "−" : "";
  if (largest < 1e6 && tick.exponent >= -4) return sign + with_groups(fixed(tick.value(), -tick.exponent));
  // As many digits after the first as there are above the step.
  const double digits = std::abs(tick.digits);
  const int power = static_cast<int>(std::floor(std::log10(digits) + 1e-9));
  const std::string mantissa = fixed(digits / std::pow(10.0, power), power);
  const std::string ten = power_of_ten_text(power + tick.exponent);
  return sign + (mantissa == "1" ? ten : mantissa + "×" + ten);
}

std::vector<AxisTick> ends(double min, double max) {
  if (min == max) return {{min, rounded_text(min, 6)}};
  // 17 digits tell any two doubles apart.
  for (int digits = 6;; ++digits) {
    std::vector<AxisTick> ticks{{min, rounded_text(min, digits)}, {max, rounded_text(max, digits)}};
    if (ticks[0].text != ticks[1].text || digits >= 17) return ticks;
  }
}

std::vector<AxisTick> with_texts(const std::vector<Decimal>& places) {
  double largest = 0.0;
  for (const Decimal& place : places) largest = std::max(largest, std::abs(place.value()));
  std::vector<AxisTick> ticks;
  for (const Decimal& place : places) ticks.push_back({place.value(), tick_text(place, largest)});
  return ticks;
}

// First and last multiple of `step` in [min, max]. What is off by rounding alone counts as in.
std::pair<double, double> multiples(double min, double max, double step) {
  return {std::ceil(min / step - 1e-9), std::floor(max / step + 1e-9)};
}

}  // namespace

std::string power_of_ten_text(int exponent) {
  static constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  if (exponent == 0) return "1";
  if (exponent == 1) return text;
  if (exponent < 0) text += "⁻";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[static_cast<std::size_t>(digit - '0')];
  return text;
}

std::string rounded_text(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, std::abs(value));
  std::string number = text.data();
  const std::string sign = value < 0.0 ? "−" : "";
  const std::size_t e = number.find('e');
  if (e == std::string::npos) return sign + (std::isfinite(value) ? with_groups(number) : number);
  const int exponent = std::stoi(number.substr(e + 1));
  // %g leaves fixed notation as soon as there are more digits before the point than asked for; people do later.
  if (exponent > 0 && exponent < 6) return sign + with_groups(fixed(std::stod(number), 0));
  const std::string mantissa = number.substr(0, e);
  return sign + (mantissa == "1" ? "" : mantissa + "×") + power_of_ten_text(exponent);
}

std::vector<AxisTick> linear_ticks(double min, double max, int at_most) {
  if (!std::isfinite(min) || !std::isfinite(max) || max < min) return {};
  const double range = max - min;
  if (!(range > 1e-12 * std::max(std::abs(min), std::abs(max))) || range < 1e-290 || range > 1e290) {
    return ends(min, max);
  }
  const int places = std::max(2, at_most);
  for (int exponent = static_cast<int>(std::floor(std::log10(range / places))) - 1;; ++exponent) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const auto [first, last] = multiples(min, max, Decimal{digit, exponent}.value());
      if (last - first + 1.0 > places) continue;
      if (last < first) return ends(min, max);
      std::vector<Decimal> ticks;
      // + 0.0: no negative zero
      for (double k = first; k <= last; ++k) ticks.push_back({k * digit + 0.0, exponent});
      return with_texts(ticks);
    }
  }
}

std::vector<AxisTick> logarithmic_ticks(double min, double max, int at_most) {
  if (!(min > 0.0) || !std::isfinite(max) || max < min) return {};
  const int places = std::max(2, at_most);
  min = std::max(min, 1e-300);  // below, powers of ten leave a double's range
  max = std::max(max, min);
  const int first = static_cast<int>(std::ceil(std::log10(min) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(max) + 1e-9));
  std::vector<AxisTick> ticks;
  const bool plain = first >= -4 && last <= 5;
  for (int exponent = first - 1; exponent <= last; ++exponent) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const Decimal place{digit, exponent};
      const double value = place.value();
      if (value < min * (1.0 - 1e-9) || value > max * (1.0 + 1e-9)) continue;
      ticks.push_back({value, tick_text(place, plain ? 0.0 : 1e6)});
    }
  }
  if (ticks.size() < 2) return linear_ticks(min, max, places);
  if (ticks.size() <= static_cast<std::size_t>(places)) return ticks;
  if (last <= first) return linear_ticks(min, max, places);
  ticks.clear();
  const int every = (last - first) / places + 1;
  for (int exponent = first; exponent <= last; ++exponent) {
    // Thinned out, those stay whose exponent is a multiple: 1 is one of them.
    if (exponent % every != 0) continue;
    const Decimal power{1.0, exponent};
    ticks.push_back({power.value(), first >= -3 && last <= 4 ? tick_text(power, 0.0) : power_of_ten_text(exponent)});
  }
  return ticks;
}

}  // namespace atomesh
