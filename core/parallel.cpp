#include "core/parallel.h"

namespace atomesh {

namespace {
std::atomic<int> requested_threads{0};
}

void set_threads(int threads) {
  requested_threads.store(std::max(threads, 0));
}

int threads() {
  const int requested = requested_threads.load();
  return requested > 0 ? requested : omp_get_max_threads();
}

}  // namespace atomesh
