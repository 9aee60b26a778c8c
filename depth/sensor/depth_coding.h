#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "depth/sensor/frame_source.h"

namespace ossa::depth {

/// `plain`, `swapped`, `inverted` or `disparity`; throws InputError for anything else.
DepthFormat ParseDepthFormat(std::string_view name);

/// How 16-bit numbers become millimetres.
struct DepthCoding {
  DepthFormat format = DepthFormat::kPlain;
  double units_per_metre = 1000.0;  // of all but kDisparity, > 0
  bool IsMillimetres() const { return format == DepthFormat::kPlain && units_per_metre == 1000.0; }
};

/// Millimetres of each of the 65536 numbers: rounded; 0, no reading, for 0 and for what
/// lies beyond 65.535 m.
std::vector<uint16_t> MillimetreTable(const DepthCoding& coding);

}  // namespace ossa::depth
