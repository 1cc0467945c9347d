// Frames of the volume modes: drawn in lattices and in windows they are the direct picture, bit for bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/tetrahedralize.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cpu_renderer.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

struct Case {
  std::string name;
  Material material;
  Parameters parameters;
  Camera camera;
  Scene scene;
};

constexpr float untouched = -7.0F;

Image empty_picture(int width, int height) {
  Image image(width, height);
  for (Vec4f& pixel : image.pixels) pixel = Vec4f(untouched);
  return image;
}

std::string difference(const Image& a, const Image& b) {
  std::size_t different = 0;
  double largest = 0.0;
  for (std::size_t p = 0; p < a.pixels.size(); ++p) {
    if (std::memcmp(&a.pixels[p], &b.pixels[p], sizeof(Vec4f)) == 0) continue;
    ++different;
    for (int k = 0; k < 4; ++k) {
      largest = std::max(largest, std::abs(static_cast<double>(a.pixels[p][k]) - static_cast<double>(b.pixels[p][k])));
    }
  }
  return different == 0 ? "" : std::to_string(different) + " pixels by up to " + std::to_string(largest * 1e6) + "e-6";
}

// Draws all phases of the strides into one picture.
Image drawn_in_lattices(const Case& c, int column_stride, int row_stride) {
  RenderStats stats;
  Progress progress;
  const auto frame = cpu_renderer().prepare(c.scene, c.camera, c.parameters, whole_picture(c.camera), stats, progress);
  Image image = empty_picture(c.camera.width, c.camera.height);
  for (int row = row_stride - 1; row >= 0; --row) {
    for (int column = 0; column < column_stride; ++column) {
      frame->draw({column_stride, row_stride, column, row}, image, stats, {}, progress);
    }
  }
  return image;
}

// Draws windows of this size side by side, each with a lattice of its own.
Image drawn_in_windows(const Case& c, int width, int height, int stride) {
  RenderStats stats;
  Progress progress;
  Image image = empty_picture(c.camera.width, c.camera.height);
  for (int top = 0; top < c.camera.height; top += height) {
    for (int left = 0; left < c.camera.width; left += width) {
      const PixelWindow window{left, top, std::min(width, c.camera.width - left),
                               std::min(height, c.camera.height - top)};
      const auto frame = cpu_renderer().prepare(c.scene, c.camera, c.parameters, window, stats, progress);
      Image part = empty_picture(window.width, window.height);
      for (int phase = 0; phase < stride * stride; ++phase) {
        frame->draw({stride, stride, phase % stride, phase / stride}, part, stats, {}, progress);
      }
      for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
          image.at(left + column, top + row) = part.at(column, row);
        }
      }
    }
  }
  return image;
}

class VolumeFrames : public testing::TestWithParam<std::tuple<Mode, Projection, std::string>> {
 protected:
  void TearDown() override { set_threads(0); }
  void SetUp() override {
    set_threads(1);  // quicker for so small pictures
    const auto [mode, projection, kind] = GetParam();
    case_.name = kind;
    Parameters& parameters = case_.parameters = looking(mode, kind == "lattice" ? "front" : "iso", projection);
    parameters.volume_surface.alpha_length = parameters.volume.alpha_length = kind == "dense" ? 40.0 : 0.6;
    if (kind == "delaunay") {  // slivers, and cells that share circumspheres
      case_.material = box_material(5, 5, 5, 1.0, shaking(1e-3, 11));
      TetrahedralizeOptions options;
      options.mesher = "delaunay";
      TetrahedralizeReport report;
      case_.material.mesh = tetrahedralize(case_.material.atoms, options, report);
      case_.material.surface = extract_surface(case_.material.mesh);
    } else if (kind == "overlapping") {  // cells that begin at the same depth and lie in one another
      case_.material = box_material(3, 3, 3, 1.0, shaking(0.2, 3));
      TetMesh& mesh = case_.material.mesh;
      const std::size_t cells = mesh.tetrahedra.size();
      for (std::size_t t = 0; t + 5 < cells; t += 3) mesh.tetrahedra.push_back(mesh.tetrahedra[t]);
    } else if (kind == "cyclic") {
      case_.material = ring_of_bars();
    } else {
      case_.material = box_material(6, 5, 7, 1.0, kind == "lattice" ? nullptr : shaking(0.25, 5));
    }
    add_defects(case_.material, 9);
    case_.scene = make_scene(case_.material, parameters);
    const int size = kind == "tiny" ? 7 : 75;
    case_.camera = make_camera(parameters, case_.scene.bounds, size, kind == "tiny" ? 5 : 52);
    if (kind == "inside") {
      case_.camera.eye = Vec3(2.6, 2.4, 3.3);
      case_.camera.pixel *= projection == Projection::perspective ? 3.0 : 1.0;
    }
  }
  Image direct() const {
    RenderStats stats;
    Progress progress;
    return cpu_renderer().draw(case_.scene, case_.camera, case_.parameters, stats, {}, progress);
  }

