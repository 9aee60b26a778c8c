#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// One number of a BVH joint per frame. Rotations turn about the joint's own axes and compose in
/// the order listed (first listed is outermost).
enum class BvhChannel { kXposition, kYposition, kZposition, kXrotation, kYrotation, kZrotation };

/// One joint of a BVH hierarchy.
struct BvhJoint {
  std::string name;
  int parent = -1;                                   // -1 for a root; parents before children
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the parent, file units
  std::vector<BvhChannel> channels;                  // each at most once, any order
  std::vector<Eigen::Vector3d> end_sites;            // from this joint, file units
};

/// A BVH file in memory. Units are the file's own; angles are degrees.
struct BvhFile {
  std::vector<BvhJoint> joints;
  double frame_s = 1.0 / 30.0;
  std::vector<double> values;  // row-major, frame x channel, channels in file order
  /// Oddities of the text and how they were read, a line each.
  std::vector<std::string> warnings{};

  size_t ChannelCount() const;
  size_t FrameCount() const;
};

/// World position and rotation of every joint in one frame, file units.
struct BvhFramePose {
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> rotation;
};
/// The pose of one frame, counted from 0.
BvhFramePose ComputePose(const BvhFile& bvh, size_t frame);

/// Reads any valid file and common deviations: any channel order per joint, 0 to 6 channels,
/// several roots, line ends of any kind, more or fewer rows than the header says (with a warning).
/// Throws InputError naming the line, also for a truncated last row. `source` names the text in
/// messages.
BvhFile ParseBvh(std::string text, const std::string& source);
/// ParseBvh of a file. Throws InputError naming file and line.
BvhFile ReadBvh(const std::filesystem::path& path);

/// Splits a file with several roots into one per root; returns the file itself if it has one.
std::vector<BvhFile> SplitRoots(BvhFile bvh);

/// The text of a BVH file, with each joint's own channel order.
std::string FormatBvh(const BvhFile& bvh);
/// Writes a BVH file, which appears under its name only when complete.
void WriteBvh(const BvhFile& bvh, const std::filesystem::path& path);

/// Largest BVH that is read as skeletons, bytes: six hours of motion or more.
inline constexpr size_t kMostBvhBytes = size_t{1} << 29;

/// Names and hierarchy of the joints of a written BVH.
enum class BvhNames {
  kSdk,  // the SDK's 20 joints, with helper joints where bones branch: nothing is lost
  // A humanoid that retargeting tools recognise, at rest in a T-pose that faces +z:
  kCmu,     // Hips, Spine, LeftUpLeg ...
  kMixamo,  // the same with mixamorig: before them
  kVrm,     // hips, spine, leftUpperLeg ...
};

/// How skeletons are written as BVH.
struct BvhExportOptions {
  BvhNames names = BvhNames::kSdk;
  std::optional<int> body_id;  // which body of the sequence; none: the one seen in most frames
  /// BVH needs a fixed step; the sequence is resampled to it by linear interpolation of the
  /// joints.
  double frame_s = 1.0 / 30.0;
  /// Longer texts are refused, because gaps in a recording, a day at most, are filled.
  size_t most_bytes = kMostBvhBytes;
};

/// Converts one body of a sequence to a BVH of the 20 SDK joints, centimetres in the sequence's own
/// axes (camera space), with constant bone lengths: each bone's median over the frames. Bone
/// directions are exact, and the body is translated to the least-squares fit of the observed
/// joints. A missing joint keeps its bone's last direction; an untracked joint counts as missing
/// unless a method has placed it (it has a reliability). Where bones branch, each has a helper
/// joint of length zero, named after both ends ("HipCenter-Spine"), so that it can rotate alone. A
/// humanoid (BvhNames) has 21 joints and no helpers: its thighs start at their mean positions
/// relative to the hips, and hands are end sites. All files begin with the sequence's first frame,
/// so that those of several people are synchronous; before the body is first seen it keeps its
/// first pose. Throws InputError if no frame has the body, or if the text would exceed the options'
/// bytes.
BvhFile SkeletonToBvh(const SkeletonSequence& sequence, const BvhExportOptions& options = {});
/// The same into a file, with one frame in memory at a time; the file appears under its name only
/// when complete.
void WriteSkeletonAsBvh(const SkeletonSequence& sequence, const std::filesystem::path& path,
                        const BvhExportOptions& options = {});

struct BoneMapping;

/// Reads the 20 joints of a BVH, as far as it has them, in metres; each root that is a person is a
/// body, with ids 1, 2, ... In a BVH with the SDK's joints (as SkeletonToBvh writes) they are found
/// by name, in centimetres. In others, bones are found by name (FindBones): - HipCenter, Head,
/// shoulders, elbows, wrists, hips, knees, ankles are where its joints are; ShoulderCenter is the
/// first joint of the neck, or between the shoulders without one; feet are the toe joints; - Spine
/// lies on the line through the joints between hips and neck, as far along it as on the standard
/// body; - hands, and feet without toe joint, lie towards what follows the wrist or ankle (the
/// middle of its children, or its end site), as far as is usual for the forearm or shin. The unit
/// is the one in which the legs have human length: centimetres if possible, else metres,
/// millimetres, inches or the CMU's (0.45 inch), with a warning. y is up, or z, with a warning, if
/// the figure clearly stands along it. Throws InputError for unknown names. The BVH is consumed, to
/// save memory.
SkeletonSequence BvhToSkeleton(BvhFile bvh, const std::string& source,
                               const BoneMapping* mapping = nullptr);

}  // namespace ossa::recon
