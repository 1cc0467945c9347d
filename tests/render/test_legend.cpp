// Legends and scale bars: their colours are the picture's, their lengths the camera's, and they can be read anywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/elements.h"
#include "render/legend.h"
#include "render/legend_drawing.h"
#include "render/text_raster.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

double difference(const Vec4f& a, const Vec4f& b) {
  double largest = 0.0;
  for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(1.0 * a[c] - 1.0 * b[c]));
  return largest;
}

std::vector<std::string> names(const Legend& legend) {
  std::vector<std::string> all;
  for (const LegendEntry& entry : legend.entries) all.push_back(entry.name);
  return all;
}

using Names = std::vector<std::string>;

TEST(XrayLegend, HalfThicknessIsTheFormula) {
  XrayParameters parameters;
  parameters.alpha_length = 0.01;
  parameters.color = Vec3f(0.2F, 0.4F, 0.6F);
  // 40 Å: opacity 0.4.
  const Legend over_white = xray_legend(parameters, Vec4f(1.0F), 80.0);
  EXPECT_LT(difference(over_white.scale->color(40.0), Vec4f(0.68F, 0.76F, 0.84F, 1.0F)), 1e-6);
  EXPECT_LT(difference(over_white.scale->color(0.0), Vec4f(1.0F)), 1e-6);
  const Legend over_nothing = xray_legend(parameters, Vec4f(0.0F), 80.0);
  EXPECT_LT(difference(over_nothing.scale->color(40.0), Vec4f(0.2F, 0.4F, 0.6F, 0.4F)), 1e-6);
  EXPECT_EQ(over_nothing.scale->color(0.0), Vec4f(0.0F));
  EXPECT_EQ(over_white.title, "thickness, Å");
  EXPECT_EQ(xray_legend(parameters, Vec4f(1.0F), 80.0, false).title, "thickness");
  EXPECT_EQ(over_white.scale->min, 0.0);
  EXPECT_EQ(over_white.scale->max, 80.0);
  EXPECT_FALSE(over_white.scale->mark) << "80 Å are not opaque";
  const Legend saturated = xray_legend(parameters, Vec4f(1.0F), 160.0);
  EXPECT_DOUBLE_EQ(saturated.scale->mark.value(), 100.0);
  EXPECT_EQ(saturated.scale->mark_text, "100: opaque");
  EXPECT_LT(difference(saturated.scale->color(130.0), Vec4f(parameters.color, 1.0F)), 1e-6);
}

// Two ways to one colour: the legend's of a thickness, and the picture's of the pixel that has it.
TEST(XrayLegend, IsThePicture) {
  Material material = box_material(3, 2, 4, 5.0);
  Parameters parameters = looking(Mode::xray, "iso", Projection::perspective);
  parameters.xray.alpha_length = 0.1;
  parameters.xray.color = Vec3f(0.9F, 0.3F, 0.1F);
  for (const Vec4f background : {Vec4f(1.0F), Vec4f(0.1F, 0.2F, 0.3F, 1.0F), Vec4f(0.5F, 0.6F, 0.7F, 0.25F)}) {
    parameters.background = background;
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 64, 48);
    std::vector<float> thickness;
    Channels channels;
    channels.thickness = &thickness;
    RenderStats stats;
    const Image image = render(find_renderer("cpu"), scene, camera, parameters, stats, channels);
    const double thickest = *std::max_element(thickness.begin(), thickness.end());
    EXPECT_GT(thickest, 1.0 / parameters.xray.alpha_length);
    const std::optional<Legend> legend = make_legend(scene, material, parameters, thickest);
    ASSERT_TRUE(legend && legend->scale && legend->scale->mark);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
      EXPECT_LT(difference(legend->scale->color(thickness[i]), image.pixels[i]), 1e-5) << i;
    }
  }
}

TEST(ColorMapLegend, RunsFromTheRangesEndToEnd) {
  const ColorMap map = preset_color_map("viridis");
  const Legend legend = color_map_legend(map, {"pressure, GPa", -2.0, 6.0});
  EXPECT_EQ(legend.title, "pressure, GPa");
  EXPECT_LT(difference(legend.scale->color(-2.0), Vec4f(Vec3f(map(0.0)), 1.0F)), 1e-6);
  EXPECT_LT(difference(legend.scale->color(0.0), Vec4f(Vec3f(map(0.25)), 1.0F)), 1e-6);
  EXPECT_LT(difference(legend.scale->color(99.0), Vec4f(Vec3f(map(1.0)), 1.0F)), 1e-6);
  // The same everywhere: the middle's colour, as in the picture.
  const Legend flat = color_map_legend(map, {"p", 3.0, 3.0});
  EXPECT_LT(difference(flat.scale->color(3.0), Vec4f(Vec3f(map(0.5)), 1.0F)), 1e-6);
}

