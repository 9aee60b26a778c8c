#pragma once
// What the recorders of camera makers write instead of sensor_msgs/CameraInfo and numbers.
#include <cstdint>
#include <span>
#include <string_view>

#include "depth/sensor/readers/ros/bag_topics.h"
#include "depth/sensor/readers/ros/ros_messages.h"

namespace ossa::depth {

/// Intrinsics of a stream, from text of RealSense's recorder: "width=640;height=480;fx=...;fy=...;
/// ppx=...;ppy=...;model=Brown Conrady;coeffs=k1,k2,p1,p2,k3". Unknown keys are ignored; k is 0 if
/// one is missing.
RosCameraInfo ParseRealSenseIntrinsics(std::string_view text);

/// custom_msg/OBStreamProfileInfo of Orbbec's recorder.
RosCameraInfo ParseOrbbecProfile(std::span<const uint8_t> message, RosWire wire);

/// The camera_info of a topic, by its type.
RosCameraInfo ReadCameraInfo(const BagTopic& topic, std::span<const uint8_t> message);

/// Metres per depth unit: std_msgs/Float32, or std_msgs/String of a number; 0 if it is none.
double ReadDepthUnit(const BagTopic& topic, std::span<const uint8_t> message);

}  // namespace ossa::depth
