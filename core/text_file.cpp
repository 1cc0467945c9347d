#include "core/text_file.h"

#include <fast_float/fast_float.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/error.h"

namespace atomesh {

namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

MappedFile::MappedFile(const std::string& path) : path_(path) {
  // Non-blocking, so that a pipe nobody writes to is refused below instead of waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw InputError(path, 0, "cannot be opened: " + reason(errno));
  struct stat status {};
  std::string problem;
  if (::fstat(descriptor, &status) != 0) {
    problem = "cannot be read: " + reason(errno);
  } else if (S_ISDIR(status.st_mode)) {
    problem = "is a folder; expected a file";
  } else if (!S_ISREG(status.st_mode)) {
    problem = "is no regular file (a pipe or a device); write it to disk first";
  } else if (status.st_size > 0) {
    void* mapped = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapped == MAP_FAILED) {
      problem = "cannot be mapped: " + reason(errno);
    } else {
      data_ = static_cast<const char*>(mapped);
      size_ = static_cast<std::size_t>(status.st_size);
      ::madvise(mapped, size_, MADV_SEQUENTIAL);
    }
  }
  ::close(descriptor);
  if (!problem.empty()) throw InputError(path, 0, problem);
}

MappedFile::~MappedFile() {
  // munmap takes a pointer to non-const; nothing is written through it.
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

bool LineReader::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const void* newline = std::memchr(rest_.data(), '\n', rest_.size());
  const std::size_t length =
      newline != nullptr ? static_cast<std::size_t>(static_cast<const char*>(newline) - rest_.data()) : rest_.size();
  const std::size_t taken = newline != nullptr ? length + 1 : length;
  line = rest_.substr(0, length);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  rest_.remove_prefix(taken);
  consumed_ += taken;
  ++line_;
  return true;
}

std::string_view next_field(std::string_view& line) {
  const char* p = line.data();
  const char* const end = p + line.size();
  while (p != end && is_blank(*p)) ++p;
  const char* const begin = p;
  while (p != end && !is_blank(*p)) ++p;
  line = std::string_view(p, static_cast<std::size_t>(end - p));
  return {begin, static_cast<std::size_t>(p - begin)};
}

std::vector<std::string_view> split_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::string_view field = next_field(line); !field.empty(); field = next_field(line)) fields.push_back(field);
  return fields;
}

bool parse_real(std::string_view field, double& value) {
  if (!field.empty() && field.front() == '+') {
    field.remove_prefix(1);
    if (!field.empty() && (field.front() == '-' || field.front() == '+')) return false;
  }
  const char* const end = field.data() + field.size();
  double parsed = 0.0;
  const auto [rest, error] = fast_float::from_chars(field.data(), end, parsed);
  // A number too small for a double reads as 0 in every version of fast_float; later ones call it out of range.
  const bool read = error == std::errc() || (error == std::errc::result_out_of_range && parsed == 0.0);
  if (!read || rest != end || !std::isfinite(parsed)) return false;
  value = parsed;
  return true;
}

bool parse_integer(std::string_view field, std::int64_t& value) {
  if (!field.empty() && field.front() == '+') {
    field.remove_prefix(1);
    if (!field.empty() && field.front() == '-') return false;
  }
  const char* const end = field.data() + field.size();
  std::int64_t parsed = 0;
  const auto [rest, error] = std::from_chars(field.data(), end, parsed);
  if (error != std::errc() || rest != end) return false;
  value = parsed;
  return true;
}

namespace {

// A file in the folder of `path` that has no name yet, so that it goes with the process however that ends; nullptr
// where the file system has none.
std::FILE* open_without_name(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) return nullptr;
  // What cannot get a name later is of no use.
  std::FILE* stream = ::access("/proc/self/fd", X_OK) == 0 ? ::fdopen(file, "wb") : nullptr;
  if (stream == nullptr) ::close(file);
  return stream;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw Error(path + ": cannot be written: it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    // A pipe or a device (/dev/null, /dev/stdout) is written through: a rename would put a file in its place.
    file_ = std::fopen(path.c_str(), "wb");
  } else {
    // A link stays a link: what it points to is replaced.
    if (fs::is_symlink(fs::symlink_status(path, ignored))) {
      const fs::path target = fs::weakly_canonical(path, ignored);
      if (!ignored) path_ = target.string();
    }
    static std::atomic<unsigned> counter{0};
    temporary_ = path_ + "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".part";
    file_ = open_without_name(path_);
    named_ = file_ == nullptr;
    if (named_) file_ = std::fopen(temporary_.c_str(), "wbx");
  }
  if (file_ == nullptr) {
    const int error = errno;
    temporary_.clear();
    throw Error(path + ": cannot be written: " + reason(error));
  }
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (named_) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) {
    throw Error(path_ + ": cannot be written: " + reason(errno));
  }
}

std::string AtomicFile::place() const {
  if (temporary_.empty()) return path_;
  if (named_) return temporary_;
  return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(::fileno(file_));
}

void AtomicFile::commit() {
  bool flushed = std::ferror(file_) == 0 && std::fflush(file_) == 0;
  if (flushed && !temporary_.empty() && !named_) {
    const std::string open_file = "/proc/self/fd/" + std::to_string(::fileno(file_));
    flushed = named_ = ::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }
  const int flush_error = errno;
  const bool closed = std::fclose(file_) == 0;
  const int close_error = errno;
  file_ = nullptr;
  if (!flushed || !closed) {
    throw Error(path_ + ": cannot be written: " + reason(flushed ? close_error : flush_error));
  }
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    throw Error(path_ + ": cannot be written: " + reason(errno));
  }
  named_ = false;
}

}  // namespace atomesh
