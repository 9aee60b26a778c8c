#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "recon/motion/bone_mapping_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A point in one frame, metres; none: not seen.
using SeenPoint = std::optional<Eigen::Vector3d>;

/// Maps the points of a motion capture file (TRC, C3D) to the joints of one person.
struct PointBody {
  /// Indices of the points that are averaged for each joint; empty: the joint is absent.
  JointArray<std::vector<size_t>> points;
  /// If not empty, joint centres are computed from these Plug-in Gait markers instead: point index,
  /// name.
  std::vector<std::pair<size_t, std::string>> markers;
};

/// Where the point labels are in the file, for messages.
struct LabelPlace {
  std::string file;
  std::string place;  // "line 4", "byte 512"
};

/// The people in a list of point labels: by the mapping if it names any label; else by joint names;
/// else by Plug-in Gait markers; else by joint names without what all labels begin with. Subjects
/// ("Ann:LKnee", "Bob:LKnee") are separate people. Throws InputError that lists the labels if none
/// is known. Oddities go to `warnings`.
std::vector<PointBody> FindPointBodies(const std::vector<std::string>& labels,
                                       const BoneMapping* mapping, const LabelPlace& place,
                                       std::vector<std::string>& warnings);

/// One frame of these people, ids 1, 2, ...; `points` in the order of the labels.
SkeletonFrame MakeFrame(const std::vector<PointBody>& bodies, const std::vector<SeenPoint>& points,
                        size_t index, double time_s);

/// An alternative up axis: some programs write files in other axes than the format defines.
struct AlternativeUpAxis {
  char name = 'z';                                 // in the file
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // in the coordinates as read
  bool is_in_file = false;                         // the file states that it is up
};

/// Rotates people upright if the file's up axis is `other`: if the file says so, or (with a
/// warning) if people stand along that axis on a floor at 0 and there is no floor at y = 0, unless
/// they stand along y. Warns if nobody ever stands.
void RotateUpright(SkeletonSequence& sequence, const AlternativeUpAxis& other);

/// Turns people who stand along -y by half a turn about z, with a warning: the axes of an image, x
/// to the right and y down, as Azure Kinect and OpenCV have them, become those of camera space.
void TurnFromImageAxes(SkeletonSequence& sequence);

/// Metres per length unit (mm, MM, cm, meters, ...); none for an unknown word.
std::optional<double> MetresPerUnit(std::string_view unit);

}  // namespace ossa::recon
