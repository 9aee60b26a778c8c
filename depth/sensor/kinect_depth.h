#pragma once
#include <array>
#include <cstdint>

namespace ossa::depth {

/// Millimetres of each of the Kinect v1's 2048 raw depths; 0 for those without one. Only for dumps
/// of raw depths, as fakenect-record makes them: a Kinect that is plugged in gives libfreenect the
/// calibration of its own, this is that of an average one.
std::array<uint16_t, 2048> AverageKinectDepthTable();

}  // namespace ossa::depth
