#include "depth/image/depth_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/naming_the_file.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;
using Read = NumberImage (*)(const fs::path&, ReadPart);

// The reader of a file by its extension; null for PNG and for others.
Read ReaderOf(const fs::path& path) {
  using Format = std::pair<std::string_view, Read>;
  constexpr std::array kFormats = {Format{".pgm", ReadPgm}, Format{".tif", ReadTiff},
                                   Format{".tiff", ReadTiff}, Format{".npy", ReadNpy}};
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [extension = LowerCaseExtension(path)](const Format& format) {
                                    return format.first == extension;
                                  });
  return found == kFormats.end() ? nullptr : found->second;
}

// Arrays beside images may be poses, matrices, times.
bool MayBeImage(Read read, const NumberImage& image) {
  constexpr int kSmallestSide = 16;  // pixels, by hand
  return read != ReadNpy || std::min(image.size.width, image.size.height) >= kSmallestSide;
}

bool IsDepth(Read read, const NumberImage& image) {
  return image.channels == 1 && HoldsDepths(image.format) && MayBeImage(read, image);
}

NumberImage ReadDepthNumbers(Read read, const fs::path& path, ReadPart part) {
  NumberImage image = read(path, part);
  if (IsDepth(read, image)) return image;
  if (!MayBeImage(read, image)) {
    throw InputError(path.string() + ": expected an image, found an array of " +
                     std::to_string(image.size.height) + "x" + std::to_string(image.size.width));
  }
  throw InputError(path.string() + ": expected one channel of 16 bits or more, found " +
                   std::to_string(image.channels) + " of " + NameOf(image.format));
}

}  // namespace

bool IsDepthFileName(const fs::path& path) {
  const bool is_image = LowerCaseExtension(path) == ".png" || ReaderOf(path) != nullptr;
  return is_image && !path.filename().string().starts_with(".");
}

Image<uint16_t> ToDepth(const NumberImage& image) {
  const bool is_float = image.format.kind == NumberKind::kFloat;
  const auto unit_mm = is_float ? GuessUnit_mm(image.format, image.numbers) : std::nullopt;
  Image<uint16_t> depth(image.size.width, image.size.height);
  depth.data = DepthsOf(image.format, image.numbers, unit_mm.value_or(1.0));
  return depth;
}

Image<uint16_t> ReadDepthFile(const fs::path& path) {
  const Read read = ReaderOf(path);
  if (read == nullptr) return ReadDepthPng(path);
  return NamingTheFile(path, [&] { return ToDepth(ReadDepthNumbers(read, path, ReadPart::kAll)); });
}

ImageSize ReadDepthFileSize(const fs::path& path) {
  const Read read = ReaderOf(path);
  if (read == nullptr) return ReadDepthPngSize(path);
  return NamingTheFile(path, [&] { return ReadDepthNumbers(read, path, ReadPart::kHeader).size; });
}

bool IsOtherImage(const fs::path& path) {
  const Read read = ReaderOf(path);
  if (read == nullptr) return IsOtherPng(path);
  try {
    return !IsDepth(read, read(path, ReadPart::kHeader));
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace ossa::depth
