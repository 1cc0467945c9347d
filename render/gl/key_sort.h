// Sorting by 32-bit keys on all threads.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh::gl {

struct KeyedCell {
  std::uint32_t key;
  Index cell;
};

// Puts `cells` in ascending order of their keys, equal keys as they stood (a radix sort from the lowest digit);
// `scratch` is resized and left with anything. The result does not depend on the number of threads. Throws
// CancelledError, with the cells as they stood or partly sorted.
void sort_by_key(std::vector<KeyedCell>& cells, std::vector<KeyedCell>& scratch,
                 const Progress& progress = no_progress());

}  // namespace atomesh::gl
