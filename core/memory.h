// How much memory this process holds and how much more it may take, so that work that would not fit can say so before
// it starts. Linux; elsewhere everything is unknown and nothing is refused. Bytes; shown to people in units of 10⁶.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace atomesh {

// What the process holds now (resident set); 0 where that is unknown.
std::uint64_t current_memory();

// The most it has held since it started.
std::uint64_t peak_memory();

// The most it has held since the last reset_peak_memory(), or since it started. Where the kernel cannot be asked to
// forget its high-water mark, only what is held at the moments of asking is seen.
std::uint64_t recent_peak_memory();
void reset_peak_memory();

// Gives memory that was freed, but is kept for later by the allocator, back to the system.
void release_free_memory();

struct MemoryRoom {
  std::uint64_t bytes = 0;  // that the process can still take
  std::string limit;        // what sets the bound: "the machine's free memory", "the control group", "ulimit -v", …
};

// The smallest of: the machine's available memory, what the control groups (v1, v2) leave, RLIMIT_AS, RLIMIT_DATA and
// the limit set below. Nothing where none of them is known.
std::optional<MemoryRoom> memory_room();

// Bounds this process from now on to `bytes` of memory in all (--memory-limit): memory_room() counts with it, and
// allocations beyond it fail with std::bad_alloc. 0 takes a bound off that was only counted with. Throws UsageError
// for less than the process holds already.
void limit_memory(std::uint64_t bytes);

// Throws UnavailableError when less than `bytes` is left: says what needs it ("tetrahedralize of 10,000,000 atoms"),
// how much that is, how much there is and what sets the bound, and `advice`.
void require_memory(std::string_view what, std::uint64_t bytes, std::string_view advice);

// "10.2 GB", "340 MB".
std::string memory_text(std::uint64_t bytes);

// For tests: what the control groups named in `membership` (the content of /proc/self/cgroup) leave, by the files
// mounted at `root` (/sys/fs/cgroup).
std::optional<MemoryRoom> control_group_room(std::string_view membership, const std::string& root);

}  // namespace atomesh
