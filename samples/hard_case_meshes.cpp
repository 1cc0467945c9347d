#include "samples/hard_case_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <numbers>
#include <numeric>

#include "core/surface.h"
#include "samples/random.h"

namespace atomesh {

namespace {

void turn_outside_out(const std::vector<Vec3>& p, Tetrahedron& t) {
  if (signed_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) < 0.0) std::swap(t[2], t[3]);
}

// Atoms, values and surface of a mesh that has vertices and cells.
Material finished(TetMesh mesh) {
  Material material;
  const std::size_t count = mesh.vertices.size();
  mesh.vertex_atom.resize(count);
  std::iota(mesh.vertex_atom.begin(), mesh.vertex_atom.end(), Index{0});
  material.atoms.positions = mesh.vertices;
  material.atoms.species.assign(count, material.atoms.add_species("C"));
  for (std::size_t i = 0; i < count; ++i) {
    material.defects.positional.push_back(static_cast<float>(Random::uniform_of(5, i)));
  }
  material.defects.vacancy.assign(count, 0.0F);
  material.defects.extra.assign(count, 0.0F);
  material.surface = extract_surface(mesh);
  material.mesh = std::move(mesh);
  return material;
}

// Coordinates about the origin rounded to 21 bits of the largest: floats carry them exactly, and what is known of the
// matter is known of what is drawn.
void round_to_floats(TetMesh& mesh) {
  double largest = 0.0;
  for (const Vec3& p : mesh.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double unit = std::ldexp(1.0, std::ilogb(largest) - 20);
  for (Vec3& p : mesh.vertices) p = unit * glm::round(p / unit);
}

// Four vertices for each cell, shared with none.
void add_apart(TetMesh& mesh, const std::array<Vec3, 4>& corners, bool keep_orientation = false) {
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  Tetrahedron cell{first, first + 1, first + 2, first + 3};
  if (!keep_orientation) turn_outside_out(mesh.vertices, cell);
  mesh.tetrahedra.push_back(cell);
}

// Corners of a cube are numbered by the bits x = 1, y = 2, z = 4.
using CubeCell = std::array<int, 4>;
constexpr std::array<CubeCell, 5> five_even{{{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}}};
constexpr std::array<CubeCell, 6> six{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

std::vector<CubeCell> cells_of_cube(CubeSplit split, bool odd) {
  if (split == CubeSplit::six) return {six.begin(), six.end()};
  std::vector<CubeCell> cells(five_even.begin(), five_even.end());
  if (odd) {
    for (CubeCell& cell : cells) {
      for (int& corner : cell) corner ^= 1;  // the mirror image
    }
  }
  return cells;
}

// A bar from start to end along `along`, tilted in depth (y) so that its start is nearer than its end.
void add_bar(TetMesh& mesh, const Vec3& middle, const Vec3& along, const Vec3& across, double half_length,
             double width) {
  const Vec3 depth(0.0, 1.0, 0.0);
  const Vec3 start = middle - half_length * along - 0.5 * half_length * depth;
  const Vec3 end = middle + half_length * along + 0.5 * half_length * depth;
  const Vec3 turned = width * across + 0.4 * width * depth;
  add_apart(mesh, {start + width * across, start - width * across, end + turned, end - turned});
}

void add_ring(TetMesh& mesh, int count, const Vec3& center) {
  const double step = 2.0 * std::numbers::pi / count;
  for (int bar = 0; bar < count; ++bar) {
    const double angle = step * bar + 0.2;
    const Vec3 along(std::cos(angle), 0.0, std::sin(angle));
    const Vec3 across(-std::sin(angle), 0.0, std::cos(angle));
    // Long enough to cross both neighbours.
    add_bar(mesh, center + across, along, across, 1.7 * std::tan(0.5 * step), 0.3 * std::sin(0.5 * step));
  }
}

}  // namespace

GridPlanes even_planes(int n, double step) {
  std::vector<double> planes;
  for (int i = 0; i <= n; ++i) planes.push_back(step * i);
  return {planes, planes, planes};
}

Material grid_material(const GridPlanes& planes, CubeSplit split, const std::function<bool(int, int, int)>& hollow) {
  const auto& [xs, ys, zs] = planes;
  TetMesh mesh;
  for (const double z : zs) {
    for (const double y : ys) {
      for (const double x : xs) mesh.vertices.emplace_back(x, y, z);
    }
  }
  const int nx = static_cast<int>(xs.size());
  const int ny = static_cast<int>(ys.size());
  const int nz = static_cast<int>(zs.size());
  for (int k = 0; k + 1 < nz; ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        if (hollow && hollow(i, j, k)) continue;
        for (const CubeCell& cell : cells_of_cube(split, (i + j + k) % 2 != 0)) {
          Tetrahedron t{};
          for (std::size_t c = 0; c < 4; ++c) {
            const int corner = cell[c];
            t[c] = static_cast<Index>(((k + (corner >> 2)) * ny + j + (corner >> 1 & 1)) * nx + i + (corner & 1));
          }
          turn_outside_out(mesh.vertices, t);
          mesh.tetrahedra.push_back(t);
        }
      }
    }
  }
  return finished(std::move(mesh));
}

