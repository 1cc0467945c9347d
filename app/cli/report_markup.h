// Text inside XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace atomesh::cli {

// With & < > " ' escaped, so that it can stand between tags and inside a quoted attribute, and without the characters
// that XML does not have. Bytes that are no UTF-8 become U+FFFD.
std::string escape_markup(std::string_view text);

}  // namespace atomesh::cli
