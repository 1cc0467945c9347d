#include "core/memory.h"

#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

std::atomic<std::uint64_t> counted_limit{0};
std::atomic<std::uint64_t> highest_before_reset{0};
// Where the kernel's mark cannot be reset: the highest seen since.
std::atomic<bool> mark_is_stuck{false};
std::atomic<std::uint64_t> highest_sample{0};

void raise_to(std::atomic<std::uint64_t>& mark, std::uint64_t value) {
  std::uint64_t seen = mark.load();
  while (seen < value && !mark.compare_exchange_weak(seen, value)) {
  }
}

// "VmRSS:    1234 kB" of a file of such lines, in bytes.
std::optional<std::uint64_t> kilobytes_of(const char* path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    std::string_view rest = std::string_view(line).substr(key.size());
    std::int64_t value = 0;
    if (parse_integer(next_field(rest), value) && value >= 0) return static_cast<std::uint64_t>(value) * 1024;
  }
  return std::nullopt;
}

std::uint64_t status(std::string_view key) {
  return kilobytes_of("/proc/self/status", key).value_or(0);
}

// The number that a file consists of; nothing for "max" and for a file that is not there.
std::optional<std::uint64_t> number_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  if (file >> value) return value;
  return std::nullopt;
}

// "total_inactive_file 1234" of memory.stat: file pages that make room when it is asked for.
std::uint64_t reclaimable_in(const std::string& path, std::string_view key) {
  std::ifstream file(path);
  std::string name;
  std::uint64_t value = 0;
  while (file >> name >> value) {
    if (name == key) return value;
  }
  return 0;
}

void take_smaller(std::optional<MemoryRoom>& room, std::uint64_t bytes, const char* limit) {
  if (!room || bytes < room->bytes) room = MemoryRoom{bytes, limit};
}

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) {
  return limit > used ? limit - used : 0;
}

void look_at_resource(std::optional<MemoryRoom>& room, int resource, std::string_view used, const char* name) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  take_smaller(room, difference(limit.rlim_cur, status(used)), name);
}

// The names of the files of version 1 and 2 of the memory controller.
struct Controller {
  const char* limit;
  const char* used;
  const char* reclaimable;
};
constexpr Controller version_1{"/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file"};
constexpr Controller version_2{"/memory.max", "/memory.current", "inactive_file"};

// The group and all it is in, up to the mount.
void look_at_groups(std::optional<MemoryRoom>& room, const Controller& files, const std::string& mount,
                    std::string group) {
  while (true) {
    const std::string folder = mount + group;
    const auto limit = number_in(folder + files.limit);
    const auto used = number_in(folder + files.used);
    if (limit && used) {
      const std::uint64_t held = difference(*used, reclaimable_in(folder + "/memory.stat", files.reclaimable));
      take_smaller(room, difference(*limit, held), "the control group");
    }
    if (group.empty()) return;
    group.resize(group.rfind('/') == std::string::npos ? 0 : group.rfind('/'));
  }
}

}  // namespace

std::uint64_t current_memory() {
  return status("VmRSS:");
}

std::uint64_t recent_peak_memory() {
  if (!mark_is_stuck) return status("VmHWM:");
  raise_to(highest_sample, current_memory());
  return highest_sample;
}

std::uint64_t peak_memory() {
  raise_to(highest_before_reset, status("VmHWM:"));
  return highest_before_reset;
}

void reset_peak_memory() {
  peak_memory();
  // proc(5): 5 resets the peak resident set size to the current one.
  bool reset = false;
  if (std::FILE* file = std::fopen("/proc/self/clear_refs", "we")) {
    reset = std::fputs("5\n", file) >= 0;
    reset = std::fclose(file) == 0 && reset;
  }
  mark_is_stuck = !reset;
  highest_sample = current_memory();
}

void release_free_memory() {
  ::malloc_trim(0);
}

std::optional<MemoryRoom> control_group_room(std::string_view membership, const std::string& root) {
  std::optional<MemoryRoom> room;
  LineReader lines(membership);
  std::string_view line;
  while (lines.next(line)) {
    // "4:memory:/group" of version 1, "0::/group" of version 2.
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string_view::npos ? first : line.find(':', first + 1);
    if (second == std::string_view::npos) continue;
    const std::string controllers = "," + std::string(line.substr(first + 1, second - first - 1)) + ",";
    std::string group(line.substr(second + 1));
    if (group == "/") group.clear();
    if (controllers == ",,") {
      look_at_groups(room, version_2, root, group);
    } else if (controllers.find(",memory,") != std::string::npos) {
      look_at_groups(room, version_1, root + "/memory", group);
    }
  }
  return room;
}

std::optional<MemoryRoom> memory_room() {
  std::optional<MemoryRoom> room;
  if (const auto available = kilobytes_of("/proc/meminfo", "MemAvailable:")) {
    take_smaller(room, *available, "the machine's free memory");
  }
  std::ostringstream membership;
  if (std::ifstream file("/proc/self/cgroup"); file) membership << file.rdbuf();
  if (const auto group = control_group_room(membership.str(), "/sys/fs/cgroup")) {
    take_smaller(room, group->bytes, "the control group");
  }
  look_at_resource(room, RLIMIT_AS, "VmSize:", "ulimit -v");
  look_at_resource(room, RLIMIT_DATA, "VmData:", counted_limit > 0 ? "--memory-limit" : "ulimit -d");
  if (counted_limit > 0) take_smaller(room, difference(counted_limit, current_memory()), "--memory-limit");
  return room;
}

void limit_memory(std::uint64_t bytes) {
  if (bytes > 0 && bytes < current_memory()) {
    throw UsageError("a memory limit of " + memory_text(bytes) + " is less than the " + memory_text(current_memory()) +
                     " the program takes by itself");
  }
  counted_limit = bytes;
#if !defined(__SANITIZE_ADDRESS__)  // which maps terabytes for itself
  if (bytes == 0) return;
  // RLIMIT_DATA counts what is written to and belongs to the process alone, not address space that is only reserved or
  // files that are mapped to be read.
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
#endif
}

void require_memory(std::string_view what, std::uint64_t bytes, std::string_view advice) {
  std::optional<MemoryRoom> room = memory_room();
  if (!room || bytes <= room->bytes) return;
  // What the allocator keeps of freed memory is ours already.
  release_free_memory();
  room = memory_room();
  if (!room || bytes <= room->bytes) return;
  throw UnavailableError(std::string(what) + " needs about " + memory_text(bytes) + " of memory, but only " +
                         memory_text(room->bytes) + " can be had (" + room->limit + "); " + std::string(advice));
}

std::string memory_text(std::uint64_t bytes) {
  std::array<char, 32> text{};
  const double megabytes = static_cast<double>(bytes) * 1e-6;
  if (megabytes >= 999.5) {
    std::snprintf(text.data(), text.size(), "%.*f GB", megabytes < 9995 ? 2 : 1, megabytes * 1e-3);
  } else {
    std::snprintf(text.data(), text.size(), "%.*f MB", megabytes < 9.95 ? 1 : 0, megabytes);
  }
  return text.data();
}

}  // namespace atomesh