  Case case_;
};

TEST_P(VolumeFrames, LatticesAreTheDirectPicture) {
  const Image whole = direct();
  for (const auto& [columns, rows] : {std::array{1, 1}, {2, 2}, {4, 4}, {8, 8}, {8, 1}, {2, 4}, {1, 8}}) {
    EXPECT_EQ(difference(whole, drawn_in_lattices(case_, columns, rows)), "") << columns << " x " << rows;
  }
}

TEST_P(VolumeFrames, WindowsAreTheDirectPicture) {
  const Image whole = direct();
  for (const auto& [width, height] : {std::array{32, 32}, {75, 9}, {13, 52}, {31, 33}, {200, 200}}) {
    EXPECT_EQ(difference(whole, drawn_in_windows(case_, width, height, 1)), "") << width << " x " << height;
  }
  EXPECT_EQ(difference(whole, drawn_in_windows(case_, 29, 21, 4)), "");
}

TEST_P(VolumeFrames, ThreadsDrawTheDirectPicture) {
  const Image one = direct();
  for (const int count : {2, 5}) {
    set_threads(count);
    EXPECT_EQ(difference(one, direct()), "") << count;
    EXPECT_EQ(difference(one, drawn_in_lattices(case_, 4, 4)), "") << count;
  }
}

// Each instruction set by itself, and all within rounding of each other.
TEST_P(VolumeFrames, EveryInstructionSetDrawsTheDirectPicture) {
  cell_projection::set_kernel("baseline");
  const Image baseline = direct();
  for (const char* name : {"baseline", "avx2", "avx512"}) {
    try {
      cell_projection::set_kernel(name);
    } catch (const UnavailableError&) {
      continue;  // not on this processor
    }
    const Image whole = direct();
    EXPECT_EQ(difference(whole, drawn_in_lattices(case_, 4, 4)), "") << name;
    EXPECT_EQ(difference(whole, drawn_in_windows(case_, 37, 41, 1)), "") << name;
    EXPECT_LE(compare_images(whole, baseline).max, case_.name == "dense" ? 2e-5 : 3e-6) << name;
  }
  cell_projection::set_kernel("");
}

std::string case_name(const testing::TestParamInfo<VolumeFrames::ParamType>& info) {
  const auto [mode, projection, kind] = info.param;
  return std::string(mode == Mode::volume ? "volume_" : "volume_surface_") +
         (projection == Projection::parallel ? "parallel_" : "perspective_") + kind;
}

INSTANTIATE_TEST_SUITE_P(Every, VolumeFrames,
                         testing::Combine(testing::Values(Mode::volume, Mode::volume_surface),
                                          testing::Values(Projection::parallel, Projection::perspective),
                                          testing::Values("shaken", "dense", "lattice", "delaunay", "overlapping",
                                                          "cyclic", "inside", "tiny")),
                         case_name);

TEST(VolumeFrames, AFrameWithoutCellsClearsItsLattice) {
  const Parameters parameters = looking(Mode::volume, "iso");
  Scene scene;
  scene.mode = Mode::volume;
  const Camera camera = make_camera(parameters, {{0, 0, 0}, {1, 1, 1}}, 20, 20);
  RenderStats stats;
  Progress progress;
  const auto frame = cpu_renderer().prepare(scene, camera, parameters, {3, 5, 11, 9}, stats, progress);
  Image image = empty_picture(11, 9);
  frame->draw({4, 2, 1, 1}, image, stats, {}, progress);
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 11; ++column) {
      const bool drawn = (column + 3) % 4 == 1 && (row + 5) % 2 == 1;
      EXPECT_EQ(image.at(column, row).a, drawn ? 0.0F : untouched) << column << ' ' << row;
    }
  }
}

}  // namespace
}  // namespace atomesh::test
