#include "depth/image/depth_file.h"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <fstream>
#include <string>
#include <vector>

#include "depth/image/number_format.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::ExpectRefused;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const std::vector<uint16_t> kDepths = {0, 1, 500, 4000, 65535, 258};  // two rows of three

void Write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string BytesOf(const std::vector<uint16_t>& numbers, bool is_high_first) {
  std::string bytes;
  for (const uint16_t number : numbers) {
    const char low = static_cast<char>(number & 255), high = static_cast<char>(number >> 8);
    bytes += is_high_first ? std::string{high, low} : std::string{low, high};
  }
  return bytes;
}

struct TiffForm {
  int bits = 16;
  int kind = SAMPLEFORMAT_UINT;
  int channels = 1;
  int pages = 1;
  int compression = COMPRESSION_NONE;
};

template <typename T>
void WriteTiff(const fs::path& path, std::vector<T> numbers, const TiffForm& form) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  for (int page = 0; page < form.pages; ++page) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 3);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 2);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, form.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, form.kind);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, form.channels);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
    for (uint32_t y = 0; y < 2; ++y) {
      TIFFWriteScanline(tiff, &numbers[y * numbers.size() / 2], y);
    }
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
}

void ExpectDepths(const fs::path& path, const std::vector<uint16_t>& expected = kDepths) {
  EXPECT_TRUE(IsDepthFileName(path));
  EXPECT_FALSE(IsOtherImage(path));
  EXPECT_EQ(ReadDepthFileSize(path), (ImageSize{3, 2}));
  EXPECT_EQ(ReadDepthFile(path).data, expected);
}

TEST(PgmDepth, IsReadHighByteFirst) {
  const TemporaryFolder folder;
  Write(folder / "x.PGM", "P5 3 2 65535\n" + BytesOf(kDepths, true));
  ExpectDepths(folder / "x.PGM");
  Write(folder / "x.pgm", "P5\n# by hand\n3\t2 # sides\n4095\n" + BytesOf(kDepths, true));
  ExpectDepths(folder / "x.pgm");
}

TEST(PgmDepth, OfAFakenectDumpIsReadLowByteFirst) {
  const TemporaryFolder folder;
  Write(folder / "d-1.033333-62000000.pgm", "P5 3 2 65535\n" + BytesOf(kDepths, false));
  ExpectDepths(folder / "d-1.033333-62000000.pgm");
}

TEST(PgmDepth, OfAnotherKindIsRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& bytes, const std::string& named) {
    Write(folder / "x.pgm", bytes);
    ExpectRefused([&] { ReadDepthFile(folder / "x.pgm"); }, named);
  };
  expect("", "expected a binary PGM image");
  expect("P2 3 2 65535\n1 2 3 4 5 6", "expected a binary PGM image, P5, found 'P2'");
  expect("P5 3 2 65535\n" + BytesOf(kDepths, true).substr(1), "expected 12 bytes");
  expect("P5 3 2 255\nabcdef", "16 bits or more, found 1 of uint8");
  EXPECT_TRUE(IsOtherImage(folder / "x.pgm"));
  expect("P5 0 2 65535\n", "width");
  expect("P5 3 99999 65535\n", "height");
  expect("P5 3", "expected a binary PGM image, found a header that is cut short");
  expect("P5 # no end", "found a header that is cut short");
}

TEST(TiffDepth, OfIntegersIsReadInAnyCompression) {
  const TemporaryFolder folder;
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
    WriteTiff(folder / "x.tif", kDepths, {.compression = compression});
    ExpectDepths(folder / "x.tif");
  }
  WriteTiff(folder / "x.tiff", std::vector<int32_t>{-1, 1, 500, 4000, 65536, 258},
            {.bits = 32, .kind = SAMPLEFORMAT_INT});
  ExpectDepths(folder / "x.tiff", {0, 1, 500, 4000, 0, 258});
}

TEST(TiffDepth, OfFloatsIsMetresOrMillimetresByItsRange) {
  const TemporaryFolder folder;
  const float none = std::numeric_limits<float>::quiet_NaN();
  WriteTiff(folder / "x.tif", std::vector<float>{none, 0.6F, 1.2345F, 4.0F, 1e10F, 2.0F},
            {.bits = 32, .kind = SAMPLEFORMAT_IEEEFP});
  ExpectDepths(folder / "x.tif", {0, 600, 1235, 4000, 0, 2000});
  WriteTiff(folder / "x.tif", std::vector<double>{none, 600, 1234.5, 4000, -1, 2000},
            {.bits = 64, .kind = SAMPLEFORMAT_IEEEFP});
  ExpectDepths(folder / "x.tif", {0, 600, 1235, 4000, 0, 2000});
}

TEST(TiffDepth, OfAnotherKindIsRefused) {
  const TemporaryFolder folder;
  const fs::path path = folder / "x.tif";
  const auto expect = [&](const std::string& named) {
    ExpectRefused([&] { ReadDepthFile(path); }, named);
  };
  WriteTiff(path, std::vector<uint8_t>(18), {.bits = 8, .channels = 3});
  expect("16 bits or more, found 3 of uint8");
  EXPECT_TRUE(IsOtherImage(path));
  WriteTiff(path, kDepths, {.pages = 2});
  expect("found several pages");
  WriteTiff(path, kDepths, {});
  fs::resize_file(path, fs::file_size(path) - 20);
  expect("x.tif: ");
  Write(path, "II*");
  expect("expected a TIFF image");
  EXPECT_FALSE(IsOtherImage(path));
}

TEST(DepthFiles, AreKnownByTheirNames) {
  for (const char* name : {"a.png", "a.PNG", "a.pgm", "a.tif", "a.TIFF", "a.npy"}) {
    EXPECT_TRUE(IsDepthFileName(name)) << name;
  }
  for (const char* name : {"._a.png", "a.jpg", "a.npz", "png"}) {
    EXPECT_FALSE(IsDepthFileName(name)) << name;
  }
}

TEST(NumberFormats, HaveNumpysNames) {
  EXPECT_EQ(NameOf({NumberKind::kUnsigned, 2, true}), "uint16");
  EXPECT_EQ(NameOf({NumberKind::kSigned, 8, false}), "int64");
  EXPECT_EQ(NameOf({NumberKind::kFloat, 4, false}), "float32");
}

TEST(NumberFormats, OfHalfFloatsAreReadToTheirPrecision) {
  const std::vector<uint8_t> bytes = {0x00, 0x3c, 0x00, 0x42, 0x00, 0x7c, 0x00, 0xc0};
  const NumberFormat half{NumberKind::kFloat, 2, false};
  EXPECT_EQ(DepthsOf(half, bytes, 1000), (std::vector<uint16_t>{1000, 3000, 0, 0}));
  EXPECT_EQ(GuessUnit_mm(half, bytes), 1000);
  EXPECT_EQ(GuessUnit_mm(half, std::vector<uint8_t>{0, 0, 0, 0x7c}), std::nullopt);
}

}  // namespace
}  // namespace ossa::depth
