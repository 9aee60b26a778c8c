#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Frames of a motion, at most `most`, evenly spread.
std::vector<SourceFrame> SampleFrames(const SourceMotion& motion, size_t most = 200);

/// From the middle of the hips to the middle of the shoulders, file axes, length 1 (or 0).
Eigen::Vector3d TrunkDirection(const std::vector<Eigen::Vector3d>& position,
                               const SourceBones& bones);

/// Length of a leg, hip to ankle, the mean of both sides.
double LegLength(const std::vector<Eigen::Vector3d>& position, const SourceBones& bones);

/// Whether these joint positions are a typical rest pose (T, A or hanging arms): legs and trunk
/// stretched in opposite directions, and shoulders above hips with the same orientation. In the
/// zero poses of some studios (Rokoko, Bandai-Namco, LAFAN1) all bones are along one axis; those
/// are not rest poses.
bool IsRestPose(const std::vector<Eigen::Vector3d>& position, const SourceBones& bones);

/// The up axis of the file's world. It is y, by the rules of BVH, unless the figure stands along z
/// for most of the motion and either its rest pose (`rest_up`, an axis or none) does, too, or the
/// floor is at z = 0. If the figure lies or stands on its head throughout, the rest pose decides,
/// else y with a warning in `doubt`.
struct UpAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  bool by_motion = false;  // determined by the motion
  std::string doubt;       // warning for the user; "" for none
};
UpAxis FindUpAxis(const SourceMotion& motion, const SourceBones& bones,
                  const std::optional<Eigen::Vector3d>& rest_up);

/// Whether a trunk with this mean direction over its frames (length 1 or less) stands along an
/// axis.
bool IsUpright(const Eigen::Vector3d& mean_trunk, const Eigen::Vector3d& up);

/// The warning for a body whose mean trunk direction (length 1 or less) is clearly not along the
/// assumed up axis; else "". `source` is the file.
std::string DescribeUpDoubt(const std::string& source, const Eigen::Vector3d& mean_trunk,
                            const Eigen::Vector3d& up);

/// The signed axis nearest to the direction.
Eigen::Vector3d NearestAxis(const Eigen::Vector3d& direction);

}  // namespace ossa::recon
