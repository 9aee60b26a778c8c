#pragma once

namespace ossa::depth {

/// Device properties of the Kinect v1 driver, beyond OpenNI2's own (serial number, image
/// registration): for openni::Device::getProperty and setProperty.
inline constexpr int kKinectTiltProperty = 0x05A00010;   // double, degrees; read and write
inline constexpr int kKinectAccelProperty = 0x05A00011;  // 3 doubles, m/s²; read

}  // namespace ossa::depth
