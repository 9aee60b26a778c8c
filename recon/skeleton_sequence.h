#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recon/posture.h"

namespace ossa::recon {

/// One joint of one body in a skeleton file. Fields a file does not have stay empty.
struct JointRecord {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space
  std::optional<TrackingState> state;
  std::optional<double> confidence;
  std::optional<double> reliability;              // R_i, Shum 2013 eq. 8
  std::optional<Eigen::Quaterniond> orientation;  // camera from bone
  std::optional<bool> visible;                    // truth files only
  /// Standard deviations along the camera's axes, metres: of joints of a fitted body.
  std::optional<Eigen::Vector3d> sigma_m = std::nullopt;
};

/// Pose of an object of a physical scene in one frame.
struct ObjectRecord {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// One person in one frame of a recording.
struct BodyRecord {
  int id = 0;
  JointArray<std::optional<JointRecord>> joints;  // absent joints are empty
  /// Estimate of cascaded refinement from this frame alone (ReconstructionInput::bones_m).
  std::optional<BoneLengths> bones_m = std::nullopt;
};

/// One frame of a recording with all its bodies.
struct SkeletonFrame {
  int64_t frame = 0;
  double time_s = 0.0;
  std::optional<Eigen::Vector4d> floor;  // a b c d of ax + by + cz + d = 0, unit normal up, metres
  std::vector<BodyRecord> bodies;
  std::vector<ObjectRecord> objects{};  // written to JSONL; no reader gives any
};

/// The content of any skeleton file, converted to the SDK's joints, camera space and metres.
struct SkeletonSequence {
  std::string source;  // file it came from, for messages
  std::vector<SkeletonFrame> frames;
  std::string sensor{};  // kKinectV2 or kRefinedJoints if the file tells; else empty
  /// Which of two skeletons in one file this is, "truth" or "observed"; empty if there is only
  /// one.
  std::string columns{};
  /// Oddities of the file and how they were read, a line each with file and place.
  std::vector<std::string> warnings{};
};

/// The Kinect SDK 2's skeleton, of Kinect v2 (Xbox One).
constexpr const char* kKinectV2 = "Kinect v2";
/// ossa's own joints after the refinement cascade, `ossa track --posture refined`: nothing else
/// estimates bones.
constexpr const char* kRefinedJoints = "refined joints";

/// Whether the joint's position is meaningful: it was seen, or a method has placed it, which then
/// gives it a reliability. Unseen joints of sensors lie anywhere, usually at the camera.
bool HasPlace(const JointRecord& joint);

/// An id that two bodies of the frame share, as in damaged files; none otherwise.
std::optional<int> RepeatedBody(const SkeletonFrame& frame);

/// The record as a TrackedPosture: absent joints are not tracked; a joint without a state
/// counts as tracked; a joint without confidence gets 1 (tracked), 0.5 (inferred) or 0.
TrackedPosture ToTrackedPosture(const BodyRecord& body);

}  // namespace ossa::recon
