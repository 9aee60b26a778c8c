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

/// Whether these joint positions are a pose as rigs rest in (T, A or hanging arms): legs and trunk
/// stretched away from each other, shoulders above hips the same way round. The zero angles of some
/// studios (Rokoko, Bandai-Namco, LAFAN1), whose bones all lie along one axis, are none.
bool IsRestPose(const std::vector<Eigen::Vector3d>& position, const SourceBones& bones);

/// Which axis of the file's world points up. y is, as the rules of BVH have it, unless the figure
/// stands along z for most of the motion and either its rest pose (`rest_up`, an axis or none)
/// does, too, or the floor is where z is 0. Where the motion lies or stands on its head all the
/// time, as the rest pose says, else y, and `doubt` says so.
struct UpAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  bool by_motion = false;  // the motion itself shows it
  std::string doubt;       // for people to see; "" for none
};
UpAxis FindUpAxis(const SourceMotion& motion, const SourceBones& bones,
                  const std::optional<Eigen::Vector3d>& rest_up);

/// Whether a trunk that points so in the mean of its frames (length 1 or less) stands along an
/// axis.
bool DoesStand(const Eigen::Vector3d& mean_trunk, const Eigen::Vector3d& up);

/// What is said of a body whose trunk, in the mean of its frames (length 1 or less), clearly does
/// not point along the axis that is taken as up; "" of any other. `source` is the file.
std::string DoubtOfUp(const std::string& source, const Eigen::Vector3d& mean_trunk,
                      const Eigen::Vector3d& up);

/// The axis that the direction is nearest to, with its sign.
Eigen::Vector3d NearestAxis(const Eigen::Vector3d& direction);

}  // namespace ossa::recon
