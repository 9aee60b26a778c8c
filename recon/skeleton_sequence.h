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

/// A thing that people handle, where it was in one frame: of a mechanical scene.
struct ObjectRecord {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// One person in one frame of a recording.
struct BodyRecord {
  int id = 0;
  JointArray<std::optional<JointRecord>> joints;  // absent joints are empty
  /// As cascaded refinement estimates them of this frame alone (ReconstructionInput::bones_m).
  std::optional<BoneLengths> bones_m = std::nullopt;
};

/// One moment of a recording: everybody in it.
struct SkeletonFrame {
  int64_t frame = 0;
  double time_s = 0.0;
  std::optional<Eigen::Vector4d> floor;  // a b c d of ax + by + cz + d = 0, unit normal up, metres
  std::vector<BodyRecord> bodies;
  std::vector<ObjectRecord> objects{};  // written to JSONL; no reader gives any
};

/// What any skeleton file holds, ours or an SDK's, brought to our joints, axes and units.
struct SkeletonSequence {
  std::string source;  // file it came from, for messages
  std::vector<SkeletonFrame> frames;
  std::string sensor{};  // kKinectV2 or kRefinedJoints where the file tells; else empty
  /// Of a file that holds two skeletons side by side which one this is, truth or observed; else
  /// empty.
  std::string columns{};
  /// What was odd and how it was read, a line each, naming file and place: for people to see.
  std::vector<std::string> warnings{};
};

/// The Kinect SDK 2's skeleton, of Kinect v2 (Xbox One).
constexpr const char* kKinectV2 = "Kinect v2";
/// ossa's own joints after the refinement cascade, `ossa track --posture refined`: nothing else
/// estimates bones.
constexpr const char* kRefinedJoints = "refined joints";

/// Whether the joint's position says something. What a sensor does not see lies anywhere, at the
/// camera as a rule; where a method has then placed it there is a reliability.
bool HasPlace(const JointRecord& joint);

/// The id that two bodies of the frame have, if any: a damaged file.
std::optional<int> RepeatedBody(const SkeletonFrame& frame);

/// A body record as the trackers' type: absent joints are not tracked; a joint without a state
/// counts as tracked; a joint without confidence gets 1 (tracked), 0.5 (inferred) or 0.
TrackedPosture ToTrackedPosture(const BodyRecord& body);

}  // namespace ossa::recon
