// Text in pictures: measures known from the font, coverage that adds up, bands that are the whole.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "render/text_raster.h"

namespace atomesh {
namespace {

const Vec4f white(1.0F);
const Vec4f black(0.0F, 0.0F, 0.0F, 1.0F);

Image plain(int width, int height, const Vec4f& color) {
  Image image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), color);
  return image;
}

// Pixels' worth of ink on white.
double ink(const Image& image) {
  double sum = 0.0;
  for (const Vec4f& pixel : image.pixels) sum += 1.0 - static_cast<double>(pixel.r);
  return sum;
}

// DejaVu Sans has 2048 units to the em: a digit is 1303 wide, a space 651.
TEST(Text, WidthsAreTheFonts) {
  EXPECT_NEAR(measure_text("0", 2048.0 / 4.0).width, 1303.0 / 4.0, 1e-9);
  EXPECT_NEAR(measure_text("31415", 16.0).width, 5 * 1303.0 / 128.0, 1e-9);
  EXPECT_NEAR(measure_text(" ", 16.0).width, 651.0 / 128.0, 1e-9);
  EXPECT_EQ(measure_text("", 16.0).width, 0.0);
  EXPECT_NEAR(measure_text("Å", 20.0).width, measure_text("A", 20.0).width, 1e-9);
}

TEST(Text, GrowsInProportion) {
  double before = 0.0;
  for (double size = 5.0; size <= 200.0; size += 0.75) {
    const TextExtent extent = measure_text("thickness, Å", size);
    EXPECT_GT(extent.width, before);
    EXPECT_NEAR(extent.width / size, measure_text("thickness, Å", 100.0).width / 100.0, 1e-9);
    EXPECT_NEAR(extent.ascent / size, 0.729, 1e-9);
    before = extent.width;
  }
}

TEST(Text, TheFontHasWhatLegendsSay) {
  for (const char32_t character : std::u32string_view(U"AZaz09 .,:;%()[]/+<>=−×·Å°µαβσ²³¹⁰⁴⁵⁶⁷⁸⁹⁻₀₉≥≤…–→ÄÖÜäöüßéΣΔ")) {
    EXPECT_TRUE(has_glyph(character)) << static_cast<std::uint32_t>(character);
  }
  EXPECT_FALSE(has_glyph(U'\U00020000'));
}

// A dash is a rectangle: as much ink as its area, wherever between the pixels it starts.
TEST(Text, CoverageIsArea) {
  for (const double x : {10.0, 10.3, 10.5, 10.9}) {
    Image image = plain(120, 80, white);
    Canvas canvas(image);
    draw_text(canvas, "—", x, 60.0, 64.0, black);
    // U+2014 in DejaVu Sans: 2048 units wide, 150 high; a fitted line may be a little higher or lower.
    EXPECT_NEAR(ink(image), 64.0 * 64.0 * 150.0 / 2048.0, 64.0) << x;
  }
}

TEST(Text, StandsWhereItIsMeasured) {
  const double size = 40.0;
  const TextExtent extent = measure_text("HIJÅ·10⁻³ gp", size);
  Image image = plain(500, 100, white);
  Canvas canvas(image);
  draw_text(canvas, "HIJÅ·10⁻³ gp", 20.0, 60.0, size, black);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (image.at(column, row).r > 0.9F) continue;
      EXPECT_GE(column, 19);
      EXPECT_LE(column, 20.0 + extent.width + 1.0);
      EXPECT_LE(row, 60.0 + extent.descent + 1.0);
      EXPECT_GE(row, 60.0 - 1.35 * extent.ascent);  // the ring of Å
    }
  }
  // The H: its stems reach from the baseline to the ascent.
  int top = image.height;
  int bottom = -1;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 20; column < 40; ++column) {
      if (image.at(column, row).r > 0.5F) continue;
      top = std::min(top, row);
      bottom = std::max(bottom, row);
    }
  }
  EXPECT_EQ(bottom, 59);
  EXPECT_NEAR(top, 60.0 - extent.ascent, 1.0);
}

TEST(Text, ColorsOverAnything) {
  Image image(60, 40);  // transparent
  Canvas canvas(image);
  const Vec4f red(1.0F, 0.0F, 0.0F, 1.0F);
  draw_text(canvas, "█", 5.0, 30.0, 30.0, red);  // a full block
  EXPECT_EQ(image.at(12, 20), red);
  EXPECT_EQ(image.at(55, 5), Vec4f(0.0F));
  // Half transparent over opaque: halfway between.
  Image gray = plain(60, 40, Vec4f(0.5F, 0.5F, 0.5F, 1.0F));
  Canvas over(gray);
  draw_text(over, "█", 5.0, 30.0, 30.0, Vec4f(1.0F, 0.0F, 0.0F, 0.5F));
  EXPECT_NEAR(gray.at(12, 20).r, 0.75F, 1e-6);
  EXPECT_NEAR(gray.at(12, 20).g, 0.25F, 1e-6);
  EXPECT_EQ(gray.at(12, 20).a, 1.0F);
}

TEST(Text, BandsAreTheWhole) {
  const auto draw = [](Canvas& canvas) {
    canvas.fill_rounded({3, 4, 150, 55}, 9.5, Vec4f(1.0F, 1.0F, 0.8F, 0.7F));
    canvas.frame({10, 10, 100, 40}, 3, Vec4f(0.2F, 0.0F, 0.4F, 0.5F));
    draw_text(canvas, "Ångström gpq", -7.3, 37.0, 31.0, black);
  };
  Image whole(130, 64);
  Canvas canvas(whole);
  draw(canvas);
  for (const int rows : {1, 7, 64}) {
    for (int first = 0; first < whole.height; first += rows) {
      Image band(whole.width, std::min(rows, whole.height - first));
      Canvas part(band, first);
      draw(part);
      for (std::size_t i = 0; i < band.pixels.size(); ++i) {
        ASSERT_EQ(band.pixels[i], whole.pixels[i + static_cast<std::size_t>(first * whole.width)]);
      }
    }
  }
}

TEST(Text, SizesThatCannotBe) {
  Image image(8, 8);
  Canvas canvas(image);
  for (const double size : {0.0, -3.0, 0.5, 1001.0, std::nan("")}) {
    EXPECT_THROW(measure_text("a", size), UsageError);
    EXPECT_THROW(draw_text(canvas, "a", 0.0, 5.0, size, black), UsageError);
  }
  draw_text(canvas, "\xFF\xC3", 0.0, 5.0, 6.0, black);  // no UTF-8: boxes
  draw_text(canvas, "far away", 1e6, -1e6, 6.0, black);
}

TEST(Canvas, DiscsHaveTheirArea) {
  Image image = plain(100, 100, white);
  Canvas canvas(image);
  canvas.fill_rounded({10, 10, 90, 90}, 40.0, black);
  EXPECT_NEAR(ink(image), std::numbers::pi * 40.0 * 40.0, 10.0);
  EXPECT_EQ(image.at(50, 50), black);
  EXPECT_EQ(image.at(12, 12), white);
}

TEST(Canvas, FramesStandAround) {
  Image image = plain(20, 20, white);
  Canvas canvas(image);
  canvas.frame({5, 5, 15, 15}, 2, black);
  EXPECT_NEAR(ink(image), 14 * 14 - 10 * 10, 1e-5);
  EXPECT_EQ(image.at(5, 5), white);
  EXPECT_EQ(image.at(4, 4), black);
}

}  // namespace
}  // namespace atomesh
