#include "core/utf8.h"

namespace atomesh {

namespace {

// Bytes of the character that begins with `lead`, 0 for a byte that begins none, and the part of the lead that counts.
struct Lead {
  std::size_t bytes;
  char32_t bits;
};

Lead lead_of(unsigned char lead) {
  if (lead < 0x80) return {1, lead};
  if (lead >= 0xC2 && lead < 0xE0) return {2, lead & 0x1FU};
  if (lead >= 0xE0 && lead < 0xF0) return {3, lead & 0x0FU};
  if (lead >= 0xF0 && lead < 0xF5) return {4, lead & 0x07U};
  return {0, 0};
}

}  // namespace

char32_t take_character(std::string_view& text) {
  const Lead lead = lead_of(static_cast<unsigned char>(text[0]));
  char32_t character = lead.bits;
  bool good = lead.bytes > 0 && lead.bytes <= text.size();
  for (std::size_t i = 1; good && i < lead.bytes; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    good = (byte & 0xC0U) == 0x80U;
    character = (character << 6U) | (byte & 0x3FU);
  }
  const bool too_long = (lead.bytes == 3 && character < 0x800) || (lead.bytes == 4 && character < 0x10000);
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (!good || too_long || surrogate || character > 0x10FFFF) {
    text.remove_prefix(1);
    return replacement_character;
  }
  text.remove_prefix(lead.bytes);
  return character;
}

int count_characters(std::string_view text) {
  int count = 0;
  for (; !text.empty(); ++count) take_character(text);
  return count;
}

}  // namespace atomesh
