// Parameters as the text of a .crf file: the words, without reading any.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/parameters.h"

namespace atomesh {

// A whole new file: every row under its group, each kind explained once by a comment.
std::string fresh_crf_text(const Parameters& parameters);

// True for keys of species that say "auto", which is said by leaving them out.
bool said_by_absence(const Parameters& parameters, const std::string& key);
// The keys such a file has: all others.
std::vector<std::string> keys_to_write(const Parameters& parameters);
// The table a key stands in ("light.1") and its name there ("color"). A species' name is one part, dots and all.
std::pair<std::string, std::string> split_key(const std::string& key);
// A part of a key, in quotes where TOML needs them.
std::string toml_key(std::string_view part);
// The value of a key in TOML; a colour map that is no preset takes several lines.
std::string toml_value(const Parameters& parameters, const std::string& key);

}  // namespace atomesh