TEST(ColorMapLegend, TellsOfTheFieldThatIsShown) {
  Material material = box_material(1, 1, 1, 4.0);
  const std::size_t n = material.mesh.vertices.size();
  material.fields.push_back({"density", std::vector<float>(n, 2.0F)});
  material.fields[0].values[0] = -1.0F;
  material.fields[0].values[n - 1] = 7.0F;
  for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
    Parameters parameters = looking(mode, "iso");
    parameters.volume.field = "density";
    const Scene scene = make_scene(material, parameters);
    const std::optional<Legend> legend = make_legend(scene, material, parameters, 0.0);
    ASSERT_TRUE(legend && legend->scale);
    EXPECT_EQ(legend->title, "density");
    EXPECT_EQ(legend->scale->min, -1.0);
    EXPECT_EQ(legend->scale->max, 7.0);
    EXPECT_FALSE(legend->scale->below || legend->scale->above);
    parameters.volume.range_high = 5.0;
    const std::optional<Legend> narrowed = make_legend(scene, material, parameters, 0.0);
    EXPECT_EQ(narrowed->scale->max, 5.0);
    EXPECT_TRUE(narrowed->scale->above);
    EXPECT_FALSE(narrowed->scale->below);
  }
}

TEST(VolumeSurfaceLegend, NamesTheColorsThatAreAdded) {
  VolumeSurfaceParameters parameters;
  EXPECT_EQ(names(volume_surface_legend(parameters, true)),
            (Names{"base", "positional defect", "extra atom", "vacancy"}));
  EXPECT_EQ(volume_surface_legend(parameters, true).entries[3].color, Vec3f(parameters.vacancy_color));
  EXPECT_EQ(names(volume_surface_legend(parameters, false)), (Names{"base"}));
  parameters.extra_multiplier = 0.0;
  EXPECT_EQ(names(volume_surface_legend(parameters, true)), (Names{"base", "positional defect", "vacancy"}));
}

TEST(AtomsLegend, NamesWhatIsDrawnAsItIsDrawn) {
  const Material material = atoms_material({{"Na", {0, 0, 0}}, {"Cl", {3, 0, 0}}, {"H", {0, 3, 0}}, {"Na", {3, 3, 0}}});
  Parameters parameters = looking(Mode::atoms, "top");
  parameters.atoms.colors["Cl"] = Vec3f(0.1F, 0.2F, 0.3F);
  parameters.atoms.visible["H"] = false;
  const Scene scene = make_scene(material, parameters);
  const std::optional<Legend> legend = make_legend(scene, material, parameters, 0.0);
  ASSERT_TRUE(legend);
  EXPECT_EQ(names(*legend), (Names{"Na", "Cl"}));
  const auto na = find_element("Na")->color;
  EXPECT_LT(glm::length(legend->entries[0].color - Vec3f(na[0], na[1], na[2]) / 255.0F), 1e-6F);
  EXPECT_EQ(legend->entries[1].color, Vec3f(0.1F, 0.2F, 0.3F));
  EXPECT_TRUE(legend->balls);
}

TEST(Legend, ThereIsNoneWhereNothingIsToBeExplained) {
  const Material material = box_material(1, 1, 1, 4.0);
  Parameters parameters = looking(Mode::surface, "iso");
  EXPECT_FALSE(make_legend(make_scene(material, parameters), material, parameters, 0.0));
  parameters.mode = Mode::xray;
  const Scene scene = make_scene(material, parameters);
  EXPECT_FALSE(make_legend(scene, material, parameters, 0.0)) << "every ray misses the sample";
  EXPECT_TRUE(make_legend(scene, material, parameters, 1.0));
  EXPECT_FALSE(make_legend(Scene{}, material, parameters, 1.0));
}