Material cubic_lattice_material(CubicLattice lattice, int n, double edge, const DelaunayMesher& delaunay,
                                double noise) {
  std::vector<Vec3> basis{Vec3(0.0)};  // in quarters of the edge
  if (lattice == CubicLattice::bcc) basis.emplace_back(2, 2, 2);
  if (lattice == CubicLattice::fcc || lattice == CubicLattice::diamond) {
    basis.insert(basis.end(), {Vec3(0, 2, 2), Vec3(2, 0, 2), Vec3(2, 2, 0)});
  }
  if (lattice == CubicLattice::diamond) {
    for (std::size_t i = 0; i < 4; ++i) basis.push_back(basis[i] + Vec3(1.0));
  }
  TetMesh mesh;
  const double top = 4.0 * n;
  std::uint64_t number = 0;
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        for (const Vec3& place : basis) {
          const Vec3 quarters = 4.0 * Vec3(i, j, k) + place;
          if (std::max({quarters.x, quarters.y, quarters.z}) > top) continue;
          Vec3 p = 0.25 * edge * quarters;
          const bool inside = std::min({quarters.x, quarters.y, quarters.z}) > 0.0 &&
                              std::max({quarters.x, quarters.y, quarters.z}) < top;
          for (int axis = 0; inside && axis < 3; ++axis) {
            p[axis] += noise * (2.0 * Random::uniform_of(6, 3 * number + static_cast<std::uint64_t>(axis)) - 1.0);
          }
          ++number;
          mesh.vertices.push_back(p);
        }
      }
    }
  }
  mesh.tetrahedra = delaunay(mesh.vertices);
  mesh.delaunay = true;
  return finished(std::move(mesh));
}

Material one_cell_material(double radius) {
  TetMesh mesh;
  const double s = radius / std::sqrt(3.0);
  add_apart(mesh, {Vec3(s, s, s), Vec3(-s, -s, s), Vec3(-s, s, -s), Vec3(s, -s, -s)});
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Material fan_material(int count, double radius, double top) {
  TetMesh mesh;
  mesh.vertices = {Vec3(0, 0, -top), Vec3(0, 0, top)};
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  round_to_floats(mesh);
  for (int i = 0; i < count; ++i) {
    Tetrahedron t{0, 1, static_cast<Index>(2 + i), static_cast<Index>(2 + (i + 1) % count)};
    turn_outside_out(mesh.vertices, t);
    mesh.tetrahedra.push_back(t);
  }
  return finished(std::move(mesh));
}

Material ball_material(int subdivisions, double radius) {
  TetMesh mesh;
  mesh.vertices = {Vec3(0.0)};
  std::map<std::array<int, 3>, Index> known;
  const int n = subdivisions;
  const auto vertex = [&](const std::array<int, 3>& p) {  // |x|+|y|+|z| = n
    const auto [place, fresh] = known.try_emplace(p, static_cast<Index>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(radius * glm::normalize(Vec3(p[0], p[1], p[2])));
    return place->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const auto corner = [&](int i, int j) {
      const int k = n - i - j;
      return vertex({(octant & 1) != 0 ? -i : i, (octant & 2) != 0 ? -j : j, (octant & 4) != 0 ? -k : k});
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        Tetrahedron t{0, corner(i, j), corner(i + 1, j), corner(i, j + 1)};
        turn_outside_out(mesh.vertices, t);
        mesh.tetrahedra.push_back(t);
        if (i + j + 1 >= n) continue;
        t = {0, corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
        turn_outside_out(mesh.vertices, t);
        mesh.tetrahedra.push_back(t);
      }
    }
  }
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Material ring_material(int count) {
  TetMesh mesh;
  add_ring(mesh, count, Vec3(0.0));
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Material field_of_rings_material(int side) {
  TetMesh mesh;
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) add_ring(mesh, 4, 4.5 * Vec3(i, 0.0, k));
  }
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Material soup_material(int count) {
  TetMesh mesh;
  Random random(11);
  for (int i = 0; i < count; ++i) {
    std::array<Vec3, 4> corners;
    for (Vec3& p : corners) {
      const double x = random.uniform();
      const double y = random.uniform();
      p = 4.0 * Vec3(x, y, random.uniform()) - 2.0;
    }
    add_apart(mesh, corners);
  }
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Material tangled_material(int n, double amount, bool inverted) {
  const Material straight = grid_material(even_planes(n, 1.0), CubeSplit::six);
  std::vector<Vec3> moved = straight.mesh.vertices;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    Vec3& p = moved[v];
    const bool inside = std::min({p.x, p.y, p.z}) > 0.0 && std::max({p.x, p.y, p.z}) < n;
    for (std::size_t axis = 0; inside && axis < 3; ++axis) {
      p[static_cast<int>(axis)] += amount * (2.0 * Random::uniform_of(7, 3 * v + axis) - 1.0);
    }
  }
  TetMesh mesh;
  for (const Tetrahedron& t : straight.mesh.tetrahedra) {
    add_apart(mesh, {moved[t[0]], moved[t[1]], moved[t[2]], moved[t[3]]}, inverted);
  }
  round_to_floats(mesh);
  return finished(std::move(mesh));
}

Solid solid_of_cells(const TetMesh& mesh) {
  Solid solid;
  const auto& p = mesh.vertices;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    solid.bodies.push_back(tetrahedron_body(p[t[0]], p[t[1]], p[t[2]], p[t[3]]));
  }
  return solid;
}

}  // namespace atomesh
