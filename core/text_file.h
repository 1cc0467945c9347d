// Fast, strict reading of text files, and files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace atomesh {

// A file's bytes, memory-mapped read-only. Throws InputError when it cannot be opened, is a folder, or cannot be
// mapped.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::string_view bytes() const { return {data_, size_}; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

// Hands out the lines of a text one by one, without "\n" or "\r\n"; line_number() counts from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  // False at the end; a last line without newline counts.
  bool next(std::string_view& line);
  std::uint64_t line_number() const { return line_; }
  std::size_t offset() const { return consumed_; }  // bytes handed out so far

 private:
  std::string_view rest_;
  std::size_t consumed_ = 0;
  std::uint64_t line_ = 0;
};

// Takes the next blank-separated field off the front of `line`; "" when there is none.
std::string_view next_field(std::string_view& line);
// All fields of a line.
std::vector<std::string_view> split_fields(std::string_view line);

// The whole field as a finite number; false for anything else (trailing junk, nan, inf, empty). Fortran's D exponent is
// not read. A leading '+' is.
bool parse_real(std::string_view field, double& value);
bool parse_integer(std::string_view field, std::int64_t& value);

// Writes a file beside `path` and renames it on commit(); a destructor without commit removes what was written, so a
// cancelled or failed write leaves neither a new half file nor harms the old one. Where the file system can (Linux's
// own do), what is written has no name before the commit: not even a process that is killed leaves anything. Throws
// Error with the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  std::FILE* stream() { return file_; }
  // A name by which the file can be opened until commit(), by this process and those it starts: for a library or
  // program that writes by name.
  std::string place() const;
  void commit();

 private:
  std::string path_;
  std::string temporary_;  // what it is called before it is renamed; "" for a device
  bool named_ = false;     // and is there under that name
  std::FILE* file_ = nullptr;
};

}  // namespace atomesh
