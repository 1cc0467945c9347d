#include "app/cli/bench_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <optional>

#include "app/cli/bench_render_tools.h"
#include "app/cli/bench_tools.h"
#include "app/cli/read_mesh.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/surface.h"
#include "preprocess/pipeline.h"
#include "preprocess/tetrahedralize.h"
#include "preprocess/write_atoms.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "samples/random.h"
#include "samples/samples.h"

namespace atomesh::cli {

namespace {

constexpr double jitter = 0.3;  // of the lattice's step, along each axis
constexpr float haze = 0.05F;   // opacity of what is no longer left transparent
constexpr std::string_view waves_name = "waves";

std::vector<BenchSceneInfo> make_table() {
  std::vector<BenchSceneInfo> table{{"lattice-36", "jittered 36³ lattice, Delaunay, smooth scalar: 0.32 M cells", ""},
                                    {"lattice-58", "jittered 58³ lattice, Delaunay, smooth scalar: 1.35 M cells", ""},
                                    {"lattice-100", "jittered 100³ lattice, Delaunay, smooth scalar: 6.9 M cells", ""},
                                    {"lattice-36-random", "the same points, a random scalar at each", ""},
                                    {"lattice-58-random", "the same points, a random scalar at each", ""},
                                    {"lattice-100-random", "the same points, a random scalar at each", ""},
                                    {"comb", "NASA's annular combustor, density", "vtkdata__combxyz.bin"},
                                    {"blunt-fin", "NASA's blunt fin, density", "vtkdata__bluntfinxyz.bin"},
                                    {"post", "NASA's liquid oxygen post, energy", "vtkdata__postxyz.bin"},
                                    {"usm3d-box", "USM3D's flow in a box, density", "usm3d_box.vtk"},
                                    {"quake", "ground of the San Fernando valley (Quake), depth", "quake_sf10.vtk"},
                                    {"chaste-cube", "Chaste's cube, waves", "chaste__Cube21.node"},
                                    {"raptor", "SOFA's raptor, waves", "sofa__raptorTetra_8418.vtu"}};
  for (const SampleInfo& sample : sample_table()) {
    table.push_back({std::string(sample.name), std::string(sample.title), ""});
  }
  return table;
}

// Seven knots, of which some lie close together and one stretch is transparent: what the literature calls a transfer
// function with peaks.
ColorMap peaked_map() {
  ColorMap map;
  map.entries = {{0.0, {0.05F, 0.1F, 0.5F, 0.0F}}, {0.2, {0.1F, 0.4F, 0.9F, 0.12F}},   {0.35, {0.1F, 0.8F, 0.6F, 0.0F}},
                 {0.5, {0.3F, 0.8F, 0.2F, 0.25F}}, {0.58, {0.9F, 0.85F, 0.1F, 0.05F}}, {0.8, {0.9F, 0.4F, 0.05F, 0.6F}},
                 {1.0, {0.8F, 0.0F, 0.1F, 1.0F}}};
  return map;
}

void dress(BenchScene& scene) {
  const double size = bounds_of(scene.material.mesh.vertices).diagonal();
  Parameters& p = scene.parameters;
  p.volume.color_map = peaked_map();
  p.volume.alpha_length = 16.0 / size;
  p.volume_surface.alpha_length = 12.0 / size;
  p.volume_surface.base_color.a = 0.1F;
  p.xray.alpha_length = 1.0 / size;
  scene.views = {{"iso", "iso", Projection::perspective}, {"side", "-75,-10", Projection::parallel}};
}

struct LatticeName {
  int side;
  bool random;
};
std::optional<LatticeName> parse_lattice(std::string_view name) {
  constexpr std::string_view prefix = "lattice-";
  constexpr std::string_view suffix = "-random";
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  const bool random = name.ends_with(suffix);
  if (random) name.remove_suffix(suffix.size());
  int side = 0;
  const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), side);
  if (error != std::errc() || rest != name.data() + name.size() || side < 2 || side > 200) return std::nullopt;
  return LatticeName{side, random};
}

// Waves a quarter as long as the block, their sum squeezed into [0,1].
float smooth_scalar(const Vec3& p, double side) {
  const Vec3 w = 8.0 * std::numbers::pi / side * p;
  return static_cast<float>(
      0.5 + (std::sin(w.x + 0.3) + std::sin(0.7 * w.y + 0.4 * w.x) + std::sin(0.9 * w.z - 0.3 * w.y)) / 6.0);
}

Material lattice_material(const LatticeName& lattice, Progress& progress) {
  progress.stage("lattice");
  const auto n = static_cast<std::size_t>(lattice.side);
  Material material;
  TetMesh& mesh = material.mesh;
  mesh.vertices.reserve(n * n * n);
  for (std::size_t i = 0; i < n * n * n; ++i) {
    const auto shift = [i](std::uint64_t axis) { return jitter * (2.0 * Random::uniform_of(1 + axis, i) - 1.0); };
    mesh.vertices.emplace_back(static_cast<double>(i % n) + shift(0), static_cast<double>(i / n % n) + shift(1),
                               static_cast<double>(i / n / n) + shift(2));
  }
  mesh.tetrahedra = delaunay_cgal(mesh.vertices, progress);
  mesh.delaunay = true;
  mesh.vertex_atom.resize(mesh.vertices.size());
  std::iota(mesh.vertex_atom.begin(), mesh.vertex_atom.end(), Index{0});
  material.atoms.positions = mesh.vertices;
  material.atoms.species.assign(mesh.vertices.size(), material.atoms.add_species("C"));
  Defects& defects = material.defects;
  defects.positional.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    defects.positional[i] =
        lattice.random ? static_cast<float>(Random::uniform_of(4, i)) : smooth_scalar(mesh.vertices[i], lattice.side);
  }
  defects.vacancy.assign(mesh.vertices.size(), 0.0F);
  defects.extra.assign(mesh.vertices.size(), 0.0F);
  material.surface = extract_surface(mesh, progress);
  return material;
}

