#pragma once

namespace ossa::depth {

/// Six doubles, width height fx fy cx cy: the exact camera of a stream, where OpenNI2 itself knows
/// only fields of view. A stream property of our drivers.
inline constexpr int kCameraProperty = 0x05A00001;

}  // namespace ossa::depth
