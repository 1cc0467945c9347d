// Words of the command line that are more than one number.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace atomesh::cli {

// "640x480" → {640, 480}. Throws UsageError for anything else and for sides outside 1..32768.
std::pair<int, int> parse_size(const std::string& text);

// A count of 0 or more: "20000". Throws UsageError that names `option`; a sign, a fraction or trailing junk is none.
std::uint64_t parse_count(std::string_view option, const std::string& text);

// A time of 0 or more: "100", "16.7". Throws UsageError that names `option`.
double parse_milliseconds(std::string_view option, const std::string& text);

// A difference between channel values, 0 to 1: "0.01", or a fraction like "2/255". Throws UsageError.
double parse_tolerance(const std::string& text);

}  // namespace atomesh::cli
