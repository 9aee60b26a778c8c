#pragma once
#include <array>
#include <cstdint>

namespace ossa::depth {

/// Millimetres of the Kinect v1's 2048 raw depths; 0 for those without one. Only for dumps of raw
/// depths, as fakenect-record writes them: a connected Kinect has its own calibration, this is an
/// average one.
std::array<uint16_t, 2048> AverageKinectDepthTable();

}  // namespace ossa::depth
