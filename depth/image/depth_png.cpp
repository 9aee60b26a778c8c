#include "depth/image/depth_png.h"

#include <cstring>
#include <fstream>
#include <system_error>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "depth/image/png_codec_internal.h"

namespace ossa::depth {
namespace {

// An incompressible 16-bit image of 8192², and a margin: larger files are refused.
constexpr uintmax_t kLargestFile = uintmax_t{150} << 20;

std::vector<uint8_t> ReadBytes(const std::filesystem::path& path, size_t at_most) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
  if (size > kLargestFile) {
    throw InputError(path.string() + ": expected an image file, found " + std::to_string(size) +
                     " bytes");
  }
  std::vector<uint8_t> bytes(std::min(static_cast<size_t>(size), at_most));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw InputError(path.string() + ": cannot be read: expected a PNG image");
  return bytes;
}

template <typename T>
Image<T> ReadGreyPng(const std::filesystem::path& path) {
  return NamingTheFile(path, [&] {
    std::vector<uint8_t> samples;
    const ImageSize size =
        DecodeGreyPng(ReadBytes(path, kLargestFile), 8 * sizeof(T), path.string(), &samples);
    Image<T> image(size.width, size.height);
    std::memcpy(image.data.data(), samples.data(), samples.size());
    return image;
  });
}

void WriteBytes(const std::filesystem::path& path, const std::vector<uint8_t>& bytes) {
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.CommitOneOfMany();
}

}  // namespace

Image<uint16_t> ReadDepthPng(const std::filesystem::path& path) {
  return ReadGreyPng<uint16_t>(path);
}

ImageSize ReadDepthPngSize(const std::filesystem::path& path) {
  return DecodeGreyPngHeader(ReadBytes(path, 64), 16, path.string());
}

bool IsOtherPng(const std::filesystem::path& path) {
  try {
    return IsPngOfOtherKind(ReadBytes(path, 64), 16);
  } catch (const InputError&) {
    return false;
  }
}

void WriteDepthPng(const std::filesystem::path& path, const DepthView& depth) {
  WriteBytes(path, EncodeGreyPng(reinterpret_cast<const uint8_t*>(depth.data_mm),
                                 {depth.width, depth.height},
                                 static_cast<size_t>(depth.stride) * sizeof(uint16_t), 16));
}

Image<uint8_t> ReadLabelPng(const std::filesystem::path& path) {
  return ReadGreyPng<uint8_t>(path);
}

void WriteLabelPng(const std::filesystem::path& path, const Image<uint8_t>& labels) {
  WriteBytes(path, EncodeGreyPng(labels.data.data(), {labels.width, labels.height},
                                 static_cast<size_t>(labels.width), 8));
}

}  // namespace ossa::depth
