#include "preprocess/memory_needs.h"

#include <algorithm>
#include <bit>

#include "core/memory.h"

namespace atomesh {

namespace {

// Of a Delaunay tetrahedralization: 6 to 6.1 in crystals, 6.77 for points at random (Meijering 1953).
constexpr double tetrahedra_per_point = 6.8;
// Stacks of threads, buffers of a fixed size, what the allocator rounds up.
constexpr std::uint64_t allowance = 32'000'000;

std::uint64_t scaled(double bytes_each, std::uint64_t count) {
  return allowance + static_cast<std::uint64_t>(bytes_each * static_cast<double>(count));
}

std::string grouped(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace

std::uint64_t memory_to_read(std::uint64_t atoms, std::uint64_t columns, bool sorted) {
  const double atom = 24.0 + 2.0 + 8.0 * static_cast<double>(columns);
  const std::uint64_t slots = 8 * std::bit_ceil(2 * atoms + 1);
  const std::uint64_t copy = sorted ? static_cast<std::uint64_t>(atom * static_cast<double>(atoms)) : 0;
  return scaled(atom, atoms) + std::max(slots, copy);
}

std::uint64_t memory_to_mesh(std::string_view mesher, std::uint64_t points) {
  // Measured: CGAL 108 to 113, TetGen 145.
  const double bytes_per_tetrahedron = mesher == "tetgen" ? 165.0 : 125.0;
  return scaled(bytes_per_tetrahedron * tetrahedra_per_point, points);
}

std::uint64_t memory_to_carve(std::uint64_t vertices, std::uint64_t tetrahedra) {
  return scaled(8.0, tetrahedra) + 17 * vertices;  // circumradii; two lengths and a flag
}

std::uint64_t memory_to_extract_surface(std::uint64_t vertices, std::uint64_t tetrahedra) {
  return scaled(9.0, tetrahedra) + 8 * vertices;  // SharedFaces and a byte of marks
}

std::uint64_t memory_to_simplify(std::uint64_t vertices, std::uint64_t tetrahedra) {
  return scaled(34.0, tetrahedra) + 110 * vertices;  // the faces behind each other; the queue of the vertices
}

std::uint64_t memory_to_quantify_defects(std::uint64_t atoms) {
  return scaled(200.0, atoms);  // measured: 124 in rock salt, 150 in strained copper
}

void require_memory_for(std::string_view stage, std::uint64_t count, std::string_view noun, std::uint64_t bytes) {
  // Asking the system takes longer than the small pieces of work that may come by the thousand.
  if (bytes <= 2 * allowance) return;
  require_memory(std::string(stage) + " of " + grouped(count) + " " + std::string(noun), bytes, memory_advice());
}

std::string memory_advice() {
  return "leave atoms out (--mask, --keep-every), stamp a crystal instead of triangulating it (--mesher pattern), or "
         "use "
         "a machine with more memory";
}

}  // namespace atomesh
