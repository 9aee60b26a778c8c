// PNG coding by libpng, with its errors converted to InputError.
// Departure: libpng rather than OpenCV's imgcodecs, which prints damage to stderr instead of
// reporting it, and which in Debian loads GDAL and 140 other libraries (50 MB of the tracker's
// memory) into every program that reads one image.
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <new>

#include "depth/base/error.h"
#include "depth/image/colour_png.h"
#include "depth/image/png_codec_internal.h"

namespace ossa::depth {
namespace {

constexpr std::array<uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
// Signature, IHDR's length, its name, its contents; PNG's format
constexpr size_t kHeaderEnd = 8 + 4 + 4 + 13;

uint32_t BigEndian32(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

[[noreturn]] void Fail(const std::string& name, size_t byte, const std::string& reason) {
  throw InputError(name + ": byte " + std::to_string(byte) + ": " + reason);
}

std::string ChannelsName(int colour_type) {
  switch (colour_type) {
    case PNG_COLOR_TYPE_GRAY:
      return "grey";
    case PNG_COLOR_TYPE_RGB:
      return "colour";
    case PNG_COLOR_TYPE_PALETTE:
      return "palette";
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return "grey and alpha";
    case PNG_COLOR_TYPE_RGB_ALPHA:
      return "colour and alpha";
    default:
      return "unknown";
  }
}

// State shared with libpng's callbacks. Errors leave libpng by longjmp, so the frames between
// setjmp and the call must have no objects with destructors.
struct Session {
  std::span<const uint8_t> input;
  size_t offset = 0;
  std::vector<uint8_t> output;
  std::string error;
};

void NoteError(png_structp png, png_const_charp message) {
  static_cast<Session*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void IgnoreWarning(png_structp, png_const_charp) {}

void TakeBytes(png_structp png, png_bytep to, size_t size) {
  auto* session = static_cast<Session*>(png_get_io_ptr(png));
  if (size > session->input.size() - session->offset) png_error(png, "the file is cut short");
  std::memcpy(to, session->input.data() + session->offset, size);
  session->offset += size;
}

void GiveBytes(png_structp png, png_bytep from, size_t size) {
  auto* session = static_cast<Session*>(png_get_io_ptr(png));
  session->output.insert(session->output.end(), from, from + size);
}

void NoFlush(png_structp) {}

// Creates no C++ objects after setjmp. Returns false if libpng failed.
bool ReadPixels(png_structp png, png_infop info, Session* session, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, session, TakeBytes);
  png_set_user_limits(png, kLargestImageSide, kLargestImageSide);
  png_set_chunk_malloc_max(png, 1 << 20);  // metadata chunks, which are not used
  png_read_info(png, info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

// Pixel format and compression level of a PNG to write.
struct PngForm {
  ImageSize size;
  int bit_depth = 8;
  int colour_type = PNG_COLOR_TYPE_GRAY;
  int level = 3;
  int filters = PNG_FILTER_UP;
};

bool WritePixels(png_structp png, png_infop info, Session* session, const PngForm& form,
                 png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, session, GiveBytes, NoFlush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(form.size.width),
               static_cast<png_uint_32>(form.size.height), form.bit_depth, form.colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, form.level);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, form.filters);
  png_write_info(png, info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

std::vector<png_bytep> RowsOf(uint8_t* samples, int height, size_t stride) {
  std::vector<png_bytep> rows(static_cast<size_t>(height));
  for (size_t v = 0; v < rows.size(); ++v) rows[v] = samples + v * stride;
  return rows;
}

std::vector<uint8_t> Encode(const uint8_t* samples, size_t stride, const PngForm& form) {
  // libpng's interface takes non-const rows but only reads them.
  auto rows = RowsOf(const_cast<uint8_t*>(samples), form.size.height, stride);
  Session session;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &session, NoteError, IgnoreWarning);
  if (png == nullptr) throw std::bad_alloc();
  png_infop info = png_create_info_struct(png);
  const bool written = info != nullptr && WritePixels(png, info, &session, form, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::invalid_argument("PNG: " + session.error);
  return std::move(session.output);
}

bool HasSignature(std::span<const uint8_t> bytes) {
  return bytes.size() >= kSignature.size() &&
         std::equal(kSignature.begin(), kSignature.end(), bytes.begin());
}

bool HasHeader(std::span<const uint8_t> bytes) {
  return bytes.size() >= kHeaderEnd && std::memcmp(bytes.data() + 12, "IHDR", 4) == 0;
}

}  // namespace

bool IsPngOfOtherKind(std::span<const uint8_t> bytes, int bit_depth) {
  return HasSignature(bytes) && HasHeader(bytes) &&
         (bytes[24] != bit_depth || bytes[25] != PNG_COLOR_TYPE_GRAY);
}

ImageSize DecodeGreyPngHeader(std::span<const uint8_t> bytes, int bit_depth,
                              const std::string& name) {
  if (!HasSignature(bytes)) {
    Fail(name, 0, "expected a PNG file, found " + std::to_string(bytes.size()) + " other bytes");
  }
  if (!HasHeader(bytes)) {
    Fail(name, 8, "expected the PNG header IHDR, found none: the file is cut short or damaged");
  }
  const uint32_t width = BigEndian32(bytes.data() + 16);
  const uint32_t height = BigEndian32(bytes.data() + 20);
  constexpr uint32_t kLargest = kLargestImageSide;
  if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
    Fail(name, 16,
         "expected a size of 1x1 to " + std::to_string(kLargest) + "x" + std::to_string(kLargest) +
             " pixels, found " + std::to_string(width) + "x" + std::to_string(height));
  }
  const int found_depth = bytes[24];
  const int colour_type = bytes[25];
  if (found_depth != bit_depth || colour_type != PNG_COLOR_TYPE_GRAY) {
    Fail(name, 24,
         "expected one channel of " + std::to_string(bit_depth) + " bits, found " +
             ChannelsName(colour_type) + " of " + std::to_string(found_depth) + " bits");
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

ImageSize DecodeGreyPng(std::span<const uint8_t> bytes, int bit_depth, const std::string& name,
                        std::vector<uint8_t>* samples) {
  const ImageSize size = DecodeGreyPngHeader(bytes, bit_depth, name);
  const size_t stride = static_cast<size_t>(size.width) * static_cast<size_t>(bit_depth / 8);
  // deflate compresses by at most 1032: a tiny file with a huge header must not cause allocation.
  const size_t wanted = stride * static_cast<size_t>(size.height);
  if (wanted / 1100 > bytes.size()) {
    Fail(name, bytes.size(),
         "the file is cut short: " + std::to_string(bytes.size()) + " bytes cannot hold " +
             std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels");
  }
  samples->assign(wanted, 0);
  auto rows = RowsOf(samples->data(), size.height, stride);
  Session session{.input = bytes, .offset = 0, .output = {}, .error = {}};
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &session, NoteError, IgnoreWarning);
  if (png == nullptr) throw std::bad_alloc();
  png_infop info = png_create_info_struct(png);
  const bool read = info != nullptr && ReadPixels(png, info, &session, rows.data());
  png_destroy_read_struct(&png, &info, nullptr);
  if (!read) Fail(name, session.offset, "expected a whole PNG image, found: " + session.error);
  return size;
}

std::vector<uint8_t> EncodeGreyPng(const uint8_t* samples, ImageSize size, size_t stride,
                                   int bit_depth) {
  // Rendering writes thousands of images: speed matters more than 5 % of size.
  return Encode(samples, stride, {.size = size, .bit_depth = bit_depth});
}

std::vector<uint8_t> EncodeColourPng(std::span<const uint8_t> samples, ImageSize size,
                                     int channels) {
  const auto stride = static_cast<size_t>(size.width) * static_cast<size_t>(channels);
  if ((channels != 3 && channels != 4) ||
      samples.size() != stride * static_cast<size_t>(size.height)) {
    throw std::invalid_argument("EncodeColourPng: samples do not match size and channels");
  }
  PngForm form{.size = size};
  form.colour_type = channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA;
  form.level = 9;
  form.filters = PNG_ALL_FILTERS;
  return Encode(samples.data(), stride, form);
}

}  // namespace ossa::depth
