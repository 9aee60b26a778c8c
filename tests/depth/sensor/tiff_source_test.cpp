// TIFF files of several pages.
#include <gtest/gtest.h>
#include <tiffio.h>

#include <fstream>
#include <iterator>
#include <string>

#include "depth/image/camera_io.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/support/depth_examples.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::FramesOf;
using test::TemporaryFolder;

std::vector<uint16_t> PageDepths(int i) { return test::ExampleFrame(i).depth_mm; }

// Adds a page of one row a strip.
template <typename T>
void AddPage(TIFF* tiff, std::vector<T> numbers, size_t width, uint16_t kind) {
  const size_t height = numbers.size() / width;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * sizeof(T));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
  for (size_t y = 0; y < height; ++y) {
    TIFFWriteScanline(tiff, &numbers[y * width], static_cast<uint32_t>(y));
  }
  TIFFWriteDirectory(tiff);
}

// Three images, behind the first a smaller one.
void WritePages(const std::filesystem::path& path) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  AddPage(tiff, PageDepths(0), 32, SAMPLEFORMAT_UINT);
  AddPage(tiff, std::vector<uint16_t>(12, 1000), 4, SAMPLEFORMAT_UINT);
  AddPage(tiff, PageDepths(1), 32, SAMPLEFORMAT_UINT);
  AddPage(tiff, PageDepths(2), 32, SAMPLEFORMAT_UINT);
  TIFFClose(tiff);
}

TEST(TiffPages, AreARecording) {
  const TemporaryFolder folder;
  WritePages(folder / "x.TIFF");
  const auto source = OpenSource(folder / "x.TIFF");
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->frame_count(), 3);
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 3u);
  for (const int i : {0, 1, 2}) EXPECT_EQ(frames[static_cast<size_t>(i)].depth_mm, PageDepths(i));
  EXPECT_EQ(frames[2].time_s, 2.0 / 30.0);
}

TEST(TiffPages, OfFloatsAreMetres) {
  const TemporaryFolder folder;
  TIFF* tiff = TIFFOpen((folder / "x.tif").c_str(), "w");
  for (const int i : {0, 1}) {
    std::vector<float> metres;
    for (const uint16_t depth : PageDepths(i))
      metres.push_back(static_cast<float>(depth) / 1000.0F);
    AddPage(tiff, metres, 32, SAMPLEFORMAT_IEEEFP);
  }
  TIFFClose(tiff);
  const auto frames = FramesOf(*OpenSource(folder / "x.tif"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].depth_mm, PageDepths(1));
}

TEST(TiffPages, HaveTheCameraBesideThem) {
  const TemporaryFolder folder;
  WritePages(folder / "x.tif");
  WriteCameraJson(folder / "camera.json",
                  {.width = 32, .height = 24, .fx = 77, .fy = 77, .cx = 16, .cy = 12});
  EXPECT_EQ(OpenSource(folder / "x.tif")->camera().fx, 77.0);
}

TEST(TiffPages, ThatAreDamagedAreSkippedWithAWarning) {
  const TemporaryFolder folder;
  WritePages(folder / "x.tif");
  std::ifstream file(folder / "x.tif", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (size_t i = 8; i < 300; ++i) bytes[i] = '\x55';  // of the first page's rows
  test::WriteBytes(folder / "x.tif", bytes);
  test::Notes notes;
  const auto frames = FramesOf(*OpenSource(folder / "x.tif", notes.Options()));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].index, 1);
  EXPECT_EQ(frames[0].depth_mm, PageDepths(1));
  EXPECT_TRUE(notes.Tell("skipped 1 of 3 pages that cannot be read, the first: page 0: "));
}

TEST(TiffPages, InAFolderOfImagesAreRefused) {
  const TemporaryFolder folder;
  WritePages(folder / "0.tif");
  test::ExpectRefused([&] { FramesOf(*OpenSource(folder.path())); },
                      "found several pages: as a SOURCE of its own it is a recording");
}

}  // namespace
}  // namespace ossa::depth
