#include "tests/render/fixtures.h"

#include <array>
#include <numbers>
#include <random>

namespace atomesh::test {

namespace {

void finish(Material& material, const std::string& species) {
  material.atoms.positions = material.mesh.vertices;
  const std::uint16_t s = material.atoms.add_species(species);
  material.atoms.species.assign(material.atoms.size(), s);
  for (std::size_t v = 0; v < material.atoms.size(); ++v) {
    material.mesh.vertex_atom.push_back(static_cast<Index>(v));
  }
  material.surface = extract_surface(material.mesh);
}

}  // namespace

Material box_material(int nx, int ny, int nz, double step, const std::function<Vec3(const Vec3&)>& move) {
  Material material;
  TetMesh& mesh = material.mesh;
  const auto vertex = [nx, ny](int i, int j, int k) { return static_cast<Index>((k * (ny + 1) + j) * (nx + 1) + i); };
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Vec3 p = step * Vec3(i, j, k);
        mesh.vertices.push_back(move ? move(p) : p);
      }
    }
  }
  // From corner (0,0,0) to (1,1,1) along the axes in each of the six orders.
  constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        for (const auto& order : orders) {
          int at[3] = {i, j, k};
          Tetrahedron t{};
          t[0] = vertex(at[0], at[1], at[2]);
          for (std::size_t leg = 0; leg < 3; ++leg) {
            ++at[order[leg]];
            t[leg + 1] = vertex(at[0], at[1], at[2]);
          }
          const auto& p = mesh.vertices;
          if (signed_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) < 0.0) std::swap(t[2], t[3]);
          mesh.tetrahedra.push_back(t);
        }
      }
    }
  }
  finish(material, "C");
  return material;
}

Material one_tetrahedron() {
  Material material;
  material.mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  material.mesh.tetrahedra = {{0, 1, 2, 3}};
  finish(material, "C");
  return material;
}

Material ring_of_bars() {
  Material material;
  TetMesh& mesh = material.mesh;
  for (int bar = 0; bar < 3; ++bar) {
    const double angle = 2.0 * std::numbers::pi / 3.0 * bar + 0.2;
    const Vec3 along(std::cos(angle), 0.0, std::sin(angle));
    const Vec3 across(-std::sin(angle), 0.0, std::cos(angle));
    const Vec3 depth(0, 1, 0);
    const auto first = static_cast<Index>(mesh.vertices.size());
    const Vec3 start = across - 3.0 * along - 1.5 * depth;
    const Vec3 end = across + 3.0 * along + 1.5 * depth;
    const Vec3 turned = 0.8 * across + 0.3 * depth;
    const std::array<Vec3, 4> p{start + 0.8 * across, start - 0.8 * across, end + turned, end - turned};
    mesh.vertices.insert(mesh.vertices.end(), p.begin(), p.end());
    Tetrahedron cell{first, first + 1, first + 2, first + 3};
    if (signed_volume(p[0], p[1], p[2], p[3]) < 0.0) std::swap(cell[0], cell[1]);
    mesh.tetrahedra.push_back(cell);
  }
  finish(material, "C");
  return material;
}

Material atoms_material(const std::vector<std::pair<std::string, Vec3>>& atoms) {
  Material material;
  for (const auto& [species, position] : atoms) {
    material.atoms.species.push_back(material.atoms.add_species(species));
    material.atoms.positions.push_back(position);
  }
  return material;
}

void add_defects(Material& material, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> value(-0.5F, 1.0F);
  for (std::size_t a = 0; a < material.atoms.size(); ++a) {
    material.defects.positional.push_back(std::max(0.0F, value(random)));
    material.defects.vacancy.push_back(std::max(0.0F, value(random)));
    material.defects.extra.push_back(std::max(0.0F, value(random)));
  }
}

std::function<Vec3(const Vec3&)> shaking(double amplitude, std::uint64_t seed) {
  return [random = std::mt19937_64(seed),
          shift = std::uniform_real_distribution<double>(-amplitude, amplitude)](const Vec3& p) mutable {
    const double x = shift(random);
    const double y = shift(random);
    return p + Vec3(x, y, shift(random));
  };
}

Parameters looking(Mode mode, std::string_view view, Projection projection) {
  Parameters parameters;
  parameters.mode = mode;
  parameters.projection = projection;
  set_view(parameters, view);
  return parameters;
}

Subject shaken_box(Mode mode, Projection projection, int width, int height) {
  Subject subject;
  subject.material = box_material(3, 4, 3, 2.0, shaking(0.3, 5));
  add_defects(subject.material, 3);
  subject.parameters = looking(mode, "iso", projection);
  subject.parameters.volume_surface.face_alpha = 0.4;
  subject.parameters.atoms.regular_opacity = 0.5;
  subject.scene = make_scene(subject.material, subject.parameters);
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, width, height);
  return subject;
}

Drawn draw(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters) {
  Drawn drawn;
  const Channels channels{&drawn.thickness, &drawn.depth, &drawn.id};
  drawn.image = renderer.draw(scene, camera, parameters, drawn.stats, channels, no_progress());
  return drawn;
}

}  // namespace atomesh::test
