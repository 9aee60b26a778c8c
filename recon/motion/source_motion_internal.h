#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

namespace ossa::recon {

/// A joint of a performer's skeleton as a file has it, named by the segment it turns.
struct SourceJoint {
  std::string name;
  int parent = -1;                                   // parents before children
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the parent in the zero pose, file units
  std::vector<Eigen::Vector3d> end_sites;            // from this joint, file units
};

/// World places and rotations of every joint, file units; rotations take the zero pose to the
/// world.
struct SourceFrame {
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> rotation;
};

/// What every mocap format comes down to before retargeting.
struct SourceMotion {
  std::string source;  // file, for messages
  std::vector<SourceJoint> joints;
  double frame_s = 1.0 / 30.0;
  size_t frame_count = 0;
  std::function<SourceFrame(size_t)> frame;
};

/// Frames at `step_s`, the first at time 0; positions linearly, rotations by slerp.
SourceFrame FrameAt(const SourceMotion& motion, double time_s);
/// Whether the motion has that step already; files print 1/30 s as 0.0333333.
bool HasStep(const SourceMotion& motion, double step_s);
/// Throws InputError for a motion of more than ten hours: what lies between the frames of one whose
/// frame time is a rate would fill the memory.
size_t ResampledFrameCount(const SourceMotion& motion, double step_s);

/// Zero-pose place of every joint.
std::vector<Eigen::Vector3d> ZeroPose(const std::vector<SourceJoint>& joints);

}  // namespace ossa::recon
