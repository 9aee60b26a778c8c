#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "depth/sensor/frame_source.h"

namespace ossa::depth {

/// The largest of 16 bits. It is no distance but what did not fit into them, or a renderer's empty
/// background, or how others write that there is no reading (7-Scenes' Kinect images).
inline constexpr uint16_t kSaturatedDepth = 65535;  // by definition

/// How 16-bit numbers become millimetres.
struct DepthCoding {
  DepthFormat format = DepthFormat::kPlain;
  double units_per_metre = 1000.0;  // of all but kDisparity, > 0
  int inverted_from = 65535;        // of kInverted
  bool IsMillimetres() const { return format == DepthFormat::kPlain && units_per_metre == 1000.0; }
};

/// `plain`, `swapped`, `inverted` (from 65535), `inverted:FROM` (1 to 65535) or `disparity`; throws
/// InputError for anything else.
DepthCoding ParseDepthFormat(std::string_view name);

/// Millimetres of each of the 65536 numbers: rounded; 0, no reading, for 0, for kSaturatedDepth and
/// for what lies beyond 65.534 m.
std::vector<uint16_t> MillimetreTable(const DepthCoding& coding);

}  // namespace ossa::depth
