// The outside of a .crb (crb_format.h): named byte sections with checksums and compression. Knows nothing of what is in
// them.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/crb_format.h"
#include "core/progress.h"
#include "core/text_file.h"

namespace atomesh {

// Writes the sections in the order they are added. The bytes do not depend on the number of threads.
class CrbWriter {
 public:
  // At most `sections` are going to be added; `total_bytes` of them (uncompressed) make the progress's 100 %.
  CrbWriter(AtomicFile& file, std::size_t sections, bool compress, std::uint64_t total_bytes, Progress& progress);

  // `name` has at most 15 characters.
  void add(std::string_view name, std::span<const std::byte> bytes, std::size_t element);
  template <class T>
  void add(std::string_view name, const std::vector<T>& values, std::size_t element) {
    add(name, std::as_bytes(std::span(values)), element);
  }
  // Writes header and table. False when the file would break the rule of the largest ratio; it must then be written
  // again without compression.
  [[nodiscard]] bool finish();

 private:
  void write_compressed(CrbEntry& entry, std::span<const std::byte> bytes);
  void report(std::uint64_t bytes);

  AtomicFile& file_;
  std::size_t reserved_;
  bool compress_;
  std::uint64_t total_;
  std::uint64_t done_ = 0;
  std::uint64_t offset_;
  std::vector<CrbEntry> table_;
  Progress& progress_;
};

// Opens a .crb: header and table are checked, sections when they are read. Everything wrong is an InputError.
class CrbReader {
 public:
  // `bytes` is the whole file and must live as long as the reader; `path` is its name in messages.
  CrbReader(std::string_view bytes, std::string path);

  std::uint32_t version() const { return version_; }
  const std::vector<CrbEntry>& table() const { return table_; }
  static std::string name(const CrbEntry& entry);
  // nullptr when there is none.
  const CrbEntry* find(std::string_view section) const;

  // The unpacked section, which must be exactly `to.size()` bytes long.
  void read(std::string_view section, std::span<std::byte> to, Progress& progress) const;
  // The same as `count` elements; nothing is allocated before the section's length is known to be right.
  template <class T>
  std::vector<T> read_array(std::string_view section, std::uint64_t count, Progress& progress) const {
    require(section, count, sizeof(T));
    std::vector<T> values(static_cast<std::size_t>(count));
    read(section, std::as_writable_bytes(std::span(values)), progress);
    return values;
  }
  std::string read_bytes(std::string_view section, Progress& progress) const;

  [[noreturn]] void fail(std::string_view section, const std::string& message) const;

 private:
  // Fails unless the section exists and holds exactly count elements of `size` bytes.
  void require(std::string_view section, std::uint64_t count, std::size_t size) const;
  const CrbEntry& entry(std::string_view section) const;

  std::string_view bytes_;
  std::string path_;
  std::uint32_t version_ = 0;
  std::vector<CrbEntry> table_;
};

}  // namespace atomesh