TEST(ScaleBar, IsOfRoundLength) {
  Camera camera;
  camera.projection = Projection::parallel;
  camera.width = 1000;
  camera.height = 800;
  const auto text = [&](double pixel) {
    camera.pixel = pixel;
    const std::optional<ScaleBar> bar = make_scale_bar(camera, Vec3(0.0));
    EXPECT_TRUE(bar);
    EXPECT_NEAR(bar->pixels * pixel, bar->length, 1e-9 * bar->length);
    EXPECT_LE(bar->pixels, 200.0 * (1.0 + 1e-9));
    EXPECT_GT(bar->pixels, 200.0 / 2.5 * (1.0 - 1e-9));
    return bar->text;
  };
  EXPECT_EQ(text(0.1), "20 Å");
  EXPECT_EQ(text(0.099), "10 Å");
  EXPECT_EQ(text(0.005), "1 Å");
  EXPECT_EQ(text(0.002), "0.2 Å");
  EXPECT_EQ(text(0.3), "50 Å");
  EXPECT_EQ(text(0.6), "10 nm");
  EXPECT_EQ(text(2.6), "50 nm");
  EXPECT_EQ(text(55.0), "1 µm");
  // The unit of a mesh file is its author's.
  camera.pixel = 2.6;
  EXPECT_EQ(make_scale_bar(camera, Vec3(0.0), false)->text, "500 units");
}

// Two points that far apart across the sample's centre are that many pixels apart.
TEST(ScaleBar, IsTheCameras) {
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    Parameters parameters = looking(Mode::surface, "iso", projection);
    Bounds bounds;
    bounds.add({10, 20, 30});
    bounds.add({90, 70, 65});
    parameters.zoom = 1.7;
    const Camera camera = make_camera(parameters, bounds, 800, 600);
    const std::optional<ScaleBar> bar = make_scale_bar(camera, bounds.center());
    ASSERT_TRUE(bar);
    const Vec3 half = 0.5 * bar->length * camera.right;
    const double apart = project(camera, bounds.center() + half).x - project(camera, bounds.center() - half).x;
    EXPECT_NEAR(apart / camera.pixel, bar->pixels, 1e-9 * bar->pixels);
    EXPECT_EQ(bar->text.ends_with(" at center"), projection == Projection::perspective);
  }
}

TEST(ScaleBar, NoneBehindTheEye) {
  Camera camera;
  camera.width = 800;
  camera.pixel = 0.001;
  EXPECT_TRUE(make_scale_bar(camera, Vec3(0, 5, 0)));
  EXPECT_FALSE(make_scale_bar(camera, Vec3(0, -5, 0)));
  EXPECT_FALSE(make_scale_bar(camera, Vec3(0.0)));
}

Legend thickness_legend(const Vec4f& background) {
  XrayParameters parameters;
  parameters.alpha_length = 0.03;
  return xray_legend(parameters, background, 83.7);
}

const ScaleBar some_bar{20.0, 61.0, "20 Å at center"};

TEST(LegendDrawing, TheBarHasTheColorsOfItsValues) {
  const Legend legend = thickness_legend(Vec4f(0.0F));
  const LegendDrawing drawing(400, 300, Vec4f(0.0F), legend, {});
  ASSERT_TRUE(drawing.color_bar());
  Image image(400, 300);
  Canvas canvas(image);
  drawing.draw(canvas);
  const CanvasBox bar = *drawing.color_bar();
  EXPECT_GE(bar.height(), 100);
  int marked = 0;
  for (int row = bar.top; row < bar.bottom; ++row) {
    const double thickness = 83.7 * (bar.bottom - (row + 0.5)) / bar.height();
    const Vec4f color = legend.scale->color(thickness);
    for (int column = bar.left; column < bar.right; ++column) {
      if (difference(image.at(column, row), color) < 1e-6) continue;
      ++marked;
      EXPECT_NEAR(thickness, 1.0 / 0.03, 83.7 / bar.height() * 1.5) << "only the mark of 1/alpha covers the colours";
    }
  }
  EXPECT_GE(marked, bar.width());
}

