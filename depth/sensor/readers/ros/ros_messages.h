#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/readers/lens_camera.h"
#include "depth/sensor/readers/ros/ros_fields.h"

namespace ossa::depth {

// Messages of ROS 1 and ROS 2 as stored in a bag. Parsers throw InputError for truncated ones.

/// sensor_msgs/Image.
struct RosImage {
  double time_s = 0.0;  // header.stamp; 0: not stamped
  uint32_t height = 0, width = 0;
  std::string encoding;
  bool is_bigendian = false;
  uint32_t step = 0;              // bytes from one row to the next
  std::span<const uint8_t> data;  // within the message
};
RosImage ParseRosImage(std::span<const uint8_t> message, RosWire wire = RosWire::kRos1);

/// sensor_msgs/CameraInfo.
struct RosCameraInfo {
  uint32_t height = 0, width = 0;  // of the full images of k and p, pixels; 0: not stated
  std::string distortion_model;
  std::vector<double> d;       // coefficients of that model, for raw images
  std::array<double, 9> k{};   // fx 0 cx 0 fy cy 0 0 1, pixels; all 0: not calibrated
  std::array<double, 12> p{};  // fx 0 cx 0 0 fy cy 0 0 0 1 0 of rectified images; 0: none
  struct Region {
    uint32_t left = 0, top = 0, height = 0, width = 0;
  };
  Region region;  // of the whole that the sensor gives, pixels of the whole; 0 x 0: all of it
};
RosCameraInfo ParseRosCameraInfo(std::span<const uint8_t> message, RosWire wire = RosWire::kRos1);

/// sensor_msgs/CompressedImage.
struct RosCompressedImage {
  double time_s = 0.0;  // header.stamp; 0: not stamped
  std::string format;
  std::span<const uint8_t> data;  // within the message
};
RosCompressedImage ParseRosCompressedImage(std::span<const uint8_t> message, RosWire wire);

/// Whether a topic has rectified images, such as image_rect: they have the camera p, others k.
bool IsRectified(std::string_view topic);

/// The camera for images of width × height pixels, scaled if its own size, or that of its region,
/// differs but has the same shape; none if it is not calibrated, or of another shape.
std::optional<Camera> CameraOf(const RosCameraInfo& info, bool is_rectified, int width, int height);

/// The distortion of raw images of this camera, for the models plumb_bob and rational_polynomial
/// (OpenCV's). None if it is zero, or of another model.
std::optional<LensCamera> LensOf(const RosCameraInfo& info, const Camera& camera);
/// Whether it states a non-zero distortion.
bool HasLens(const RosCameraInfo& info);

/// std_msgs/Float32.
float ParseRosFloat(std::span<const uint8_t> message, RosWire wire = RosWire::kRos1);
/// std_msgs/String.
std::string ParseRosText(std::span<const uint8_t> message, RosWire wire);

enum class RosDepth {
  kNone,
  k16Bits,  // 16UC1 or mono16, which Orbbec's recorder calls Z16 and mono16
  kMetres,  // 32FC1
};
RosDepth ParseDepthEncoding(const RosImage& image);

/// Depths, row-major, height × width: millimetres from metres, and from 16 bits if metres_per_unit
/// > 0; else the raw values. Throws InputError for an image with too few bytes.
std::vector<uint16_t> DecodeDepths(const RosImage& image, double metres_per_unit);

}  // namespace ossa::depth
