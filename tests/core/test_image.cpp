#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/image.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

Image random_image(int width, int height, bool opaque, unsigned seed = 1) {
  std::mt19937 random(seed);
  Image image(width, height);
  for (Vec4f& pixel : image.pixels) {
    for (int c = 0; c < 4; ++c) pixel[c] = static_cast<float>(random() % 256) / 255.0F;
    if (opaque) pixel.w = 1.0F;
  }
  return image;
}

TEST(Compare, KnownDifferences) {
  Image a(2, 2);
  Image b(2, 2);
  b.at(1, 0) = Vec4f(0.5F, 0, 0, 0);
  b.at(0, 1) = Vec4f(0, 0, 0, 0.25F);
  const ImageDifference d = compare_images(a, b, 0.25);
  EXPECT_DOUBLE_EQ(d.max, 0.5);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt((0.25 + 0.0625) / 16.0));
  EXPECT_DOUBLE_EQ(d.psnr, -20.0 * std::log10(d.rmse));
  EXPECT_EQ(d.pixels_over, 1U);  // 0.25 is not above 0.25
  EXPECT_EQ(compare_images(a, b).pixels_over, 2U);
  EXPECT_TRUE(std::isinf(compare_images(a, a).psnr));
  EXPECT_EQ(compare_images(a, a).max, 0.0);
  EXPECT_EQ(compare_images(Image(), Image()).rmse, 0.0);
}

TEST(Compare, NotANumberDiffersFromEverything) {
  Image a(1, 1);
  Image b(1, 1);
  b.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compare_images(a, b, 0.5).pixels_over, 1U);
  EXPECT_EQ(compare_images(b, b).max, 1.0);
}

TEST(Compare, SizesMustAgree) {
  try {
    compare_images(Image(3, 2), Image(2, 3));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("3x2 and 2x3"), std::string::npos);
  }
  EXPECT_THROW(difference_picture(Image(1, 1), Image(1, 2)), Error);
}

TEST(Compare, DifferencePictureIsBlackWhereEqualAndShowsOpacity) {
  Image a(3, 1);
  Image b(3, 1);
  b.at(1, 0) = Vec4f(0.1F, 0, 0, 0);
  b.at(2, 0) = Vec4f(0, 0, 0, 1);
  const Image picture = difference_picture(a, b, 5.0);
  EXPECT_EQ(picture.at(0, 0), Vec4f(0, 0, 0, 1));
  EXPECT_NEAR(picture.at(1, 0).x, 0.5F, 1e-6F);
  EXPECT_EQ(picture.at(1, 0).y, 0.0F);
  EXPECT_EQ(picture.at(2, 0), Vec4f(1, 1, 1, 1));
}

TEST(Png, EightBitPicturesComeBackExactly) {
  const TemporaryFolder folder;
  for (const bool opaque : {true, false}) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(7, 3), std::pair(64, 65)}) {
      const Image image = random_image(width, height, opaque);
      write_png(folder.file("a.png"), image);
      const Image back = read_png(folder.file("a.png"));
      ASSERT_EQ(back.width, width);
      ASSERT_EQ(back.height, height);
      EXPECT_EQ(back.pixels, image.pixels);
    }
  }
  const std::string bytes = read_bytes(folder.file("a.png"));
  EXPECT_EQ(bytes[25], 6);  // colour type: RGBA, as the last one was not opaque
  write_png(folder.file("a.png"), random_image(2, 2, true));
  EXPECT_EQ(read_bytes(folder.file("a.png"))[25], 2);  // RGB
  EXPECT_EQ(folder.count(), 1U);
}

TEST(Png, ChannelsAreRoundedToTheNearestAndClamped) {
  const TemporaryFolder folder;
  Image image(5, 1);
  image.at(0, 0) = Vec4f(0.49F / 255.0F, 0.51F / 255.0F, 254.49F / 255.0F, 1);
  image.at(1, 0) = Vec4f(254.51F / 255.0F, 127.4F / 255.0F, 127.6F / 255.0F, 1);
  image.at(2, 0) = Vec4f(-3, 7, std::numeric_limits<float>::quiet_NaN(), 1);
  image.at(3, 0) = Vec4f(std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0, 1);
  write_png(folder.file("a.png"), image);
  const Image back = read_png(folder.file("a.png"));
  const auto byte = [&](int column, int channel) { return std::lround(back.at(column, 0)[channel] * 255.0F); };
  EXPECT_EQ(byte(0, 0), 0);
  EXPECT_EQ(byte(0, 1), 1);
  EXPECT_EQ(byte(0, 2), 254);
  EXPECT_EQ(byte(1, 0), 255);
  EXPECT_EQ(byte(1, 1), 127);
  EXPECT_EQ(byte(1, 2), 128);
  EXPECT_EQ(byte(2, 0), 0);
  EXPECT_EQ(byte(2, 1), 255);
  EXPECT_EQ(byte(2, 2), 0);
  EXPECT_EQ(byte(3, 0), 255);
  EXPECT_EQ(byte(3, 1), 0);
}

TEST(Png, TextsComeBackInOrder) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> text{
      {"Software", "atomesh"}, {"mode", "xray"}, {"note", "α = 0.25 1/Å\nsecond line"}, {"empty", ""}};
  write_png(folder.file("a.png"), random_image(3, 3, true), text);
  EXPECT_EQ(read_png_text(folder.file("a.png")), text);
  EXPECT_EQ(read_png(folder.file("a.png")).width, 3);
  EXPECT_THROW(write_png(folder.file("b.png"), Image(1, 1), {{std::string(80, 'k'), "v"}}), Error);
  EXPECT_THROW(write_png(folder.file("b.png"), Image(1, 1), {{"", "v"}}), Error);
  EXPECT_THROW(write_png(folder.file("b.png"), Image(1, 1), {{"k", std::string("a\0b", 3)}}), Error);
  EXPECT_EQ(folder.count(), 1U);
}

