#include "depth/sensor/readers/ros/ros_messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

template <typename Sample>
std::vector<Sample> DecodeSamples(const RosImage& image) {
  const size_t row = sizeof(Sample) * image.width;
  const size_t needed = size_t{image.step} * image.height;
  if (image.width > kLargestImageSide || image.height > kLargestImageSide || image.step < row ||
      image.data.size() < needed) {
    throw InputError("expected an image of " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + " " + image.encoding + ", found " +
                     std::to_string(image.data.size()) + " bytes");
  }
  std::vector<Sample> samples(size_t{image.width} * image.height);
  for (size_t v = 0; v < image.height && row > 0; ++v) {
    std::memcpy(samples.data() + v * image.width, image.data.data() + v * image.step, row);
  }
  auto* bytes = reinterpret_cast<uint8_t*>(samples.data());
  for (size_t i = 0; i < samples.size() && image.is_bigendian; ++i) {
    std::reverse(bytes + i * sizeof(Sample), bytes + (i + 1) * sizeof(Sample));
  }
  return samples;
}

// Whether images of this size show the region of interest.
bool ShowsRegion(const RosCameraInfo& info, int width, int height) {
  const RosCameraInfo::Region& region = info.region;
  const bool is_part = region.width > 0 && region.height > 0 && region.width <= info.width &&
                       region.height <= info.height && region.left <= info.width - region.width &&
                       region.top <= info.height - region.height;
  const bool is_whole =
      info.width == static_cast<uint32_t>(width) && info.height == static_cast<uint32_t>(height);
  return is_part && !is_whole && int64_t{region.width} * height == int64_t{region.height} * width;
}

uint16_t Millimetres(double metres) {
  constexpr double kMillimetresPerMetre = 1000.0;
  const double mm = std::round(metres * kMillimetresPerMetre);
  return mm > 0 && mm < 65536 ? static_cast<uint16_t>(mm) : uint16_t{0};  // NaN: no reading
}

}  // namespace

RosImage ParseRosImage(std::span<const uint8_t> message, RosWire wire) {
  RosFields fields(message, wire);
  RosImage image;
  image.time_s = fields.Header();
  image.height = fields.Value<uint32_t>();
  image.width = fields.Value<uint32_t>();
  image.encoding = fields.Text();
  image.is_bigendian = fields.Value<uint8_t>() != 0;
  image.step = fields.Value<uint32_t>();
  image.data = fields.ByteSequence();
  return image;
}

RosCompressedImage ParseRosCompressedImage(std::span<const uint8_t> message, RosWire wire) {
  RosFields fields(message, wire);
  RosCompressedImage image;
  image.time_s = fields.Header();
  image.format = fields.Text();
  image.data = fields.ByteSequence();
  return image;
}

RosCameraInfo ParseRosCameraInfo(std::span<const uint8_t> message, RosWire wire) {
  RosFields fields(message, wire);
  fields.Header();
  RosCameraInfo info;
  info.height = fields.Value<uint32_t>();
  info.width = fields.Value<uint32_t>();
  info.distortion_model = fields.Text();
  info.d = fields.Sequence<double>();
  info.k = fields.Values<double, 9>();
  fields.Values<double, 9>();  // R
  info.p = fields.Values<double, 12>();
  fields.Values<uint32_t, 2>();  // binning follows from the image size
  info.region.left = fields.Value<uint32_t>();
  info.region.top = fields.Value<uint32_t>();
  info.region.height = fields.Value<uint32_t>();
  info.region.width = fields.Value<uint32_t>();
  return info;
}

bool IsRectified(std::string_view topic) {
  topic.remove_prefix(topic.rfind('/') + 1);
  for (size_t begin = 0; begin < topic.size();) {
    const size_t end = std::min(topic.find('_', begin), topic.size());
    if (topic.substr(begin, end - begin) == "rect") return true;
    begin = end + 1;
  }
  return false;
}

std::optional<Camera> CameraOf(const RosCameraInfo& info, bool is_rectified, int width,
                               int height) {
  Camera own{width, height, info.k[0], info.k[4], info.k[2], info.k[5]};
  if (is_rectified && info.p[0] != 0) {
    own = {width, height, info.p[0], info.p[5], info.p[2], info.p[6]};
  }
  if (own.fx == 0) return std::nullopt;
  if (info.width == 0 || info.height == 0) return own;
  if (std::max(info.width, info.height) > kLargestImageSide) return std::nullopt;
  own.width = static_cast<int>(info.width);
  own.height = static_cast<int>(info.height);
  if (ShowsRegion(info, width, height)) {
    const RosCameraInfo::Region& region = info.region;
    own = Cropped(own, static_cast<int>(region.left), static_cast<int>(region.top),
                  static_cast<int>(region.width), static_cast<int>(region.height));
  }
  if (own.width * height != own.height * width) return std::nullopt;
  return Resized(own, width, height);
}

bool HasLens(const RosCameraInfo& info) {
  return std::any_of(info.d.begin(), info.d.end(), [](double d) { return d != 0; });
}

std::optional<LensCamera> LensOf(const RosCameraInfo& info, const Camera& camera) {
  constexpr size_t kPlumbBob = 5, kRational = 8;  // of OpenCV's order, by definition
  const bool is_rational = info.distortion_model == "rational_polynomial";
  const bool is_known = is_rational || info.distortion_model == "plumb_bob";
  const bool is_finite =
      std::all_of(info.d.begin(), info.d.end(), [](double d) { return std::isfinite(d); });
  if (!HasLens(info) || !is_known || !is_finite) return std::nullopt;
  std::array<double, kRational> d{};  // k1 k2 p1 p2 k3 k4 k5 k6
  std::copy_n(info.d.begin(), std::min(info.d.size(), is_rational ? kRational : kPlumbBob),
              d.begin());
  LensCamera lens{.pinhole = camera};
  lens.k1 = d[0], lens.k2 = d[1], lens.k3 = d[4];
  lens.k4 = d[5], lens.k5 = d[6], lens.k6 = d[7];
  lens.p1 = d[2], lens.p2 = d[3];
  lens.largest_radius = ComputeFoldingRadius(lens);
  return lens;
}

float ParseRosFloat(std::span<const uint8_t> message, RosWire wire) {
  return RosFields(message, wire).Value<float>();
}

std::string ParseRosText(std::span<const uint8_t> message, RosWire wire) {
  return RosFields(message, wire).Text();
}

RosDepth ParseDepthEncoding(const RosImage& image) {
  for (const char* name : {"16UC1", "mono16", "Z16", "z16"}) {
    if (image.encoding == name) return RosDepth::k16Bits;
  }
  return image.encoding == "32FC1" ? RosDepth::kMetres : RosDepth::kNone;
}

std::vector<uint16_t> DecodeDepths(const RosImage& image, double metres_per_unit) {
  std::vector<uint16_t> depths;
  if (ParseDepthEncoding(image) == RosDepth::kMetres) {
    for (const float metres : DecodeSamples<float>(image)) depths.push_back(Millimetres(metres));
    return depths;
  }
  depths = DecodeSamples<uint16_t>(image);
  for (uint16_t& depth : depths) {
    if (metres_per_unit > 0) depth = Millimetres(depth * metres_per_unit);
  }
  return depths;
}

}  // namespace ossa::depth
