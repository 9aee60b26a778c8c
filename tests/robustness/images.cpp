// Apart from recordings.cpp: libtiff's macros are names of rosbag's.
#include <tiffio.h>

#include <fstream>
#include <iterator>

#include "tests/robustness/recordings.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::test {
namespace {

// Netpbm's image of 20 x 16.
DamageSample Pgm() {
  std::string bytes = "P5 20 16 65535\n";
  for (const uint16_t depth : ExampleFrame(0, 20, 16).depth_mm) {
    bytes += {static_cast<char>(depth >> 8), static_cast<char>(depth & 255)};
  }
  return {"x.pgm", bytes, ReadRecording};
}

DamageSample Tiff() {
  const TemporaryFolder folder;
  depth::DepthFrame frame = ExampleFrame(0, 20, 16);
  TIFF* tiff = TIFFOpen((folder / "x.tif").c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 20);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 16);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  for (uint32_t y = 0; y < 16; ++y) TIFFWriteScanline(tiff, &frame.depth_mm[size_t{20} * y], y);
  TIFFClose(tiff);
  std::ifstream file(folder / "x.tif", std::ios::binary);
  return {"x.tif", {std::istreambuf_iterator<char>(file), {}}, ReadRecording};
}

}  // namespace

std::vector<DamageSample> PlainImages() { return {Pgm(), Tiff()}; }

}  // namespace ossa::test
