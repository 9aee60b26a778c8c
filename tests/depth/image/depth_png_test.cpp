#include "depth/image/depth_png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <functional>
#include <random>

#include "depth/base/error.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::TemporaryFolder;

Image<uint16_t> NoiseImage(int width, int height) {
  Image<uint16_t> image(width, height);
  std::mt19937 random(7);
  for (uint16_t& value : image.data) value = static_cast<uint16_t>(random());
  return image;
}

DepthView ViewOf(const Image<uint16_t>& image) {
  return {image.data.data(), image.width, image.height, image.width};
}

std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(DepthPng, RoundTripIsExactForAll65536Values) {
  const TemporaryFolder folder;
  Image<uint16_t> image(256, 256);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<uint16_t>(i);
  WriteDepthPng(folder / "x.png", ViewOf(image));
  EXPECT_EQ(ReadDepthPng(folder / "x.png").data, image.data);
  EXPECT_EQ(ReadDepthPngSize(folder / "x.png"), (ImageSize{256, 256}));
}

TEST(DepthPng, WritesAViewIntoALargerImage) {
  const TemporaryFolder folder;
  const auto image = NoiseImage(20, 10);
  WriteDepthPng(folder / "x.png", {image.data.data() + 23, 5, 4, 20});
  const auto back = ReadDepthPng(folder / "x.png");
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.at(4, 3), image.at(7, 4));
}

TEST(LabelPng, RoundTripIsExact) {
  const TemporaryFolder folder;
  Image<uint8_t> labels(17, 16);
  for (size_t i = 0; i < labels.data.size(); ++i) labels.data[i] = static_cast<uint8_t>(i);
  WriteLabelPng(folder / "x.png", labels);
  EXPECT_EQ(ReadLabelPng(folder / "x.png").data, labels.data);
}

TEST(LabelPng, IsRefusedAsADepthImage) {
  const TemporaryFolder folder;
  WriteLabelPng(folder / "x.png", Image<uint8_t>(4, 4));
  try {
    ReadDepthPng(folder / "x.png");
    FAIL() << "8 bits were read as 16";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("x.png: byte 24: expected one channel of 16 bits"),
              std::string::npos)
        << error.what();
  }
}

struct Damage {
  const char* name;
  std::function<void(std::string&)> apply;
  const char* message;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

// IHDR with another size, its checksum made right again: only the size is wrong.
void SetWidth(std::string& bytes, uint32_t width) {
  for (size_t i = 0; i < 4; ++i) bytes[16 + i] = static_cast<char>(width >> (24 - 8 * i));
  const auto* header = reinterpret_cast<const Bytef*>(bytes.data() + 12);
  const auto crc = static_cast<uint32_t>(crc32(0, header, 17));
  for (size_t i = 0; i < 4; ++i) bytes[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
}

class DamagedPng : public testing::TestWithParam<Damage> {};

TEST_P(DamagedPng, IsRefusedInOneLineWithFileAndPlace) {
  const TemporaryFolder folder;
  const auto path = folder / "bad.png";
  WriteDepthPng(path, ViewOf(NoiseImage(64, 48)));
  std::string bytes = Bytes(path);
  GetParam().apply(bytes);
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    ReadDepthPng(path);
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind(path.string() + ": byte ", 0), 0u) << message;
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    EachWay, DamagedPng,
    testing::Values(
        Damage{"empty", [](std::string& b) { b.clear(); }, "expected a PNG"},
        Damage{"signature", [](std::string& b) { b[1] = 'X'; }, "expected a PNG"},
        Damage{"cut in the header", [](std::string& b) { b.resize(20); }, "IHDR"},
        Damage{"cut in the pixels", [](std::string& b) { b.resize(b.size() / 2); }, "cut short"},
        Damage{"cut before the end mark", [](std::string& b) { b.resize(b.size() - 12); },
               "cut short"},
        Damage{"a flipped bit", [](std::string& b) { b[b.size() / 2] ^= 4; }, "whole PNG"},
        Damage{"no width", [](std::string& b) { SetWidth(b, 0); }, "found 0x48"},
        Damage{"absurd width", [](std::string& b) { SetWidth(b, 0x7fffffff); }, "8192x8192"},
        Damage{"more pixels than it can hold", [](std::string& b) { SetWidth(b, 8192); }, ":"}),
    [](const auto& info) {
      std::string name = info.param.name;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

TEST(DepthPng, MissingFileIsNamed) {
  EXPECT_THROW(ReadDepthPng("/nowhere/x.png"), InputError);
  EXPECT_THROW(ReadDepthPng("/"), InputError);
}

}  // namespace
}  // namespace ossa::depth
