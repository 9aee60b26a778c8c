#include "depth/image/depth_png.h"

#include <cstring>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "depth/image/image_bytes_internal.h"
#include "depth/image/png_codec_internal.h"

namespace ossa::depth {
namespace {

template <typename T>
Image<T> ReadGreyPng(const std::filesystem::path& path) {
  return NamingTheFile(path, [&] {
    std::vector<uint8_t> samples;
    const ImageSize size =
        DecodeGreyPng(ReadImageBytes(path), 8 * sizeof(T), path.string(), &samples);
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

std::string SizeText(ImageSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Image<uint16_t> ReadDepthPng(const std::filesystem::path& path) {
  return ReadGreyPng<uint16_t>(path);
}

ImageSize ReadDepthPngSize(const std::filesystem::path& path) {
  return DecodeGreyPngHeader(ReadImageBytes(path, 64), 16, path.string());
}

bool IsOtherPng(const std::filesystem::path& path) {
  try {
    return IsPngOfOtherKind(ReadImageBytes(path, 64), 16);
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
