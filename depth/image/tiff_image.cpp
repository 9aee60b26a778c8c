#include <tiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <memory>

#include "depth/base/error.h"
#include "depth/image/camera.h"
#include "depth/image/image_bytes_internal.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

// Keeps the first error of libtiff, which would print it.
int KeepError(TIFF*, void* kept, const char*, const char* format, va_list arguments) {
  auto& text = *static_cast<std::string*>(kept);
  if (!text.empty()) return 1;
  std::array<char, 200> line{};  // characters, by hand
  vsnprintf(line.data(), line.size(), format, arguments);
  text = line.data();
  return 1;
}

int KeepNoWarning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

// A TIFF file at one of its pages, first the first.
class TiffFile {
 public:
  explicit TiffFile(const std::filesystem::path& path) : name_(path.string()) {
    ReadImageBytes(path, 0);  // throws for what is no file, or too large
    std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), KeepError, &error_);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), KeepNoWarning, nullptr);
    // m: without a memory map, which another program's truncation makes fatal.
    tiff_.reset(TIFFOpenExt(path.c_str(), "rm", options.get()));
    if (!tiff_) Refuse("expected a TIFF image");
  }

  NumberImage ReadHeader() {
    NumberImage image;
    const auto width = Required(TIFFTAG_IMAGEWIDTH), height = Required(TIFFTAG_IMAGELENGTH);
    if (width < 1 || width > kLargestImageSide || height < 1 || height > kLargestImageSide) {
      Refuse("expected sides of 1 to " + std::to_string(kLargestImageSide) + " pixels, found " +
             std::to_string(width) + "x" + std::to_string(height));
    }
    image.size = {static_cast<int>(width), static_cast<int>(height)};
    image.channels = Short(TIFFTAG_SAMPLESPERPIXEL);
    image.format.size = (Short(TIFFTAG_BITSPERSAMPLE) + 7) / 8;
    const int kind = Short(TIFFTAG_SAMPLEFORMAT);
    image.format.kind = kind == SAMPLEFORMAT_IEEEFP ? NumberKind::kFloat
                        : kind == SAMPLEFORMAT_INT  ? NumberKind::kSigned
                                                    : NumberKind::kUnsigned;
    return image;
  }

  // The rows of an image whose header was read. Precondition: one channel.
  void ReadRows(NumberImage& image) {
    const int bits = Short(TIFFTAG_BITSPERSAMPLE);
    if (bits != 8 * image.format.size || (bits != 16 && bits != 32 && bits != 64)) {
      Refuse("expected 16, 32 or 64 bits a pixel, found " + std::to_string(bits));
    }
    if (TIFFIsTiled(tiff_.get()) != 0) Refuse("expected rows, found tiles");
    const size_t row = static_cast<size_t>(image.size.width) * static_cast<size_t>(bits / 8);
    if (static_cast<size_t>(TIFFScanlineSize(tiff_.get())) != row) Refuse("expected whole rows");
    image.numbers.resize(row * static_cast<size_t>(image.size.height));
    for (int y = 0; y < image.size.height; ++y) {
      uint8_t* into = &image.numbers[row * static_cast<size_t>(y)];
      if (TIFFReadScanline(tiff_.get(), into, static_cast<uint32_t>(y)) != 1) {
        Refuse("damaged in row " + std::to_string(y));
      }
    }
  }

  // The next page; false behind the last one.
  bool GoOn() {
    error_.clear();
    return TIFFReadDirectory(tiff_.get()) != 0;
  }
  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(name_ + ": " + what + (error_.empty() ? "" : " (" + error_ + ")"));
  }

 private:
  uint32_t Required(uint32_t tag) {
    uint32_t value = 0;
    TIFFGetField(tiff_.get(), tag, &value);
    return value;
  }
  int Short(uint32_t tag) {
    uint16_t value = 1;
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }

  std::string name_, error_;
  std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff_{nullptr, TIFFClose};
};

namespace {

// Thumbnails and reductions of the images are other pages.
bool IsLikeTheFirst(TiffFile& file, const NumberImage& first) {
  const NumberImage page = file.ReadHeader();
  return page.size == first.size && page.format == first.format && page.channels == first.channels;
}

}  // namespace

NumberImage ReadTiff(const std::filesystem::path& path, ReadPart part) {
  TiffFile file(path);
  NumberImage image = file.ReadHeader();
  if (part == ReadPart::kHeader || image.channels != 1) return image;
  file.ReadRows(image);
  while (file.GoOn()) {
    if (!IsLikeTheFirst(file, image)) continue;
    file.Refuse(
        "expected one image, found several pages: as a SOURCE of its own it is a recording");
  }
  return image;
}

TiffPages::TiffPages(const std::filesystem::path& path)
    : file_(std::make_unique<TiffFile>(path)), first_(file_->ReadHeader()), count_(1) {
  while (file_->GoOn()) count_ += IsLikeTheFirst(*file_, first_) ? 1 : 0;
  file_ = std::make_unique<TiffFile>(path);
}

TiffPages::~TiffPages() = default;

bool TiffPages::Next() {
  if (next_ == count_) return false;
  while (next_ > 0 && file_->GoOn() && !IsLikeTheFirst(*file_, first_)) continue;
  ++next_;
  return true;
}

NumberImage TiffPages::Read() {
  NumberImage image = file_->ReadHeader();
  file_->ReadRows(image);
  return image;
}

}  // namespace ossa::depth
