#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "recon/motion/bone_mapping_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A point of one frame, metres; none: not seen.
using SeenPoint = std::optional<Eigen::Vector3d>;

/// How the points of a motion capture file (TRC, C3D) make one person.
struct PointBody {
  /// The points whose mean each joint is; of a joint that no point is, none.
  JointArray<std::vector<size_t>> points;
  /// Joint centres are worked out from these Plug-in Gait markers instead: point, name.
  std::vector<std::pair<size_t, std::string>> markers;
};

/// Where the labels of points stand, for messages.
struct LabelPlace {
  std::string file;
  std::string place;  // "line 4", "byte 512"
};

/// The people whose joints the points are: by the mapping where it names any of them; by their own
/// names; else, of Plug-in Gait's markers, the joint centres. Points of several subjects
/// ("Ann:LKnee", "Bob:LKnee") are as many people. Throws InputError that lists the labels when they
/// are nobody's. What is odd goes to `warnings`.
std::vector<PointBody> FindPointBodies(const std::vector<std::string>& labels,
                                       const BoneMapping* mapping, const LabelPlace& place,
                                       std::vector<std::string>& warnings);

/// A frame of these people, ids 1, 2, ...; `points` are in the order of the labels.
SkeletonFrame MakeFrame(const std::vector<PointBody>& bodies, const std::vector<SeenPoint>& points,
                        size_t index, double time_s);

/// The axis that is up in files of some programs though it is not in their format.
struct OtherUp {
  char name = 'z';          // in the file
  Eigen::Vector3d axis;     // as it was read
  bool is_in_file = false;  // the file says that it is up
};

/// Brings people upright in whose file the other axis is up: where it says so, or where they stand
/// along that axis on a floor at its 0 and y says of no floor (with a warning), unless they stand
/// along y. Of a body that never stands a warning says so.
void BringUpright(SkeletonSequence& sequence, const OtherUp& other);

/// Metres of a length unit as people write it (mm, MM, cm, meters, ...); none for another word.
std::optional<double> MetresPerUnit(std::string_view unit);

}  // namespace ossa::recon