TEST(Png, TextsAreReadWithoutThePixels) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.png");
  write_png(file, random_image(9, 9, true), {{"key", "value"}, {"more", std::string(100'000, 'x')}});
  const std::string bytes = read_bytes(file);
  EXPECT_TRUE(is_png_file(file));

  // The pixels' checksum is wrong, which only who reads them notices.
  std::string damaged = bytes;
  damaged[damaged.find("IDAT") + 6] ^= 1;
  write_bytes(file, damaged);
  EXPECT_THROW(read_png(file), InputError);
  EXPECT_EQ(read_png_text(file).at(1).second.size(), 100'000U);

  // Texts after the pixels are texts too.
  const std::size_t pixels = bytes.find("IDAT") - 4;
  const std::size_t end = bytes.find("IEND") - 4;
  const std::size_t texts = bytes.find("iTXt") - 4;
  write_bytes(file, bytes.substr(0, texts) + bytes.substr(pixels, end - pixels) + bytes.substr(texts, pixels - texts) +
                        bytes.substr(end));
  EXPECT_EQ(read_png(file).width, 9);
  EXPECT_EQ(read_png_text(file).at(0).second, "value");

  for (std::size_t length = 0; length < 200; ++length) {
    write_bytes(file, bytes.substr(0, length));
    EXPECT_THROW(read_png_text(file), InputError) << length;
  }
  write_bytes(file, bytes.substr(0, bytes.size() - 1));
  EXPECT_THROW(read_png_text(file), InputError);
  std::string no_pixels = bytes;
  no_pixels.erase(pixels, end - pixels);
  write_bytes(file, no_pixels);
  EXPECT_THROW(read_png_text(file), InputError);
  write_bytes(file, "this is not a picture at all");
  EXPECT_FALSE(is_png_file(file));
  EXPECT_THROW(read_png_text(file), InputError);
}

TEST(Png, EmptyPicturesAndUnwritablePlacesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_png(folder.file("a.png"), Image()), Error);
  EXPECT_THROW(write_png(folder.file("no/such/folder/a.png"), Image(1, 1)), Error);
  EXPECT_EQ(folder.count(), 0U);
  EXPECT_THROW(read_png(folder.file("none.png")), InputError);
  write_bytes(folder.file("empty.png"), "");
  EXPECT_THROW(read_png(folder.file("empty.png")), InputError);
  write_bytes(folder.file("text.png"), "this is not a picture at all");
  EXPECT_THROW(read_png(folder.file("text.png")), InputError);
}

TEST(Png, EveryTruncationIsAnInputError) {
  const TemporaryFolder folder;
  write_png(folder.file("a.png"), random_image(9, 9, false), {{"key", "value"}});
  const std::string bytes = read_bytes(folder.file("a.png"));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(parse_png(bytes.substr(0, length), "b.png"), InputError) << length;
  }
}

// PNG protects each chunk by a checksum; flips in chunks that do not matter for the picture may pass, nothing else may.
TEST(Png, EveryFlippedBitIsReadTheSameOrAnInputError) {
  const TemporaryFolder folder;
  const Image image = random_image(5, 4, true);
  write_png(folder.file("a.png"), image, {{"key", "value"}});
  const std::string bytes = read_bytes(folder.file("a.png"));
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    try {
      const Image back = parse_png(damaged, "b.png");
      EXPECT_EQ(back.pixels, image.pixels) << "bit " << bit;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, bytes.size() * 4);
}

TEST(PngWriter, RowsInPortionsAreTheWholePicture) {
  const TemporaryFolder folder;
  for (const bool opaque : {true, false}) {
    const Image image = random_image(13, 29, opaque);
    const PngText text{{"key", "värde"}};
    write_png(folder.file("whole.png"), image, text);
    PngWriter writer(folder.file("rows.png"), 13, 29, opaque, text);
    const std::span<const Vec4f> pixels(image.pixels);
    std::size_t row = 0;
    for (const std::size_t rows : {1, 0, 20, 8}) {
      writer.write_rows(pixels.subspan(13 * row, 13 * rows));
      row += rows;
    }
    writer.finish();
    EXPECT_EQ(read_bytes(folder.file("rows.png")), read_bytes(folder.file("whole.png")));
  }
}

TEST(PngWriter, WhatIsNotFinishedLeavesNothing) {
  const TemporaryFolder folder;
  const std::vector<Vec4f> row(7);
  {
    PngWriter writer(folder.file("a.png"), 7, 3, false);
    writer.write_rows(row);
    EXPECT_THROW(writer.write_rows(std::span(row).first(6)), Error);  // no whole row
    EXPECT_THROW(writer.write_rows(std::vector<Vec4f>(21)), Error);   // more than are left
    EXPECT_THROW(writer.finish(), Error);                             // two rows are missing
    Progress cancelled;
    cancelled.request_cancel();
    EXPECT_THROW(writer.write_rows(row, cancelled), CancelledError);
  }
  EXPECT_EQ(folder.count(), 0U);
  EXPECT_THROW(PngWriter(folder.file("a.png"), 65536, 1, true), Error);
  EXPECT_THROW(PngWriter(folder.file("a.png"), 1, 0, true), Error);
  EXPECT_EQ(folder.count(), 0U);
}

TEST(Png, WritingCanBeCancelledAndLeavesNothing) {
  const test::TemporaryFolder folder;
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(write_png(folder.file("a.png"), random_image(9, 9, false), {}, progress), CancelledError);
  EXPECT_EQ(folder.count(), 0U);
}

}  // namespace
}  // namespace atomesh
