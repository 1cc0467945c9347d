#include "samples/hard_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "samples/hard_case_meshes.h"

namespace atomesh {

namespace {

// The stretch of the ray's parameter inside the body, from 0 on; empty where first >= second.
std::pair<double, double> inside(const ConvexBody& body, const Ray& ray) {
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  for (const HalfSpace& side : body) {
    const double beyond = glm::dot(side.normal, ray.origin) - side.offset;
    const double rate = glm::dot(side.normal, ray.direction);
    if (rate < 0.0) {
      from = std::max(from, -beyond / rate);
    } else if (rate > 0.0) {
      to = std::min(to, -beyond / rate);
    } else if (beyond > 0.0) {
      return {0.0, 0.0};
    }
  }
  return {from, to};
}

double length_inside(const ConvexBody& body, const Ray& ray) {
  const auto [from, to] = inside(body, ray);
  return std::max(0.0, to - from);
}

HalfSpace outside_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return {normal, glm::dot(normal, (a + b + c) / 3.0)};
}

// Looks at `target` along `forward` from `distance` before it; `up` is made perpendicular.
Camera camera_at(Projection projection, const Vec3& target, const Vec3& forward, const Vec3& up, double distance,
                 double pixel, int size) {
  Camera camera;
  camera.projection = projection;
  camera.forward = glm::normalize(forward);
  camera.right = glm::normalize(glm::cross(camera.forward, up));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.eye = target - distance * camera.forward;
  camera.width = camera.height = size;
  camera.pixel = pixel;
  return camera;
}

struct Block {
  Vec3 center;
  double size;  // largest diameter
};
Block block_of(const Material& material) {
  const Bounds bounds = bounds_of(material.mesh.vertices);
  return {bounds.center(), bounds.diagonal()};
}

const Vec3 z_up(0.0, 0.0, 1.0);
const Vec3 oblique(0.43, 0.79, -0.37);  // along no lattice direction

constexpr int picture_side = 33;

// Oblique views of the whole sample: no ray meets a vertex.
std::vector<HardView> generic_views(const Material& material, int size = picture_side) {
  const auto [center, diameter] = block_of(material);
  return {{"oblique, parallel",
           camera_at(Projection::parallel, center, oblique, z_up, 2.0 * diameter, diameter / size, size)},
          {"oblique, perspective",
           camera_at(Projection::perspective, center, oblique, z_up, 2.0 * diameter, 0.55 / size, size)}};
}

// From this eye, in perspective, with a wide angle.
HardView eye_view(const std::string& name, const Vec3& eye, const Vec3& forward, double angle = 1.2,
                  int size = picture_side) {
  return {name, camera_at(Projection::perspective, eye, forward, z_up, 0.0, angle / size, size)};
}

HardCase make_case(std::string group, std::string name, Material material, Solid solid, std::vector<HardView> views) {
  const double size = bounds_of(material.mesh.vertices).diagonal();
  return {std::move(name), std::move(group), std::move(material), std::move(solid), std::move(views), {1.0 / size}};
}

Solid box_solid(const Material& material) {
  const Bounds bounds = bounds_of(material.mesh.vertices);
  return {{box_body(bounds.min, bounds.max)}, {}};
}

// Rays through vertices, along edges and in faces: the pixel grid is the lattice's own projection, eight pixels an edge
// or a rational part of it.
std::vector<HardView> aligned_views(const Material& material, double edge) {
  const Vec3 center = block_of(material).center;
  const double far = 12.0 * edge;
  const double step = edge / 8.0;
  const int size = picture_side + 2;
  const auto parallel = [&](const char* name, const Vec3& forward, const Vec3& up, double pixel) {
    return HardView{name, camera_at(Projection::parallel, center, forward, up, far, pixel, size)};
  };
  const auto perspective = [&](const char* name, const Vec3& forward, const Vec3& up, double pixel) {
    return HardView{name, camera_at(Projection::perspective, center, forward, up, far, pixel / far, size)};
  };
  const Vec3 up_111(-1, -1, 2);
  return {parallel("[100], parallel", {1, 0, 0}, z_up, step),
          parallel("[0-10], parallel", {0, -1, 0}, z_up, step),
          parallel("[110], parallel, rows on planes", {1, 1, 0}, z_up, step),
          parallel("[110], parallel, columns on planes", {1, 1, 0}, z_up, step * std::sqrt(0.5)),
          parallel("[111], parallel", {1, 1, 1}, up_111, step * std::sqrt(2.0 / 3.0)),
          perspective("[100], perspective", {1, 0, 0}, z_up, step),
          perspective("[110], perspective", {1, 1, 0}, z_up, step),
          perspective("[111], perspective", {1, 1, 1}, up_111, step)};
}

void add_lattices(std::vector<HardCase>& cases, const DelaunayMesher& delaunay) {
  const std::string group = "rays through vertices, along edges and in faces of a perfect lattice";
  const double edge = 2.0;
  const auto add = [&](const char* name, Material material) {
    Solid solid = box_solid(material);
    std::vector<HardView> views = aligned_views(material, edge);
    cases.push_back(make_case(group, name, std::move(material), std::move(solid), std::move(views)));
  };
  add("cubes of five", grid_material(even_planes(4, edge), CubeSplit::five));
  add("cubes of six", grid_material(even_planes(4, edge), CubeSplit::six));
  add("simple cubic, Delaunay", cubic_lattice_material(CubicLattice::simple, 4, edge, delaunay));
  add("bcc, Delaunay", cubic_lattice_material(CubicLattice::bcc, 3, edge, delaunay));
  add("fcc, Delaunay", cubic_lattice_material(CubicLattice::fcc, 3, edge, delaunay));
  add("diamond, Delaunay", cubic_lattice_material(CubicLattice::diamond, 2, edge, delaunay));
}

void add_slivers(std::vector<HardCase>& cases, const DelaunayMesher& delaunay) {
  const std::string group = "slivers";
  for (const auto& [name, height] : {std::pair{"a layer 1e-9 Å high", 1e-9}, std::pair{"a layer 1e-6 Å high", 1e-6},
                                     std::pair{"a layer 1e-4 Å high", 1e-4}}) {
    GridPlanes planes = even_planes(4, 1.0);
    planes.z = {0.0, 1.0, 1.0 + height, 2.0, 3.0};
    Material material = grid_material(planes, CubeSplit::six);
    const Vec3 center = block_of(material).center;
    std::vector<HardView> views = generic_views(material);
    views.push_back({"on the layer", camera_at(Projection::parallel, center, {0, 0, -1}, {0, 1, 0}, 9.0, 0.125, 35)});
    views.push_back(
        {"along the layer, in it", camera_at(Projection::parallel, {2, 2, 1}, {0, 1, 0}, z_up, 9.0, 0.125, 35)});
    views.push_back(
        {"nearly along the layer", camera_at(Projection::parallel, {2, 2, 1}, {0, 1, -1e-4}, z_up, 9.0, 0.131, 33)});
    views.push_back({"in the layer's plane, perspective",
                     camera_at(Projection::perspective, {2, 2, 1}, {0, 1, 0}, z_up, 9.0, 0.015, 33)});
    if (height > 1e-7) {  // the thinner one is no place at all in floats
      for (std::size_t v = 3; v < views.size(); ++v) views[v].values_unresolved = true;
    }
    Solid solid = box_solid(material);
    cases.push_back(make_case(group, name, std::move(material), std::move(solid), std::move(views)));
  }
  // Between cospherical points that noise moves by next to nothing Delaunay's cells are as flat as they can be.
  for (const auto& [name, lattice, n] :
       {std::tuple{"simple cubic with 1e-9 Å of noise, Delaunay", CubicLattice::simple, 4},
        std::tuple{"fcc with 1e-9 Å of noise, Delaunay", CubicLattice::fcc, 3}}) {
    Material material = cubic_lattice_material(lattice, n, 2.0, delaunay, 1e-9);
    std::vector<HardView> views = generic_views(material);
    const std::vector<HardView> aligned = aligned_views(material, 2.0);
    views.insert(views.end(), {aligned[0], aligned[2], aligned[5]});
    Solid solid = box_solid(material);
    cases.push_back(make_case(group, name, std::move(material), std::move(solid), std::move(views)));
  }
}

void add_offsets(std::vector<HardCase>& cases, const DelaunayMesher& delaunay) {
  const auto add = [&](const char* name, Material material) {
    const Vec3 offset(1e6, -1e6, 1e6);
    for (Vec3& p : material.mesh.vertices) p += offset;
    material.atoms.positions = material.mesh.vertices;
    std::vector<HardView> views = generic_views(material);
    const std::vector<HardView> aligned = aligned_views(material, 2.0);
    views.insert(views.end(), {aligned[0], aligned[4], aligned[5]});
    views.push_back(eye_view("eye inside", block_of(material).center + Vec3(0.3, 0.2, -0.1), oblique));
    Solid solid = box_solid(material);
    cases.push_back(make_case("coordinates a million Å from the origin", name, std::move(material), std::move(solid),
                              std::move(views)));
  };
  add("cubes of six, far away", grid_material(even_planes(4, 2.0), CubeSplit::six));
  add("simple cubic with 0.3 Å of noise, far away",
      cubic_lattice_material(CubicLattice::simple, 4, 2.0, delaunay, 0.3));
}

void add_extinctions(std::vector<HardCase>& cases, const DelaunayMesher& delaunay) {
  const std::string group = "extinction from 1e-6 to 1e6 1/Å";
  const std::vector<double> extinctions{1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6};
  Material lattice = cubic_lattice_material(CubicLattice::simple, 5, 1.0, delaunay, 0.2);
  std::vector<HardView> views = generic_views(lattice);
  views.push_back(eye_view("eye inside", {2.3, 2.6, 2.2}, oblique));
  Solid solid = box_solid(lattice);
  cases.push_back(make_case(group, "a shaken lattice of 1 Å", std::move(lattice), std::move(solid), std::move(views)));
  cases.back().extinctions = extinctions;
  Material cell = one_cell_material(2.0);
  views = generic_views(cell);
  solid = solid_of_cells(cell.mesh);
  cases.push_back(make_case(group, "one cell of 3 Å", std::move(cell), std::move(solid), std::move(views)));
  cases.back().extinctions = extinctions;
}

void add_sizes(std::vector<HardCase>& cases) {
  Material cell = one_cell_material(1000.0);
  std::vector<HardView> views{
      eye_view("the eye before a face", {400.0, -700.0, 420.0}, {-0.45, 0.8, -0.4}, 0.8),
      eye_view("the eye 1e-3 Å before a corner", Vec3(-577.35, -577.35, 577.35) * (1.0 + 1e-6), {1, 1.1, -0.9}),
      eye_view("the eye inside", {30.0, -20.0, 50.0}, oblique, 1.6),
      eye_view("the eye 1e-3 Å inside a face", {192.4494, 192.4494, -192.4494}, oblique, 1.6)};
  const auto [center, diameter] = block_of(cell);
  views.push_back({"a thousandth of it, parallel",
                   camera_at(Projection::parallel, center, oblique, z_up, 2.0 * diameter, 0.05, picture_side)});
  views.push_back({"a millionth of it, parallel",
                   camera_at(Projection::parallel, center, oblique, z_up, 2.0 * diameter, 5e-5, picture_side)});
  Solid solid = solid_of_cells(cell.mesh);
  cases.push_back(make_case("one cell fills the view", "a tetrahedron of 1600 Å", std::move(cell), std::move(solid),
                            std::move(views)));

  const std::string group = "cells smaller than a pixel";
  Material fine = grid_material(even_planes(26, 0.1), CubeSplit::six);
  const auto [middle, size] = block_of(fine);
  views = {
      {"105,456 cells in one pixel, parallel",
       camera_at(Projection::parallel, middle + Vec3(0.013, 0.007, 0.011), oblique, z_up, 3.0 * size, 2.0 * size, 5)},
      {"105,456 cells in one pixel, along [100]",
       camera_at(Projection::parallel, middle, {1, 0, 0}, z_up, 3.0 * size, 2.0 * size, 5)},
      {"105,456 cells in one pixel, perspective",
       camera_at(Projection::perspective, middle + Vec3(0.013, 0.007, 0.011), oblique, z_up, 30.0 * size, 0.1, 5)},
      {"a fifth of a pixel, parallel", camera_at(Projection::parallel, middle, oblique, z_up, 3.0 * size, 0.5, 12)}};
  solid = box_solid(fine);
  cases.push_back(make_case(group, "26³ cubes of six", std::move(fine), std::move(solid), std::move(views)));
}

void add_holes(std::vector<HardCase>& cases) {
  const auto hollow = [](int i, int j, int k) { return i % 2 == 1 && j % 2 == 1 && k % 2 == 1; };
  Material material = grid_material(even_planes(5, 1.0), CubeSplit::five, hollow);
  Solid solid = box_solid(material);
  for (int hole = 0; hole < 8; ++hole) {
    const Vec3 low(1 + 2 * (hole & 1), 1 + (hole & 2), 1 + (hole & 4) / 2);
    solid.holes.push_back(box_body(low, low + 1.0));
  }
  std::vector<HardView> views = generic_views(material);
  const std::vector<HardView> aligned = aligned_views(material, 1.0);
  views.insert(views.end(), aligned.begin(), aligned.end());
  views.push_back(eye_view("the eye in a hole", {1.4, 1.6, 1.3}, oblique));
  views.push_back(eye_view("the eye on a hole's corner", {2, 2, 2}, oblique));
  cases.push_back(
      make_case("holes", "5³ cubes, eight of them missing", std::move(material), std::move(solid), std::move(views)));
}

void add_eyes(std::vector<HardCase>& cases) {
  const std::string group = "the eye on a vertex, on an edge, in a face";
  Material material = grid_material(even_planes(4, 1.0), CubeSplit::six);
  const Vec3 down_axis(0, 1, 0);
  std::vector<HardView> views{eye_view("on a vertex", {2, 2, 2}, oblique),
                              eye_view("on a vertex, along an axis", {2, 2, 2}, down_axis),
                              eye_view("on an edge", {2, 1.5, 2}, oblique),
                              eye_view("on an edge, along it", {2, 1.5, 2}, down_axis),
                              eye_view("in a face", {1.25, 1.75, 2}, oblique),
                              eye_view("in a face, in its plane", {1.25, 1.75, 2}, down_axis),
                              eye_view("inside a cell", {1.3, 2.2, 1.7}, oblique),
                              eye_view("on the hull's corner", {0, 0, 4}, oblique),
                              eye_view("on the hull's edge", {0, 0, 1.5}, {1, 0.8, 0.1}),
                              eye_view("in the hull's face", {1.25, 0, 1.5}, oblique),
                              eye_view("in the hull's face, looking out", {1.25, 0, 1.5}, -oblique)};
  HardView parallel{"in the plane of vertices, parallel",
                    camera_at(Projection::parallel, {2, 2, 2}, down_axis, z_up, 0.0, 0.125, 35)};
  views.push_back(parallel);
  Solid solid = box_solid(material);
  cases.push_back(make_case(group, "4³ cubes of six", std::move(material), std::move(solid), std::move(views)));

  Material ball = ball_material(6, 5.0);
  views = generic_views(ball);
  views.push_back({"through the vertex of all cells",
                   camera_at(Projection::parallel, Vec3(0.0), {0, 1, 0}, z_up, 20.0, 5.0 / 16.0, 35)});
  views.push_back(eye_view("on the vertex of all cells", Vec3(0.0), oblique));
  solid = {{convex_hull_body(ball.surface.triangles, ball.mesh.vertices)}, {}};
  cases.push_back(
      make_case(group, "a ball of 288 cells about one vertex", std::move(ball), std::move(solid), std::move(views)));

  Material fan = fan_material(64, 5.0, 4.0);
  views = generic_views(fan);
  views.push_back({"along the edge of all cells",
                   camera_at(Projection::parallel, Vec3(0.0), {0, 0, -1}, {0, 1, 0}, 20.0, 5.0 / 16.0, 35)});
  views.push_back({"on the edge of all cells, along it",
                   camera_at(Projection::perspective, Vec3(0.0), {0, 0, -1}, {0, 1, 0}, 0.0, 0.04, 35)});
  views.push_back(eye_view("on the edge of all cells", {0, 0, 0.7}, oblique));
  solid = {{convex_hull_body(fan.surface.triangles, fan.mesh.vertices)}, {}};
  cases.push_back(make_case(group, "64 cells about one edge", std::move(fan), std::move(solid), std::move(views)));
}

// A cell that reaches past the eye, whose centroid is beside it: in the picture's plane it is seen infinitely far away.
void add_level_eye(std::vector<HardCase>& cases) {
  Material material = one_cell_material(1.0);
  const Vec3 corner(-10.0);
  material.mesh.vertices = {corner, corner + Vec3(40, 0, 0), corner + Vec3(0, 40, 0), corner + Vec3(0, 0, 40)};
  material.atoms.positions = material.mesh.vertices;
  std::vector<HardView> views;
  for (const auto& [name, before] : {std::pair{"0.1 Å before it", 0.1}, std::pair{"0.001 Å before it", 1e-3},
                                     std::pair{"level", 0.0}, std::pair{"0.001 Å behind it", -1e-3}}) {
    for (const auto& [width, pixel] :
         {std::pair{"narrow", 1.0 / 1024.0}, std::pair{"wide", 0.01}, std::pair{"very wide", 0.05}}) {
      views.push_back({std::string(name) + ", " + width,
                       camera_at(Projection::perspective, {-5.0, 1.0, -before}, z_up, {0, 1, 0}, 0.0, pixel, 64)});
    }
  }
  Solid solid = solid_of_cells(material.mesh);
  cases.push_back(make_case("the eye on a vertex, on an edge, in a face", "eye level with the centroid of its cell",
                            std::move(material), std::move(solid), std::move(views)));
}

void add_disorder(std::vector<HardCase>& cases) {
  const auto add = [&](const char* group, const char* name, Material material, bool from_the_front) {
    std::vector<HardView> views = generic_views(material);
    if (from_the_front) {
      const auto [center, size] = block_of(material);
      for (const int side : {4, 9, 64}) {
        views.push_back(
            {"in front, " + std::to_string(side) + " pixels wide",
             camera_at(Projection::parallel, center, {0, 1, 0}, z_up, 2.0 * size, 0.8 * size / side, side)});
      }
      views.push_back({"in front, perspective",
                       camera_at(Projection::perspective, center, {0, 1, 0}, z_up, 2.0 * size, 0.5 / 33, 33)});
    }
    Solid solid = solid_of_cells(material.mesh);
    cases.push_back(make_case(group, name, std::move(material), std::move(solid), std::move(views)));
  };
  const char* cyclic = "rings of visibility";
  add(cyclic, "a ring of three", ring_material(3), true);
  add(cyclic, "a ring of five", ring_material(5), true);
  add(cyclic, "a ring of twelve", ring_material(12), true);
  add(cyclic, "25 rings of four", field_of_rings_material(5), true);
  const char* overlapping = "cells that overlap";
  add(overlapping, "200 cells at random", soup_material(200), false);
  add(overlapping, "4³ cubes whose vertices went astray by up to 0.6", tangled_material(4, 0.6, false), false);
  cases.back().known = HardCase::Known::lengths;
  add(overlapping, "4³ cubes whose vertices went astray by up to 1.5", tangled_material(4, 1.5, false), false);
  cases.back().known = HardCase::Known::lengths;
  add(overlapping, "the same, cells left inside out", tangled_material(4, 1.5, true), false);
  cases.back().known = HardCase::Known::nothing;
}

void add_behind(std::vector<HardCase>& cases) {
  Material material = grid_material(even_planes(4, 1.0), CubeSplit::six);
  std::vector<HardView> views{eye_view("all of it behind", {2, 9, 2}, {0, 1, 0}),
                              eye_view("half of it behind", {5, 2, 2}, {0, 1, 0}),
                              eye_view("beside and behind", {4, 2, 2}, {1, 1e-3, 0}),
                              {"all of it behind, parallel",
                               camera_at(Projection::parallel, {2, 2, 2}, {0, 1, 0}, z_up, -9.0, 0.15, picture_side)},
                              {"half of it behind, parallel", camera_at(Projection::parallel, {2.01, 2.3, 2.02},
                                                                        oblique, z_up, 0.0, 0.2, picture_side)}};
  Solid solid = box_solid(material);
  cases.push_back(
      make_case("cells behind the eye", "4³ cubes of six", std::move(material), std::move(solid), std::move(views)));
}

void add_needles(std::vector<HardCase>& cases) {
  const std::string group = "needles and plates";
  const auto add = [&](const char* name, const GridPlanes& planes) {
    Material material = grid_material(planes, CubeSplit::six);
    std::vector<HardView> views = generic_views(material);
    const Vec3 middle(0.3 + 0.5e-6, 0.3 + 0.5e-6, 0.5);
    for (const auto& [view, forward, up] : {std::tuple{"along z, in the gap", Vec3(0, 0, -1), Vec3(0, 1, 0)},
                                            std::tuple{"along y, in the gap", Vec3(0, 1, 0), z_up}}) {
      views.push_back({view, camera_at(Projection::parallel, middle, forward, up, 5.0, 0.05, 33), true});
      views.push_back(
          {std::string(view) + ", close", camera_at(Projection::parallel, middle, forward, up, 5.0, 1.3e-7, 33)});
    }
    Solid solid = box_solid(material);
    cases.push_back(make_case(group, name, std::move(material), std::move(solid), std::move(views)));
  };
  const std::vector<double> narrow{0.0, 0.3, 0.3 + 1e-6, 0.7, 1.0};
  add("a grid with gaps of 1e-6 along x and y: needles", {narrow, narrow, {0.0, 1.0}});
  add("a grid with gaps of 1e-6 along x: plates", {narrow, {0.0, 1.0}, {0.0, 1.0}});
}

}  // namespace

