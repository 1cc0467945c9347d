// What lies over the picture: marks where things are, bands that make the picture.
#include <gtest/gtest.h>

#include <cmath>

#include "app/gui/overlay.h"
#include "tests/render/fixtures.h"

namespace atomesh::gui {
namespace {

Bounds cube() {
  Bounds bounds;
  bounds.add(Vec3(-10.0));
  bounds.add(Vec3(10.0));
  return bounds;
}

Camera camera_of(Projection projection, int width = 300, int height = 240) {
  return make_camera(test::looking(Mode::surface, "iso", projection), cube(), width, height);
}

// Points of the sphere are inside its outline, and some come as near to it as can be.
TEST(SphereOutline, IsWhereTheSphereEnds) {
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    const Camera camera = camera_of(projection);
    const Vec3 center = camera.eye + 20.0 * camera.forward + 6.0 * camera.right - 2.0 * camera.up;
    const double radius = 2.5;
    const auto outline = sphere_outline(camera, center, radius, 256);
    ASSERT_EQ(outline.size(), 256U);
    const CanvasPoint middle = *canvas_point(camera, center);
    double farthest = 0.0;
    double of_outline = 0.0;
    const CanvasPoint way = glm::normalize(CanvasPoint(0.8, 0.6));
    for (const CanvasPoint& p : outline) of_outline = std::max(of_outline, glm::dot(p - middle, way));
    for (int i = 0; i < 400; ++i) {
      for (int j = 0; j <= 200; ++j) {
        const double a = 2.0 * std::numbers::pi * i / 400;
        const double b = std::numbers::pi * j / 200;
        const Vec3 p = center + radius * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
        farthest = std::max(farthest, glm::dot(*canvas_point(camera, p) - middle, way));
      }
    }
    EXPECT_NEAR(of_outline, farthest, 0.002 * farthest);
  }
  const Camera camera = camera_of(Projection::perspective);
  EXPECT_TRUE(sphere_outline(camera, camera.eye, 3.0).empty());                         // the eye is in it
  EXPECT_TRUE(sphere_outline(camera, camera.eye - 9.0 * camera.forward, 3.0).empty());  // behind
  EXPECT_FALSE(canvas_point(camera, camera.eye - 9.0 * camera.forward).has_value());
}

OverlayParts everything() {
  OverlayParts parts;
  parts.tripod = true;
  parts.scale_bar = ScaleBar{20.0, 60.0, "20 Å"};
  parts.marks.push_back({Vec3(2, 3, 4), 3.0, Vec4f(1.0F, 0.0F, 1.0F, 1.0F), "vacancy, 7 atoms"});
  parts.marks.push_back({Vec3(-7, -3, -5), 0.0, Vec4f(0.0F, 0.6F, 0.6F, 1.0F), "point"});
  parts.lines.push_back({Vec3(2, 3, 4), Vec3(-7, -3, -5), "14.071 Å"});
  return parts;
}

TEST(Overlay, TheRingIsWhereTheSphereIs) {
  const Camera camera = camera_of(Projection::parallel);
  OverlayParts parts;
  parts.marks.push_back({Vec3(1, 2, 3), 4.0, Vec4f(1.0F, 0.0F, 0.0F, 1.0F), ""});
  Image image(camera.width, camera.height);
  draw_overlay(image, 0, camera, Material{}, Vec4f(1.0F), parts);
  const CanvasPoint middle = *canvas_point(camera, Vec3(1, 2, 3));
  const double radius = 4.0 / camera.pixel;
  int red = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const Vec4f& pixel = image.at(column, row);
      const double off = glm::length(CanvasPoint(column + 0.5, row + 0.5) - middle) - radius;
      if (std::abs(off) > 4.0) {
        EXPECT_EQ(pixel.a, 0.0F);
      }
      if (std::abs(off) < 0.4) {
        EXPECT_GT(pixel.r, pixel.g + 0.5F);
      }
      red += pixel.r > pixel.g + 0.5F ? 1 : 0;
    }
  }
  EXPECT_GT(red, 2 * static_cast<int>(radius));
}

