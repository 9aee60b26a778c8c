#include "depth/sensor/depth_coding.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "depth/base/error.h"
#include "depth/sensor/kinect_depth.h"

namespace ossa::depth {
namespace {

constexpr uint32_t kNumbers = 65536;  // number of 16-bit values, by definition

// The value without encoding; 0 if it is not a distance.
uint32_t Plain(const DepthCoding& coding, uint32_t number) {
  switch (coding.format) {
    case DepthFormat::kSwapped:
      return (number & 0xFF) << 8 | number >> 8;
    case DepthFormat::kInverted:
      return static_cast<uint32_t>(std::max(0, coding.inverted_from - static_cast<int>(number)));
    default:
      return number;
  }
}

std::optional<int> ParseFrom(std::string_view text) {
  int from = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), from);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || from < 1 || from >= static_cast<int>(kNumbers)) return std::nullopt;
  return from;
}

}  // namespace

DepthCoding ParseDepthFormat(std::string_view name) {
  constexpr std::string_view kInvertedFrom = "inverted:";
  if (name == "plain") return {};
  if (name == "swapped") return {.format = DepthFormat::kSwapped};
  if (name == "inverted") return {.format = DepthFormat::kInverted};
  if (name == "disparity") return {.format = DepthFormat::kDisparity};
  if (name.starts_with(kInvertedFrom)) {
    const auto from = ParseFrom(name.substr(kInvertedFrom.size()));
    if (from) return {.format = DepthFormat::kInverted, .inverted_from = *from};
  }
  throw InputError(
      "--depth-format: expected plain, swapped, inverted, inverted:FROM (1 to 65535) or disparity, "
      "found '" +
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
    const uint32_t plain = Plain(coding, number);
    const double mm = std::round(plain * 1000.0 / coding.units_per_metre);
    if (plain < kSaturatedDepth && mm < kSaturatedDepth) table[number] = static_cast<uint16_t>(mm);
  }
  return table;
}

}  // namespace ossa::depth
