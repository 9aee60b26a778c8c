#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace ossa::recon {

/// The 20 joints of the Kinect SDK 1.x in its order. Left is the person's left.
enum class Joint {
  kHipCenter,
  kSpine,
  kShoulderCenter,
  kHead,
  kShoulderLeft,
  kElbowLeft,
  kWristLeft,
  kHandLeft,
  kShoulderRight,
  kElbowRight,
  kWristRight,
  kHandRight,
  kHipLeft,
  kKneeLeft,
  kAnkleLeft,
  kFootLeft,
  kHipRight,
  kKneeRight,
  kAnkleRight,
  kFootRight,
};
inline constexpr int kJointCount = 20;  // the Kinect SDK's

/// Parent of each joint, parents before children; the root's is -1. The 19 others are the bones:
/// bone of joint i runs from kJointParent[i] to i.
inline constexpr std::array<int, kJointCount> kJointParent = {-1, 0,  1, 2,  2,  4,  5, 6,  2,  8,
                                                              9,  10, 0, 12, 13, 14, 0, 16, 17, 18};

/// SDK names, e.g. "HipCenter", in enum order: the keys of skeleton files.
inline constexpr std::array<std::string_view, kJointCount> kJointNames = {
    "HipCenter",  "Spine",     "ShoulderCenter", "Head",          "ShoulderLeft",
    "ElbowLeft",  "WristLeft", "HandLeft",       "ShoulderRight", "ElbowRight",
    "WristRight", "HandRight", "HipLeft",        "KneeLeft",      "AnkleLeft",
    "FootLeft",   "HipRight",  "KneeRight",      "AnkleRight",    "FootRight"};

/// The joint on the other side of the body; joints on the midline map to themselves.
inline constexpr std::array<int, kJointCount> kMirroredJoint = {
    0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15};

constexpr int Index(Joint joint) { return static_cast<int>(joint); }
constexpr std::string_view NameOf(Joint joint) { return kJointNames[static_cast<size_t>(joint)]; }

constexpr std::optional<Joint> JointFromName(std::string_view name) {
  for (int i = 0; i < kJointCount; ++i) {
    if (kJointNames[static_cast<size_t>(i)] == name) return static_cast<Joint>(i);
  }
  return std::nullopt;
}

}  // namespace ossa::recon
