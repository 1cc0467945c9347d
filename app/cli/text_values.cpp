#include "app/cli/text_values.h"

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

std::pair<int, int> parse_size(const std::string& text) {
  constexpr std::int64_t largest = 32768;
  const std::size_t cross = text.find('x');
  std::int64_t width = 0;
  std::int64_t height = 0;
  if (cross == std::string::npos || !parse_integer(text.substr(0, cross), width) ||
      !parse_integer(text.substr(cross + 1), height) || width < 1 || height < 1 || width > largest ||
      height > largest) {
    throw UsageError("--size: expected WIDTHxHEIGHT in pixels, each 1 to 32768, got \"" + text + "\"");
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

std::uint64_t parse_count(std::string_view option, const std::string& text) {
  std::int64_t value = 0;
  if (!parse_integer(text, value) || value < 0) {
    throw UsageError(std::string(option) + ": expected a whole number of 0 or more, got \"" + text + "\"");
  }
  return static_cast<std::uint64_t>(value);
}

double parse_milliseconds(std::string_view option, const std::string& text) {
  double value = 0.0;
  if (!parse_real(text, value) || !(value >= 0.0) || value > 1e12) {
    throw UsageError(std::string(option) + ": expected milliseconds, 0 or more, got \"" + text + "\"");
  }
  return value;
}

double parse_tolerance(const std::string& text) {
  const std::size_t slash = text.find('/');
  double value = 0.0;
  double divisor = 1.0;
  const bool number = parse_real(text.substr(0, slash), value) &&
                      (slash == std::string::npos || parse_real(text.substr(slash + 1), divisor));
  if (!number || divisor <= 0.0 || value < 0.0 || value / divisor > 1.0) {
    throw UsageError("--tolerance: expected a number from 0 to 1 or a fraction like 2/255, got \"" + text + "\"");
  }
  return value / divisor;
}

}  // namespace atomesh::cli
