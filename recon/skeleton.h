#pragma once
#include <array>
#include <cstddef>
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

/// Index of a joint in an array of all joints.
constexpr size_t Index(Joint joint) { return static_cast<size_t>(joint); }

/// One T for each joint, by the joint or by its index.
template <typename T>
struct JointArray : std::array<T, kJointCount> {
  using std::array<T, kJointCount>::operator[];
  constexpr T& operator[](Joint joint) { return (*this)[Index(joint)]; }
  constexpr const T& operator[](Joint joint) const { return (*this)[Index(joint)]; }
};

/// Parent of each joint, parents before children; the root's is -1. The 19 others are the bones:
/// bone of joint i runs from kJointParent[i] to i.
inline constexpr JointArray<int> kJointParent = {-1, 0,  1, 2,  2,  4,  5, 6,  2,  8,
                                                 9,  10, 0, 12, 13, 14, 0, 16, 17, 18};

/// SDK names, e.g. "HipCenter", in enum order: the keys of skeleton files.
inline constexpr JointArray<std::string_view> kJointNames = {
    "HipCenter",  "Spine",     "ShoulderCenter", "Head",          "ShoulderLeft",
    "ElbowLeft",  "WristLeft", "HandLeft",       "ShoulderRight", "ElbowRight",
    "WristRight", "HandRight", "HipLeft",        "KneeLeft",      "AnkleLeft",
    "FootLeft",   "HipRight",  "KneeRight",      "AnkleRight",    "FootRight"};

/// The joint on the other side of the body; joints on the midline map to themselves.
inline constexpr JointArray<size_t> kMirroredJoint = {0, 1, 2,  3,  8,  9,  10, 11, 4,  5,
                                                      6, 7, 16, 17, 18, 19, 12, 13, 14, 15};

/// Index of a joint's parent; the root counts as its own.
constexpr size_t ParentOf(size_t joint) {
  return joint == 0 ? 0 : static_cast<size_t>(kJointParent[joint]);
}
/// The SDK's name of a joint, "HipCenter".
constexpr std::string_view NameOf(Joint joint) { return kJointNames[joint]; }

/// The joint with this SDK name; empty for other names.
constexpr std::optional<Joint> JointFromName(std::string_view name) {
  for (size_t i = 0; i < kJointCount; ++i) {
    if (kJointNames[i] == name) return static_cast<Joint>(i);
  }
  return std::nullopt;
}

}  // namespace ossa::recon
