// Parallel loops over OpenMP that carry exceptions (and cancellation) out of the parallel region. What a loop
// computes must not depend on the number of threads: bodies write only to their own range.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

namespace atomesh {

// Number of threads parallel loops use. 0 restores the default (all the machine offers).
void set_threads(int threads);
int threads();

// Calls body(begin, end) for consecutive ranges of at most `grain` items that cover [0, count), in any order, on
// threads() threads. The first exception thrown by a body stops the handing out of ranges and is rethrown.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (count + grain - 1) / grain;
  if (ranges == 1 || threads() == 1) {
    for (std::size_t r = 0; r < ranges; ++r) body(r * grain, std::min(count, (r + 1) * grain));
    return;
  }
  std::exception_ptr failure;
  std::atomic<bool> failed{false};
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads())
  for (std::size_t r = 0; r < ranges; ++r) {
    if (failed.load(std::memory_order_relaxed)) continue;
    try {
      body(r * grain, std::min(count, (r + 1) * grain));
    } catch (...) {
#pragma omp critical(atomesh_parallel_for)
      if (!failure) failure = std::current_exception();
      failed.store(true, std::memory_order_relaxed);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace atomesh
