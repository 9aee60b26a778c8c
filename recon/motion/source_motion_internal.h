#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

namespace ossa::recon {

/// A joint of a performer's skeleton in a file, named after the segment that it rotates.
struct SourceJoint {
  std::string name;
  int parent = -1;                                   // parents before children
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the parent in the zero pose, file units
  std::vector<Eigen::Vector3d> end_sites;            // from this joint, file units
};

/// World positions and rotations of all joints, file units; rotations are relative to the zero
/// pose.
struct SourceFrame {
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> rotation;
};

/// The common representation of mocap formats for retargeting.
struct SourceMotion {
  std::string source;  // file, for messages
  std::vector<SourceJoint> joints;
  double frame_s = 1.0 / 30.0;
  size_t frame_count = 0;
  std::function<SourceFrame(size_t)> frame;
};

/// The motion sampled at a time from the first frame; positions interpolated linearly, rotations by
/// slerp.
SourceFrame FrameAt(const SourceMotion& motion, double time_s);
/// Whether the motion already has that frame time; files print 1/30 s as 0.0333333.
bool HasStep(const SourceMotion& motion, double step_s);
/// Throws InputError for a motion of more than ten hours: if a file's frame time is actually a
/// rate, interpolation would exhaust memory.
size_t ResampledFrameCount(const SourceMotion& motion, double step_s);

/// Zero-pose position of every joint.
std::vector<Eigen::Vector3d> ZeroPose(const std::vector<SourceJoint>& joints);

}  // namespace ossa::recon
