#include "app/cli/report_markup.h"

#include "core/utf8.h"

namespace atomesh::cli {

std::string escape_markup(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::string_view before = text;
    const char32_t character = take_character(text);
    switch (character) {
      case U'&':
        out += "&amp;";
        break;
      case U'<':
        out += "&lt;";
        break;
      case U'>':
        out += "&gt;";
        break;
      case U'"':
        out += "&quot;";
        break;
      case U'\'':
        out += "&#39;";
        break;
      case replacement_character:
        out += "\uFFFD";
        break;
      default:
        // XML has no control characters but these, and not the two that are never characters.
        if ((character < 0x20 && character != U'\n' && character != U'\t') || (character | 1U) == 0xFFFF) continue;
        out += before.substr(0, before.size() - text.size());
    }
  }
  return out;
}

}  // namespace atomesh::cli
