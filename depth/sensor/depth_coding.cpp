#include "depth/sensor/depth_coding.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "depth/base/error.h"
#include "depth/sensor/kinect_depth.h"

namespace ossa::depth {
namespace {

constexpr uint32_t kNumbers = 65536;  // that 16 bits hold, by definition

uint32_t Plain(DepthFormat format, uint32_t number) {
  switch (format) {
    case DepthFormat::kSwapped:
      return (number & 0xFF) << 8 | number >> 8;
    case DepthFormat::kInverted:
      return kNumbers - 1 - number;
    default:
      return number;
  }
}

}  // namespace

DepthFormat ParseDepthFormat(std::string_view name) {
  if (name == "plain") return DepthFormat::kPlain;
  if (name == "swapped") return DepthFormat::kSwapped;
  if (name == "inverted") return DepthFormat::kInverted;
  if (name == "disparity") return DepthFormat::kDisparity;
  throw InputError("--depth-format: expected plain, swapped, inverted or disparity, found '" +
                   std::string(name) + "'");
}

std::vector<uint16_t> MillimetreTable(const DepthCoding& coding) {
  std::vector<uint16_t> table(kNumbers, 0);
  if (coding.format == DepthFormat::kDisparity) {
    const auto kinect = AverageKinectDepthTable();
    std::copy(kinect.begin() + 1, kinect.end(), table.begin() + 1);
    return table;
  }
  for (uint32_t number = 1; number < kNumbers; ++number) {
    const double mm = std::round(Plain(coding.format, number) * 1000.0 / coding.units_per_metre);
    if (mm < kNumbers) table[number] = static_cast<uint16_t>(mm);
  }
  return table;
}

}  // namespace ossa::depth
