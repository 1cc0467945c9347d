// The small sections of a .crb, value by value.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/crb_container.h"
#include "core/geometry.h"

namespace atomesh {

class ByteWriter {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&v), sizeof(T));
  }
  template <class T>
  void values(const std::vector<T>& v) {
    bytes_.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
  }
  void count(std::size_t n) { value(static_cast<std::uint32_t>(n)); }
  void string(std::string_view text) {
    count(text.size());
    bytes_ += text;
  }
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_.data(), bytes_.size())); }

 private:
  std::string bytes_;
};

// Reads back; running past the end, and bytes left over at finish(), are InputErrors of the section.
class ByteReader {
 public:
  ByteReader(const CrbReader& file, std::string_view section, Progress& progress)
      : file_(file), section_(section), bytes_(file.read_bytes(section, progress)), rest_(bytes_) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T v;
    std::memcpy(&v, take(sizeof(T)).data(), sizeof(T));
    return v;
  }
  // A number of items of at least `smallest` bytes each; refused when the section is too short for them.
  std::uint32_t count(std::size_t smallest) {
    const auto n = value<std::uint32_t>();
    if (n > rest_.size() / smallest) file_.fail(section_, "counts more items than it holds");
    return n;
  }
  std::string string() { return std::string(take(value<std::uint32_t>())); }
  void finish() const {
    if (!rest_.empty()) file_.fail(section_, "longer than its content");
  }

 private:
  std::string_view take(std::size_t bytes) {
    if (bytes > rest_.size()) file_.fail(section_, "shorter than its content");
    const std::string_view taken = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return taken;
  }

  const CrbReader& file_;
  std::string section_;
  std::string bytes_;
  std::string_view rest_;
};

}  // namespace atomesh
