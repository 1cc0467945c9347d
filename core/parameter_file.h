// .crf: the parameters as TOML, one key per row of parameter_table(), tables for the dotted parts. Hand-editable.
#pragma once

#include <string>
#include <string_view>

#include "core/parameters.h"

namespace atomesh {

// Starts from `base` and sets what the file names. Throws InputError "FILE:LINE: …" for TOML errors, unknown keys
// (naming the nearest), values of the wrong type or out of range.
Parameters read_crf(const std::string& path, const Parameters& base = {});
// The same from a text in memory; `name` stands for the file in messages.
Parameters parse_crf(std::string_view text, const std::string& name, const Parameters& base = {});

// Writes every row, grouped, each with its help and range as a comment. An existing file keeps its comments and its
// order where possible: only values are replaced and missing keys appended. Written beside and renamed.
void write_crf(const std::string& path, const Parameters& parameters);

}  // namespace atomesh
