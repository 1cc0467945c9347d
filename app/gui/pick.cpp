#include "app/gui/pick.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/gui/sight_line.h"
#include "core/parallel.h"
#include "render/cpu/reference_optics.h"
#include "render/scene_parts.h"
#include "render/shared/ball_ray.h"

namespace atomesh::gui {

namespace {

// Less opacity than this changes no channel of 256 steps.
constexpr double invisible = 0.5 / 255.0;

// A layer of the ray: a ball, or a cell with the faces before it.
struct Layer {
  double before = 0.0;   // opacity of the faces that lie before it alone
  double opacity = 0.0;  // its own
};

// The first that makes at least `enough` of the pixel by itself, dimmed by what is before it; else the one at which the
// ray has come to half of its opacity; no_index where nobody sees it.
std::size_t seen_layer(const std::vector<Layer>& layers, double enough) {
  double through = 1.0;
  std::vector<double> left;  // of the light, behind each layer
  for (std::size_t i = 0; i < layers.size(); ++i) {
    through *= 1.0 - layers[i].before;
    if (through * layers[i].opacity >= enough) return i;
    through *= 1.0 - layers[i].opacity;
    left.push_back(through);
  }
  const double whole = 1.0 - through;
  if (whole < invisible) return no_index;
  const auto half = std::find_if(left.begin(), left.end(), [whole](double t) { return 1.0 - t >= 0.5 * whole; });
  return static_cast<std::size_t>(half - left.begin());
}

// Adds what is known of the corner nearest to `point`, or where no corner is an atom, of the point.
template <class Corners, class Weights>
void look_up(Pick& found, const Material& material, const Parameters& parameters, const Corners& corners,
             const Weights& weights, Progress& progress) {
  const TetMesh& mesh = material.mesh;
  Index nearest = no_index;
  double least = std::numeric_limits<double>::infinity();
  for (const Index v : corners) {
    const double distance = glm::length(mesh.vertices[v] - found.position);
    const bool is_atom =
        v < mesh.vertex_atom.size() && mesh.vertex_atom[v] != no_index && mesh.vertex_atom[v] < material.atoms.size();
    if (!is_atom || distance >= least) continue;
    least = distance;
    nearest = mesh.vertex_atom[v];
  }
  if (const VertexField* field = material.fields.empty() ? nullptr : shown_field(material, parameters.volume)) {
    double value = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      value += weights[i] * static_cast<double>(field->values[corners[i]]);
    }
    found.field = value;
  }
  if (nearest == no_index) return;
  Pick atom = pick_atom(material, nearest, progress);
  found.position = atom.position;
  found.atom = atom.atom;
  found.defects = atom.defects;
  found.neighbours = std::move(atom.neighbours);
}

std::optional<Pick> pick_ball(const Material& material, const Scene& scene, const Camera& camera, int column, int row,
                              double opacity, Progress& progress) {
  const optics::BallRay line = optics::ball_ray(scene, camera, column, row);
  struct Hit {
    double length;
    std::size_t ball;
  };
  std::vector<Hit> hits;
  for (std::size_t b = 0; b < scene.balls.size(); ++b) {
    if (b % (1 << 16) == 0) progress.check();
    const double length = optics::length_to_ball(line, scene.balls[b]);
    if (std::isfinite(length)) hits.push_back({length, b});
  }
  std::sort(hits.begin(), hits.end(),
            [](const Hit& a, const Hit& b) { return std::tie(a.length, a.ball) < std::tie(b.length, b.ball); });
  std::vector<Layer> layers;
  for (const Hit& hit : hits) layers.push_back({0.0, static_cast<double>(scene.balls[hit.ball].color.a)});
  const std::size_t layer = seen_layer(layers, opacity);
  if (layer == no_index) return std::nullopt;
  Pick found = pick_atom(material, scene.balls[hits[layer].ball].atom, progress);
  found.depth = hits[layer].length * glm::dot(line.direction, camera.forward);
  return found;
}

std::optional<Pick> pick_triangle(const Material& material, const Scene& scene, const Camera& camera,
                                  const Parameters& parameters, int column, int row, Progress& progress) {
  const SightLine line(scene, camera, column, row);
  const auto met = line.triangles({scene.surface.data(), scene.surface.size()}, progress);
  if (met.empty()) return std::nullopt;
  const TriangleCrossing& first = met.front();
  Pick found;
  found.depth = first.depth;
  found.position = scene.center + line.point(first.depth);
  found.triangle = first.triangle;
  look_up(found, material, parameters, scene.surface[first.triangle], first.weights, progress);
  return found;
}

// Opacity of a stretch of the line, and how far along it (0 to 1) its middle lies as the eye sees it.
struct CellOpacity {
  double opacity = 0.0;
  double middle = 0.5;
};

CellOpacity opacity_of(const Scene& scene, const Parameters& parameters, const CellCrossing& crossing, double length) {
  const Tetrahedron& cell = scene.tetrahedra[crossing.cell];
  double near = 0.0;  // opacity coefficients at the ends
  double far = 0.0;
  CellOpacity result;
  if (scene.mode == Mode::volume) {
    double near_scalar = 0.0;
    double far_scalar = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      near_scalar += crossing.near_weights[i] * static_cast<double>(scene.scalars[cell[i]]);
      far_scalar += crossing.far_weights[i] * static_cast<double>(scene.scalars[cell[i]]);
    }
    const ColorMap& map = parameters.volume.color_map;
    result.opacity =
        1.0 -
        reference::integrate_mapped(map, near_scalar, far_scalar, parameters.volume.alpha_length, length).transmittance;
    near = static_cast<double>(map(near_scalar).a);
    far = static_cast<double>(map(far_scalar).a);
  } else {
    for (std::size_t i = 0; i < 4; ++i) {
      near += crossing.near_weights[i] * static_cast<double>(scene.colors[cell[i]].a);
      far += crossing.far_weights[i] * static_cast<double>(scene.colors[cell[i]].a);
    }
    result.opacity = -std::expm1(-parameters.volume_surface.alpha_length * length * 0.5 * (near + far));
  }
  if (near + far > 0.0) result.middle = (near + 2.0 * far) / (3.0 * (near + far));
  return result;
}

