#include "preprocess/xyz_comment.h"

#include <algorithm>
#include <cctype>

namespace atomesh::reading {

const std::string* XyzComment::find(std::string_view key) const {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  for (const auto& [name, value] : pairs) {
    if (std::equal(name.begin(), name.end(), key.begin(), key.end(), same)) return &value;
  }
  return nullptr;
}

XyzComment parse_xyz_comment(std::string_view comment) {
  XyzComment result;
  std::size_t i = 0;
  const auto blank = [&](std::size_t at) { return comment[at] == ' ' || comment[at] == '\t'; };
  // Takes text up to the closing character, or to a blank (and for keys to "=") when there is none.
  const auto take = [&](char close, bool key) {
    std::string text;
    for (; i < comment.size(); ++i) {
      if (close != '\0' ? comment[i] == close : blank(i) || (key && comment[i] == '=')) break;
      if (comment[i] == '\\' && i + 1 < comment.size()) ++i;
      text += comment[i];
    }
    if (close != '\0' && i < comment.size()) ++i;
    return text;
  };
  const auto take_maybe_quoted = [&](bool key) {
    const char open = i < comment.size() ? comment[i] : '\0';
    const char close = open == '"' || open == '\'' ? open : open == '{' ? '}' : '\0';
    if (close != '\0') ++i;
    return take(close, key);
  };
  const auto skip_blanks = [&] {
    while (i < comment.size() && blank(i)) ++i;
  };
  for (skip_blanks(); i < comment.size(); skip_blanks()) {
    const std::size_t start = i;
    std::string key = take_maybe_quoted(true);
    const std::size_t key_end = i;
    skip_blanks();
    if (i < comment.size() && comment[i] == '=') {
      ++i;
      skip_blanks();
      std::string value = take_maybe_quoted(false);
      result.pairs.emplace_back(std::move(key), std::move(value));
    } else {
      i = std::max(key_end, start + 1);
    }
  }
  return result;
}

}  // namespace atomesh::reading
