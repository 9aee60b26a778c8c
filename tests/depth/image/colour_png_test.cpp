#include "depth/image/colour_png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <stdexcept>

namespace ossa::depth {
namespace {

// Decodes it with libpng's own simple reader.
std::vector<uint8_t> Read(const std::vector<uint8_t>& png, uint32_t format, ImageSize* size) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  image.format = format;
  *size = {static_cast<int>(image.width), static_cast<int>(image.height)};
  std::vector<uint8_t> samples(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, samples.data(), 0, nullptr), 0) << image.message;
  return samples;
}

std::vector<uint8_t> Gradient(size_t count) {
  std::vector<uint8_t> samples(count);
  for (size_t i = 0; i < count; ++i) samples[i] = static_cast<uint8_t>(37 * i);
  return samples;
}

TEST(ColourPng, RoundTripIsExact) {
  const std::vector<uint8_t> rgb = Gradient(5 * 3 * 3);
  ImageSize size;
  EXPECT_EQ(Read(EncodeColourPng(rgb, {5, 3}, 3), PNG_FORMAT_RGB, &size), rgb);
  EXPECT_EQ(size, (ImageSize{5, 3}));
}

TEST(ColourPng, KeepsTransparency) {
  const std::vector<uint8_t> rgba = Gradient(4 * 2 * 4);
  ImageSize size;
  EXPECT_EQ(Read(EncodeColourPng(rgba, {4, 2}, 4), PNG_FORMAT_RGBA, &size), rgba);
}

TEST(ColourPng, RefusesSamplesThatDoNotFillTheImage) {
  EXPECT_THROW(EncodeColourPng(Gradient(10), {5, 3}, 3), std::invalid_argument);
  EXPECT_THROW(EncodeColourPng(Gradient(30), {5, 3}, 2), std::invalid_argument);
}

}  // namespace
}  // namespace ossa::depth
