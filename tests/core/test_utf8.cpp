// The characters of a UTF-8 text, and of what is none.
#include <gtest/gtest.h>

#include <string>

#include "core/utf8.h"

namespace atomesh {
namespace {

std::u32string characters(std::string_view text) {
  std::u32string all;
  while (!text.empty()) all += take_character(text);
  return all;
}

TEST(Utf8, KnownCharacters) {
  EXPECT_EQ(characters("aÅ⁻𝑇"), U"aÅ⁻𝑇");
  EXPECT_EQ(characters(std::string_view("\0z", 2)), std::u32string(U"\0z", 2));
  EXPECT_EQ(characters("\x7F\xC2\x80\xDF\xBF\xE0\xA0\x80\xEF\xBF\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF"),
            U"\x7F\x80\x7FF\x800\xFFFF\x10000\x10FFFF");
  EXPECT_EQ(count_characters("10⁻³ Å"), 6);
  EXPECT_EQ(count_characters(""), 0);
}

TEST(Utf8, EveryBadByteIsReplacedAlone) {
  const std::u32string r(1, replacement_character);
  EXPECT_EQ(characters("\xFFz"), r + U"z");
  EXPECT_EQ(characters("\x80"), r);
  EXPECT_EQ(characters("\xC3"), r);          // cut short
  EXPECT_EQ(characters("\xE2\x81"), r + r);  // cut short
  EXPECT_EQ(characters("\xE2\x81z"), r + r + U"z");
  EXPECT_EQ(characters("\xC0\x80"), r + r);          // too long
  EXPECT_EQ(characters("\xE0\x9F\xBF"), r + r + r);  // too long
  EXPECT_EQ(characters("\xF0\x8F\xBF\xBF"), r + r + r + r);
  EXPECT_EQ(characters("\xED\xA0\x80"), r + r + r);          // half a pair
  EXPECT_EQ(characters("\xF4\x90\x80\x80"), r + r + r + r);  // beyond the last
}

}  // namespace
}  // namespace atomesh