std::optional<Pick> pick_cell(const Material& material, const Scene& scene, const Camera& camera,
                              const Parameters& parameters, int column, int row, double opacity, Progress& progress) {
  const SightLine line(scene, camera, column, row);
  const auto cells = line.cells({scene.tetrahedra.data(), scene.tetrahedra.size()}, progress);
  std::vector<TriangleCrossing> faces;
  if (scene.mode == Mode::volume_surface && parameters.volume_surface.face_alpha > 0.0) {
    faces = line.triangles({scene.surface.data(), scene.surface.size()}, progress);
  }
  auto face = faces.begin();
  std::vector<Layer> layers;
  std::vector<double> middles;
  for (const CellCrossing& crossing : cells) {
    double clear = 1.0;
    // The cell behind a face begins at its depth, but for rounding.
    const double until = crossing.near_depth + 1e-6 * (crossing.far_depth - crossing.near_depth);
    for (; face != faces.end() && face->depth <= until; ++face) {
      if (face->entering) clear *= 1.0 - parameters.volume_surface.face_alpha;
    }
    const double length = (crossing.far_depth - crossing.near_depth) * line.stretch();
    const CellOpacity here = opacity_of(scene, parameters, crossing, length);
    layers.push_back({1.0 - clear, here.opacity});
    middles.push_back(here.middle);
  }
  const std::size_t layer = seen_layer(layers, opacity);
  if (layer == no_index) return std::nullopt;
  const CellCrossing& crossing = cells[layer];
  const double u = middles[layer];
  std::array<double, 4> weights;
  for (std::size_t i = 0; i < 4; ++i) {
    weights[i] = crossing.near_weights[i] + u * (crossing.far_weights[i] - crossing.near_weights[i]);
  }
  Pick found;
  found.depth = crossing.near_depth + u * (crossing.far_depth - crossing.near_depth);
  found.position = scene.center + line.point(found.depth);
  found.tetrahedron = crossing.cell;
  look_up(found, material, parameters, scene.tetrahedra[crossing.cell], weights, progress);
  return found;
}

}  // namespace

std::optional<Pick> pick(const Material& material, const Scene& scene, const Camera& camera,
                         const Parameters& parameters, int column, int row, double opacity, Progress& progress) {
  progress.check();
  switch (scene.mode) {
    case Mode::atoms:
      return pick_ball(material, scene, camera, column, row, opacity, progress);
    case Mode::surface:
    case Mode::xray:
      return pick_triangle(material, scene, camera, parameters, column, row, progress);
    case Mode::volume_surface:
    case Mode::volume:
      break;
  }
  return pick_cell(material, scene, camera, parameters, column, row, opacity, progress);
}

}  // namespace atomesh::gui
