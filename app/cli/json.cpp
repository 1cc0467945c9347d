#include "app/cli/json.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace atomesh::cli {

namespace {

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (code < 0x20) {
      constexpr char digits[] = "0123456789abcdef";
      out += "\\u00";
      out += digits[code >> 4];
      out += digits[code & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

void append_number(std::string& out, auto value) {
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void new_line(std::string& out, int depth) {
  out += '\n';
  out.append(2 * static_cast<std::size_t>(depth), ' ');
}

}  // namespace

Json::Json(const Vec3& v) : value_(Array{v.x, v.y, v.z}) {}

Json Json::object(std::initializer_list<Member> members) {
  Json json;
  json.value_ = Object(members);
  return json;
}

Json Json::array(std::initializer_list<Json> items) {
  Json json;
  json.value_ = Array(items);
  return json;
}

void Json::set(std::string key, Json value) {
  std::get<Object>(value_).emplace_back(std::move(key), std::move(value));
}

void Json::push(Json value) {
  std::get<Array>(value_).push_back(std::move(value));
}

std::string Json::text() const {
  std::string out;
  append(out, 0);
  out += '\n';
  return out;
}

void Json::append(std::string& out, int depth) const {
  if (const auto* boolean = std::get_if<bool>(&value_)) {
    out += *boolean ? "true" : "false";
  } else if (const auto* integer = std::get_if<std::int64_t>(&value_)) {
    append_number(out, *integer);
  } else if (const auto* natural = std::get_if<std::uint64_t>(&value_)) {
    append_number(out, *natural);
  } else if (const auto* real = std::get_if<double>(&value_); real && std::isfinite(*real)) {
    append_number(out, *real);
  } else if (const auto* string = std::get_if<std::string>(&value_)) {
    append_quoted(out, *string);
  } else if (const auto* array = std::get_if<Array>(&value_)) {
    const bool one_line = std::all_of(array->begin(), array->end(), [](const Json& item) { return item.plain(); });
    out += '[';
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (i > 0) out += one_line ? ", " : ",";
      if (!one_line) new_line(out, depth + 1);
      (*array)[i].append(out, depth + 1);
    }
    if (!one_line) new_line(out, depth);
    out += ']';
  } else if (const auto* object = std::get_if<Object>(&value_)) {
    out += '{';
    for (std::size_t i = 0; i < object->size(); ++i) {
      if (i > 0) out += ',';
      new_line(out, depth + 1);
      append_quoted(out, (*object)[i].first);
      out += ": ";
      (*object)[i].second.append(out, depth + 1);
    }
    if (!object->empty()) new_line(out, depth);
    out += '}';
  } else {
    out += "null";
  }
}

}  // namespace atomesh::cli
