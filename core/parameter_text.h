// The values of parameters as text, exactly there and back: the shortest decimal that reads to the same number.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/color_map.h"
#include "core/geometry.h"

namespace atomesh {

// "0.3", "1e-09"; a number read back has the same bits (negative zero included).
std::string real_text(double value);
std::string real_text(float value);
// "0.1,0.2,0.3"
std::string vector_text(const Vec3& value);
std::string vector_text(const Vec3f& value);
std::string vector_text(const Vec4f& value);
// A preset's name where the map is one, else "0:0.1,0.2,0.3,0.4 1:…".
std::string color_map_text(const ColorMap& map);

// Each reads the whole text (blanks around it and around commas are skipped) and returns nothing for anything else:
// trailing junk, nan, infinity, too few or too many components.
std::optional<double> read_real(std::string_view text);
std::optional<float> read_real_float(std::string_view text);
std::optional<int> read_integer(std::string_view text);
std::optional<bool> read_boolean(std::string_view text);  // true, false, on, off, yes, no, 1, 0
std::optional<Vec3> read_vector(std::string_view text);
std::optional<Vec3f> read_vector_float(std::string_view text);
// "#rrggbb" or "r,g,b"; components are not checked against [0,1].
std::optional<Vec3f> read_rgb(std::string_view text);
// "#rrggbb", "#rrggbbaa", "r,g,b" or "r,g,b,a"; A is 1 where it is left out.
std::optional<Vec4f> read_rgba(std::string_view text);
// A preset's name or "scalar:color scalar:color …". Throws UsageError saying which entry is wrong.
ColorMap read_color_map(std::string_view text);

}  // namespace atomesh
