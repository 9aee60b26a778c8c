#pragma once

namespace ossa::depth {

/// Stream property of our drivers, six doubles width height fx fy cx cy: the exact camera of a
/// stream, for which OpenNI2 itself has only fields of view.
inline constexpr int kCameraProperty = 0x05A00001;

}  // namespace ossa::depth