Material sample_material(const std::string& name, std::size_t atoms, Progress& progress) {
  const TemporaryFolder folder;
  const std::string file = folder.file(name + ".dat");
  {
    const Sample grown = make_sample(name, {.atoms = atoms}, progress);
    write_atoms(file, grown.atoms, grown.unit_cell, progress);
  }
  PipelineReport report;
  return preprocess(file, {}, report, progress);
}

bool varies(const std::vector<float>& values) {
  return std::any_of(values.begin(), values.end(), [&](float v) { return v != values.front(); });
}

void add_waves(Material& material) {
  const Bounds bounds = bounds_of(material.mesh.vertices);
  VertexField& waves = material.fields.emplace_back(VertexField{std::string(waves_name), {}});
  for (const Vec3& p : material.mesh.vertices) {
    waves.values.push_back(smooth_scalar(p - bounds.min, 0.6 * bounds.diagonal()));
  }
}

Material file_material(const BenchSceneInfo& info, const std::string& data_folder, Progress& progress) {
  const std::string path = (std::filesystem::path(volume_data_folder(data_folder)) / info.file).string();
  if (!std::filesystem::exists(path)) {
    throw UnavailableError(info.name + ": there is no " + path + "; --data names the folder of the public data sets");
  }
  MeshFileReport report;
  Material material = read_mesh_file(path, {}, report, progress);
  const auto shows_something = [](const VertexField& field) { return varies(field.values); };
  if (std::none_of(material.fields.begin(), material.fields.end(), shows_something)) add_waves(material);
  return material;
}

// Of a small picture of mode volume from the first view: its mean coverage, and what it would be if all were opaque.
struct Coverage {
  double seen, whole;
};
Coverage coverage_of(const BenchScene& scene, const Scene& drawn, Progress& progress) {
  constexpr int side = 64;  // pixels
  Parameters parameters = scene.seen(scene.views.front(), Mode::volume);
  const Camera camera = make_camera(parameters, drawn.bounds, side, side);
  const auto coverage = [&] {
    RenderStats stats;
    return mean_coverage(find_renderer("cpu").draw(drawn, camera, parameters, stats, {}, progress));
  };
  const double seen = coverage();
  parameters.volume.color_map = {{{0.0, Vec4f(1.0F)}, {1.0, Vec4f(1.0F)}}};
  parameters.volume.alpha_length *= 1e6;
  return {seen, coverage()};
}

// Where mode volume is nearly empty, lets it show what a user would look at.
void show_in_volume(BenchScene& scene, Progress& progress) {
  const Scene drawn = make_scene(scene.material, scene.seen(scene.views.front(), Mode::volume), progress);
  const Coverage coverage = coverage_of(scene, drawn, progress);
  if (coverage.seen >= nearly_empty * coverage.whole) return;
  if (varies(drawn.scalars)) {
    for (ColorMapEntry& entry : scene.parameters.volume.color_map.entries) {
      entry.color.a = std::max(entry.color.a, haze);
    }
    scene.volume_map = "peaks in haze";
    return;
  }
  add_waves(scene.material);
  scene.volume_field = waves_name;
  scene.volume_map = "peaks of waves";
}

}  // namespace

Parameters BenchScene::seen(const BenchView& view, Mode mode) const {
  Parameters seen = parameters;
  seen.mode = mode;
  if (mode == Mode::volume && !volume_field.empty()) seen.volume.field = volume_field;
  seen.projection = view.projection;
  set_view(seen, view.direction);
  return seen;
}

const std::vector<BenchSceneInfo>& bench_scene_table() {
  static const std::vector<BenchSceneInfo> table = make_table();
  return table;
}

std::string volume_data_folder(const std::string& folder) {
  return folder.empty() ? "../shared/data/volume" : folder;
}

std::string volume_map_caption() {
  return fmt::format(
      "the color map, with peaks over the scalar; where less than {:.0f} % of the sample would be seen of it, scalars "
      "it "
      "does not show are given a little opacity (in haze), and a scalar that is the same everywhere is replaced by "
      "waves",
      100.0 * nearly_empty);
}

BenchScene make_bench_scene(const std::string& name, const std::string& data_folder, std::size_t atoms,
                            Progress& progress) {
  BenchScene scene;
  scene.name = name;
  if (const auto lattice = parse_lattice(name)) {
    scene.material = lattice_material(*lattice, progress);
  } else {
    const std::vector<BenchSceneInfo>& table = bench_scene_table();
    const auto info = std::find_if(table.begin(), table.end(), [&](const BenchSceneInfo& i) { return i.name == name; });
    if (info == table.end()) {
      std::vector<std::string> names;
      for (const BenchSceneInfo& known : table) names.push_back(known.name);
      const std::string nearest = nearest_name(name, names);
      throw UsageError(fmt::format("bench: there is no case \"{}\"{}; there are: {}", name,
                                   nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                   fmt::join(names, ", ")));
    }
    scene.material =
        info->file.empty() ? sample_material(name, atoms, progress) : file_material(*info, data_folder, progress);
  }
  dress(scene);
  show_in_volume(scene, progress);
  return scene;
}

}  // namespace atomesh::cli
