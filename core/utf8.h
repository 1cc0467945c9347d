// The characters of a UTF-8 text.
#pragma once

#include <string_view>

namespace atomesh {

inline constexpr char32_t replacement_character = U'\uFFFD';

// Takes the first character off `text`, which must not be empty. A byte that begins none (cut short, spelt longer than
// need be, half of a surrogate pair, beyond the last character) is taken alone, as the replacement character.
char32_t take_character(std::string_view& text);

// Characters in `text`.
int count_characters(std::string_view text);

}  // namespace atomesh
