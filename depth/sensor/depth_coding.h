#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "depth/sensor/frame_source.h"

namespace ossa::depth {

/// The largest 16-bit value. It is not a distance but a clipped value, a renderer's empty
/// background, or a code for no reading (7-Scenes' Kinect images).
inline constexpr uint16_t kSaturatedDepth = 65535;  // by definition

/// Conversion of 16-bit values to millimetres.
struct DepthCoding {
  DepthFormat format = DepthFormat::kPlain;
  double units_per_metre = 1000.0;  // except for kDisparity, > 0
  int inverted_from = 65535;        // for kInverted
  bool IsMillimetres() const { return format == DepthFormat::kPlain && units_per_metre == 1000.0; }
};

/// `plain`, `swapped`, `inverted` (from 65535), `inverted:FROM` (1 to 65535) or `disparity`; throws
/// InputError for anything else.
DepthCoding ParseDepthFormat(std::string_view name);

/// Rounded millimetres of all 65536 values; 0, no reading, for 0, for kSaturatedDepth and beyond
/// 65.534 m.
std::vector<uint16_t> MillimetreTable(const DepthCoding& coding);

}  // namespace ossa::depth