// WCAG 2's contrast between the text's colour and what is under it, at the least.
double contrast(const Vec4f& text, const Vec4f& below) {
  const auto luminance = [](const Vec4f& color) {
    const auto linear = [](float c) { return c <= 0.04045F ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
  };
  const double a = luminance(text) + 0.05;
  const double b = luminance(below) + 0.05;
  return std::max(a / b, b / a);
}

TEST(LegendDrawing, CanBeReadOverAnything) {
  for (const float background : {0.0F, 0.3F, 0.6F, 1.0F}) {
    for (const float sample : {0.0F, 0.5F, 1.0F}) {
      const Vec4f paper(Vec3f(background), 1.0F);
      const LegendDrawing drawing(400, 300, paper, thickness_legend(paper), some_bar);
      Image image(400, 300);
      for (Vec4f& pixel : image.pixels) pixel = Vec4f(Vec3f(sample), 1.0F);
      Canvas canvas(image);
      drawing.draw(canvas);
      const CanvasBox box = *drawing.scale_bar_box();
      const Vec4f panel = image.at(box.left + box.width() / 2, box.top + 1);
      double most = 0.0;
      for (int row = box.top; row < box.bottom; ++row) {
        for (int column = box.left; column < box.right; ++column) {
          most = std::max(most, contrast(image.at(column, row), panel));
        }
      }
      EXPECT_GE(most, 7.0) << background << " " << sample;
    }
  }
}

TEST(LegendDrawing, StaysInPicturesOfAnySize) {
  Legend entries{"", {}, {{"a very long name indeed of a species that nobody has", Vec3f(0.5F)}}, true};
  for (int i = 0; i < 40; ++i) entries.entries.push_back({"X" + std::to_string(i), Vec3f(0.2F)});
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1},
                                                                      {20, 20},
                                                                      {64, 48},
                                                                      {120, 90},
                                                                      {300, 200},
                                                                      {200, 300},
                                                                      {800, 600},
                                                                      {4000, 100},
                                                                      {100, 4000},
                                                                      {3840, 2160}}) {
    for (const Legend& legend : {thickness_legend(Vec4f(1.0F)), entries}) {
      const LegendDrawing drawing(width, height, Vec4f(1.0F), legend, some_bar);
      for (const std::optional<CanvasBox>& box : {drawing.legend_box(), drawing.scale_bar_box(), drawing.color_bar()}) {
        if (!box) continue;
        EXPECT_GE(box->left, 0);
        EXPECT_GE(box->top, 0);
        EXPECT_LE(box->right, width);
        EXPECT_LE(box->bottom, height);
      }
      const bool roomy = height >= 90 && width >= 200;
      const bool tiny = std::min(width, height) < 50;
      if (roomy || tiny) {
        EXPECT_EQ(drawing.legend_box().has_value(), roomy) << width << "x" << height;
        EXPECT_EQ(drawing.scale_bar_box().has_value(), roomy) << width << "x" << height;
      }
      if (drawing.legend_box() && drawing.scale_bar_box()) {
        EXPECT_LE(drawing.scale_bar_box()->right, drawing.legend_box()->left) << width << "x" << height;
      }
      Image image(width, height);
      Canvas canvas(image);
      drawing.draw(canvas);
      for (const Vec4f& pixel : image.pixels) {
        ASSERT_TRUE(pixel.a >= 0.0F && pixel.a <= 1.0F + 1e-6F && pixel.r >= 0.0F && pixel.r <= 1.0F + 1e-6F);
      }
    }
  }
}

// A picture drawn in passes gets its legend band by band.
TEST(LegendDrawing, BandsAreTheWhole) {
  const LegendDrawing drawing(300, 200, Vec4f(1.0F), thickness_legend(Vec4f(1.0F)), some_bar);
  Image whole(300, 200);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> channel(0.0F, 1.0F);
  for (Vec4f& pixel : whole.pixels) pixel = Vec4f(channel(random), channel(random), channel(random), channel(random));
  const Image before = whole;
  Canvas canvas(whole);
  drawing.draw(canvas);
  EXPECT_NE(whole.pixels, before.pixels);
  const int rows = 7;
  for (int first = 0; first < whole.height; first += rows) {
    Image band(whole.width, std::min(rows, whole.height - first));
    const auto begin = before.pixels.begin() + first * whole.width;
    band.pixels.assign(begin, begin + band.width * band.height);
    Canvas part(band, first);
    drawing.draw(part);
    for (std::size_t i = 0; i < band.pixels.size(); ++i) {
      ASSERT_EQ(band.pixels[i], whole.pixels[i + static_cast<std::size_t>(first * whole.width)]) << first;
    }
  }
}

}  // namespace
}  // namespace atomesh::test
