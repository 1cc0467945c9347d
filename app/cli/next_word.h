// Text that is one list of words, whatever its lines.
#pragma once

#include <algorithm>
#include <string_view>

namespace atomesh::cli {

// Takes the next word off the front of `text`, over blanks and ends of lines; "" when there is none.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
  const std::size_t last = std::min(text.find_first_of(blanks, first), text.size());
  const std::string_view word = text.substr(first, last - first);
  text.remove_prefix(last);
  return word;
}

}  // namespace atomesh::cli
