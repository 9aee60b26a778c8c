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

struct BvhJoint {
  std::string name;
  int parent = -1;                                   // -1 for the root; parents before children
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the parent, file units
  std::vector<BvhChannel> channels;                  // each at most once, any order
  std::vector<Eigen::Vector3d> end_sites;            // from this joint, file units
};

/// A BVH file in memory. Units are the file's own; angles are degrees.
struct BvhFile {
  std::vector<BvhJoint> joints;
  double frame_s = 1.0 / 30.0;
  std::vector<double> values;  // row-major, frame x channel, channels in file order

  size_t ChannelCount() const;
  size_t FrameCount() const;
};

/// World place and rotation of every joint in one frame, file units.
struct BvhFramePose {
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> rotation;
};
BvhFramePose PoseOf(const BvhFile& bvh, size_t frame);

/// Reads any legal file: channel order per joint, 0 to 6 channels, several roots refused. Throws
/// InputError naming the line. `source` names the text in messages.
BvhFile ParseBvh(std::string text, const std::string& source);
BvhFile ReadBvh(const std::filesystem::path& path);

/// Writes with the joint's own channel order; the file appears only when complete.
std::string FormatBvh(const BvhFile& bvh);
void WriteBvh(const BvhFile& bvh, const std::filesystem::path& path);

/// Skeletons are read from a BVH of at most so many bytes: six hours of motion or more.
inline constexpr size_t kMostBvhBytes = size_t{1} << 29;

struct BvhExportOptions {
  std::optional<int> body_id;  // which body of the sequence; none: the one seen in most frames
  /// BVH needs a fixed step; the sequence is resampled to it by time, joints moving straight from
  /// frame to frame.
  double frame_s = 1.0 / 30.0;
  /// A longer text is refused: a gap in a recording, a day at most, is filled like all else.
  size_t most_bytes = kMostBvhBytes;
};

/// One body of a skeleton file as a BVH of the 20 SDK joints, centimetres in the sequence's own
/// axes (camera space), with constant bone lengths: the median of each bone over the frames. The
/// direction of every bone is kept exactly and the whole is moved to lie nearest to the observed
/// joints (least squares). A missing joint holds its bone's last direction; one that is not tracked
/// is missing unless it has a reliability: then a method has placed it. Where bones branch,
/// each has a joint of its own, without length, named after both ends ("HipCenter-Spine"), so that
/// it can turn alone. It begins with the sequence's first frame, whoever is in it, and stands until
/// the body is first seen: those of several people are in step with each other and the recording.
/// Throws InputError when no frame has the body, or its text would surely exceed the options'
/// bytes.
BvhFile BvhOfSkeleton(const SkeletonSequence& sequence, const BvhExportOptions& options = {});
/// The same into a file, without ever holding more than a frame of it; the file appears only when
/// complete.
void WriteBvhOfSkeleton(const SkeletonSequence& sequence, const std::filesystem::path& path,
                        const BvhExportOptions& options = {});

/// The 20 joints of a BVH: by name and in centimetres when it has the SDK's joints (as
/// BvhOfSkeleton makes them), else by retargeting to the standard body. The one body's id is 1.
/// Throws InputError for unknown names. The BVH is taken, so that a long one need not be there
/// beside the skeletons.
SkeletonSequence SkeletonOfBvh(BvhFile bvh, const std::string& source);

}  // namespace ossa::recon
