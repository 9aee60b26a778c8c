#include "depth/sensor/stray_scanner.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/image/camera_io.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

constexpr ImageSize kColour{1920, 1440};  // pixels; derived: of ARKit's video

fs::path FileOfConfidence(const fs::path& depth_png) {
  return depth_png.parent_path().parent_path() / "confidence" / depth_png.filename();
}

}  // namespace

Camera ReadScannerCamera(const fs::path& file, ImageSize size) {
  constexpr double kFarthest = 0.05;  // share of the size; by hand: lenses are off by less
  CameraChoice choice = ReadCameraFile(file);
  choice.camera.width = kColour.width;
  choice.camera.height = kColour.height;
  if (std::abs(choice.camera.cx / kColour.width - 0.5) > kFarthest ||
      std::abs(choice.camera.cy / kColour.height - 0.5) > kFarthest) {
    throw InputError(file.string() + ": its centre is not that of images of " +
                     std::to_string(kColour.width) + "x" + std::to_string(kColour.height));
  }
  return CameraForSize(choice, size.width, size.height);
}

std::optional<DepthList> ReadScannerTimes(const fs::path& recording) {
  constexpr std::uintmax_t kLargest = std::uintmax_t{256} << 20;  // bytes: a day of frames
  const fs::path path = recording / "odometry.csv";
  std::error_code none;
  if (!fs::is_regular_file(path, none) || fs::file_size(path, none) > kLargest) {
    return std::nullopt;
  }
  std::ifstream file = OpenFile(path);
  if (!file) throw InputError(path.string() + ": cannot be read: expected a list of frames");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  if (!text.starts_with("timestamp, frame")) return std::nullopt;
  DepthList list =
      ParseDepthList(std::string_view(text).substr(std::min(text.size(), text.find('\n'))));
  for (DepthList::Entry& entry : list.entries) {
    entry.file = entry.rest = "depth/" + entry.file + ".png";
  }
  std::erase_if(list.entries, [&](const DepthList::Entry& entry) {
    return !fs::is_regular_file(recording / entry.file, none);
  });
  return list;
}

bool HasConfidence(const fs::path& depth_png, ImageSize size) {
  constexpr uint8_t kHighest = 2;  // no unit; derived: ARConfidenceLevel.high
  if (depth_png.parent_path().filename() != "depth") return false;
  try {
    const Image<uint8_t> confidence = ReadLabelPng(FileOfConfidence(depth_png));
    return ImageSize{confidence.width, confidence.height} == size &&
           std::ranges::all_of(confidence.data, [](uint8_t value) { return value <= kHighest; });
  } catch (const InputError&) {  // none, or of another kind
    return false;
  }
}

void RemoveUnconfident(const fs::path& depth_png, Image<uint16_t>& depth) {
  const fs::path file = FileOfConfidence(depth_png);
  const Image<uint8_t> confidence = ReadLabelPng(file);
  if (confidence.width != depth.width || confidence.height != depth.height) {
    throw InputError(file.string() + ": expected " + std::to_string(depth.width) + "x" +
                     std::to_string(depth.height) + " like the depth image, found " +
                     std::to_string(confidence.width) + "x" + std::to_string(confidence.height));
  }
  for (size_t i = 0; i < depth.data.size(); ++i) {
    if (confidence.data[i] == 0) depth.data[i] = 0;
  }
}

}  // namespace ossa::depth
