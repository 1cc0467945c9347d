#include "render/cpu/cell_projection_kernel.h"

#include <array>
#include <atomic>
#include <string>

#include "core/error.h"

namespace atomesh::cell_projection {

namespace {

std::atomic<const Kernel*> chosen{nullptr};

std::array<const Kernel*, 3> available() {
#if defined(ATOMESH_X86_KERNELS)
  return {avx512_kernel(), avx2_kernel(), baseline_kernel()};
#else
  return {nullptr, nullptr, baseline_kernel()};
#endif
}

}  // namespace

const Kernel& kernel() {
  if (const Kernel* forced = chosen.load()) return *forced;
  for (const Kernel* candidate : available()) {
    if (candidate != nullptr) return *candidate;
  }
  return *baseline_kernel();
}

void set_kernel(std::string_view name) {
  if (name.empty()) {
    chosen.store(nullptr);
    return;
  }
  for (const Kernel* candidate : available()) {
    if (candidate != nullptr && candidate->name == name) {
      chosen.store(candidate);
      return;
    }
  }
  throw UnavailableError("cell projection kernel \"" + std::string(name) +
                         "\": not in this build, or not for this processor");
}

}  // namespace atomesh::cell_projection