double Solid::chord(const Ray& ray) const {
  double length = 0.0;
  for (const ConvexBody& body : bodies) length += length_inside(body, ray);
  for (const ConvexBody& hole : holes) length -= length_inside(hole, ray);
  return length * glm::length(ray.direction);
}

double Solid::first_crossing(const Ray& ray) const {
  double nearest = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const ConvexBody& body) {
    const auto [from, to] = inside(body, ray);
    if (from < to) nearest = std::min(nearest, from > 0.0 ? from : to);
  };
  for (const ConvexBody& body : bodies) look_at(body);
  for (const ConvexBody& hole : holes) look_at(hole);
  return nearest;
}

ConvexBody box_body(const Vec3& low, const Vec3& high) {
  return {{{-1, 0, 0}, -low.x}, {{0, -1, 0}, -low.y}, {{0, 0, -1}, -low.z},
          {{1, 0, 0}, high.x},  {{0, 1, 0}, high.y},  {{0, 0, 1}, high.z}};
}

ConvexBody tetrahedron_body(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (signed_volume(a, b, c, d) < 0.0) return tetrahedron_body(a, b, d, c);
  return {outside_of(b, c, d), outside_of(a, d, c), outside_of(a, b, d), outside_of(a, c, b)};
}

ConvexBody convex_hull_body(std::span<const Triangle> outward, std::span<const Vec3> vertices) {
  ConvexBody body;
  for (const Triangle& t : outward) body.push_back(outside_of(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
  return body;
}

std::vector<HardCase> hard_cases(const DelaunayMesher& delaunay) {
  std::vector<HardCase> cases;
  add_lattices(cases, delaunay);
  add_slivers(cases, delaunay);
  add_offsets(cases, delaunay);
  add_extinctions(cases, delaunay);
  add_sizes(cases);
  add_holes(cases);
  add_eyes(cases);
  add_level_eye(cases);
  add_disorder(cases);
  add_behind(cases);
  add_needles(cases);
  return cases;
}

}  // namespace atomesh
