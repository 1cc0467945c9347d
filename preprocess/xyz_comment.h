// The key=value pairs of an extended XYZ comment line.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace atomesh::reading {

struct XyzComment {
  std::vector<std::pair<std::string, std::string>> pairs;
  // The value of the first pair with this key (case-insensitive); nullptr when there is none.
  const std::string* find(std::string_view key) const;
};

// Values end at a blank unless quoted by "…", '…' or {…}; a backslash takes the next character as it is. Words without
// "=" are passed over: a comment may be prose.
XyzComment parse_xyz_comment(std::string_view comment);

}  // namespace atomesh::reading
