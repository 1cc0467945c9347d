// A JSON value to be written: keys keep their order, numbers their shortest exact text, what is not finite becomes
// null.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry.h"

namespace atomesh::cli {

class Json {
 public:
  using Member = std::pair<std::string, Json>;

  Json() : value_(nullptr) {}
  Json(std::nullptr_t) : value_(nullptr) {}
  Json(bool value) : value_(value) {}
  Json(std::signed_integral auto value) : value_(static_cast<std::int64_t>(value)) {}
  Json(std::unsigned_integral auto value) : value_(static_cast<std::uint64_t>(value)) {}
  Json(double value) : value_(value) {}
  Json(const char* value) : value_(std::string(value)) {}
  Json(std::string_view value) : value_(std::string(value)) {}
  Json(std::string value) : value_(std::move(value)) {}
  Json(const Vec3& v);

  static Json object(std::initializer_list<Member> members = {});
  static Json array(std::initializer_list<Json> items = {});

  void set(std::string key, Json value);  // of an object; keys are written in the order they are set
  void push(Json value);                  // of an array

  bool null() const { return value_.index() == 0; }

  // Indented by two blanks; arrays of plain values stay on one line.
  std::string text() const;

 private:
  using Array = std::vector<Json>;
  using Object = std::vector<Member>;
  void append(std::string& out, int depth) const;
  bool plain() const { return value_.index() < 6; }

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> value_;
};

}  // namespace atomesh::cli
