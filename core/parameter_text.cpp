#include "core/parameter_text.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace atomesh {

namespace {

template <class Number>
std::string shortest(Number value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

template <class Vector>
std::string joined(const Vector& value) {
  std::string text;
  for (int i = 0; i < Vector::length(); ++i) {
    if (i > 0) text += ',';
    text += shortest(value[i]);
  }
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

template <class Number>
std::optional<Number> parse_finite(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto result = fast_float::from_chars(text.data(), text.data() + text.size(), value);
  // Numbers that overflow come back as infinity.
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

template <class Vector>
std::optional<Vector> parse_components(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != static_cast<std::size_t>(Vector::length())) return {};
  Vector value{};
  for (int i = 0; i < Vector::length(); ++i) {
    const auto component = parse_finite<typename Vector::value_type>(parts[static_cast<std::size_t>(i)]);
    if (!component) return {};
    value[i] = *component;
  }
  return value;
}

// "rrggbb" or "rrggbbaa" after the #.
std::optional<Vec4f> parse_hexadecimal(std::string_view digits) {
  if (digits.size() != 6 && digits.size() != 8) return {};
  Vec4f color(0.0F, 0.0F, 0.0F, 1.0F);
  for (std::size_t i = 0; i * 2 < digits.size(); ++i) {
    unsigned byte = 0;
    const char* end = digits.data() + 2 * i + 2;
    const auto result = std::from_chars(digits.data() + 2 * i, end, byte, 16);
    if (result.ec != std::errc() || result.ptr != end) return {};
    color[static_cast<int>(i)] = static_cast<float>(byte) / 255.0F;
  }
  return color;
}

}  // namespace

std::string real_text(double value) {
  return shortest(value);
}
std::string real_text(float value) {
  return shortest(value);
}
std::string vector_text(const Vec3& value) {
  return joined(value);
}
std::string vector_text(const Vec3f& value) {
  return joined(value);
}
std::string vector_text(const Vec4f& value) {
  return joined(value);
}

std::string color_map_text(const ColorMap& map) {
  for (const std::string& name : preset_color_map_names()) {
    if (preset_color_map(name) == map) return name;
  }
  std::string text;
  for (const ColorMapEntry& entry : map.entries) {
    if (!text.empty()) text += ' ';
    text += shortest(entry.scalar) + ':' + joined(entry.color);
  }
  return text;
}

std::optional<double> read_real(std::string_view text) {
  return parse_finite<double>(text);
}
std::optional<float> read_real_float(std::string_view text) {
  return parse_finite<float>(text);
}

std::optional<int> read_integer(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  int value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return {};
  return value;
}

std::optional<bool> read_boolean(std::string_view text) {
  text = trimmed(text);
  for (const char* word : {"true", "on", "yes", "1"}) {
    if (text == word) return true;
  }
  for (const char* word : {"false", "off", "no", "0"}) {
    if (text == word) return false;
  }
  return {};
}

std::optional<Vec3> read_vector(std::string_view text) {
  return parse_components<Vec3>(text);
}
std::optional<Vec3f> read_vector_float(std::string_view text) {
  return parse_components<Vec3f>(text);
}

std::optional<Vec3f> read_rgb(std::string_view text) {
  text = trimmed(text);
  if (text.size() == 7 && text[0] == '#') {
    const auto color = parse_hexadecimal(text.substr(1));
    return color ? std::optional(Vec3f(*color)) : std::nullopt;
  }
  return parse_components<Vec3f>(text);
}

std::optional<Vec4f> read_rgba(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text[0] == '#') return parse_hexadecimal(text.substr(1));
  if (std::count(text.begin(), text.end(), ',') == 2) {
    const auto color = parse_components<Vec3f>(text);
    return color ? std::optional(Vec4f(*color, 1.0F)) : std::nullopt;
  }
  return parse_components<Vec4f>(text);
}

ColorMap read_color_map(std::string_view text) {
  text = trimmed(text);
  if (text.find(':') == std::string_view::npos) return preset_color_map(std::string(text));
  ColorMap map;
  for (const std::string_view part : split(text, ' ')) {
    if (part.empty()) continue;
    const std::size_t colon = part.find(':');
    const auto scalar = colon == std::string_view::npos ? std::nullopt : read_real(part.substr(0, colon));
    const auto color = colon == std::string_view::npos ? std::nullopt : read_rgba(part.substr(colon + 1));
    if (!scalar || !color) {
      throw UsageError(
          "color map entry " + std::to_string(map.entries.size() + 1) + " \"" + std::string(part) +
          "\": expected SCALAR:COLOR, as in 0.5:#ff8800cc or 0.5:1,0.5,0,0.8, and blanks between the entries");
    }
    map.entries.push_back({*scalar, *color});
  }
  check_color_map(map);
  return map;
}

}  // namespace atomesh