TEST(Overlay, BandsMakeThePicture) {
  Material material;
  UnitCell cell;
  cell.primitive = {Vec3(3, 0, 0), Vec3(1, 3, 0), Vec3(0, 0, 4)};
  material.unit_cell = cell;
  for (const Vec4f& background : {Vec4f(1.0F), Vec4f(0.0F, 0.0F, 0.0F, 1.0F), Vec4f(0.0F)}) {
    const Camera camera = camera_of(Projection::perspective, 400, 300);
    Image whole(400, 300);
    draw_overlay(whole, 0, camera, material, background, everything());
    Image together(400, 300);
    for (int first = 0; first < 300; first += 41) {
      Image band(400, std::min(41, 300 - first));
      draw_overlay(band, first, camera, material, background, everything());
      std::copy(band.pixels.begin(), band.pixels.end(), together.pixels.begin() + 400 * first);
    }
    EXPECT_EQ(whole.pixels, together.pixels);
  }
}

TEST(Overlay, WhatIsBehindTheEyeIsLeftOut) {
  const Camera camera = camera_of(Projection::perspective);
  OverlayParts parts;
  parts.marks.push_back({camera.eye - 5.0 * camera.forward, 1.0, Vec4f(1.0F), "behind"});
  parts.lines.push_back({camera.eye - 5.0 * camera.forward, Vec3(0.0), "half behind"});
  Image image(camera.width, camera.height);
  draw_overlay(image, 0, camera, Material{}, Vec4f(1.0F), parts);
  EXPECT_EQ(image.pixels, Image(camera.width, camera.height).pixels);
}

TEST(Overlay, PicksAreRingsAndTheWayBetween) {
  Material material = test::atoms_material({{"Na", Vec3(1, 1, 1)}, {"Cl", Vec3(9, 1, 1)}});
  material.atoms.box.vectors = {Vec3(10, 0, 0), Vec3(0, 10, 0), Vec3(0, 0, 10)};
  material.atoms.box.periodic = {true, true, true};
  Parameters parameters;
  parameters.atoms.scale = 0.5;
  parameters.atoms.radii["Cl"] = 3.0;
  OverlayParts parts;
  add_picks(parts, {pick_atom(material, 0), pick_atom(material, 1)}, material, parameters);
  ASSERT_EQ(parts.marks.size(), 2U);
  EXPECT_EQ(parts.marks[0].text, "Na 1");
  EXPECT_DOUBLE_EQ(parts.marks[0].radius, 0.5 * material.atoms.species_table[0].radius);
  EXPECT_DOUBLE_EQ(parts.marks[1].radius, 1.5);
  ASSERT_EQ(parts.lines.size(), 1U);
  EXPECT_EQ(parts.lines[0].to, Vec3(-1, 1, 1));
  EXPECT_EQ(parts.lines[0].text, "2.000 Å through the boundary");
}

// With ATOMESH_PICTURES the pictures are written there, to be looked at.
TEST(Overlay, GoesWithThePicturesSize) {
  Material material = test::box_material(4, 3, 2, 5.0);
  for (const int width : {240, 800, 2400}) {
    const Camera camera = camera_of(Projection::perspective, width, width * 3 / 4);
    Image image(width, width * 3 / 4);
    draw_overlay(image, 0, camera, material, Vec4f(1.0F), everything());
    const auto drawn =
        std::count_if(image.pixels.begin(), image.pixels.end(), [](const Vec4f& p) { return p.a > 0.5F; });
    // The share of the picture is about the same at every size (the least size of text makes small ones fuller).
    EXPECT_GT(static_cast<double>(drawn) / static_cast<double>(image.pixels.size()), 0.015);
    EXPECT_LT(static_cast<double>(drawn) / static_cast<double>(image.pixels.size()), 0.12);
    const char* folder = std::getenv("ATOMESH_PICTURES");
    if (folder == nullptr) continue;
    const std::array<std::pair<const char*, Vec4f>, 3> backgrounds{
        {{"white", Vec4f(1.0F)}, {"dark", Vec4f(0.1F, 0.1F, 0.15F, 1.0F)}, {"none", Vec4f(1.0F, 1.0F, 1.0F, 0.0F)}}};
    for (const auto& [name, background] : backgrounds) {
      Image picture(image.width, image.height);
      std::fill(picture.pixels.begin(), picture.pixels.end(), background);
      draw_overlay(picture, 0, camera, material, background, everything());
      write_png(std::string(folder) + "/overlay-" + std::to_string(width) + "-" + name + ".png", picture);
    }
  }
}

}  // namespace
}  // namespace atomesh::gui
