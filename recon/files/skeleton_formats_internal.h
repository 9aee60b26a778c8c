#pragma once
#include <array>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "recon/files/text_lines_internal.h"
#include "recon/motion/bone_mapping_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// From frame to frame where a file of a Kinect SDK states no times: 30 Hz, that SDK's rate.
inline constexpr double kKinectStep_s = 1.0 / 30.0;

/// What a reader of one format is given.
struct SkeletonInput {
  std::istream& stream;
  std::string name;      // of the file, for messages
  std::string columns;   // SkeletonReadOptions::columns, "truth", "observed" or ""
  double frame_s = 0.0;  // 0: the format's own usual rate
  /// The text of another file of the same recording, by its whole name; empty when there is none.
  std::function<std::optional<std::string>(const std::string& name)> sibling;
  const BoneMapping* mapping = nullptr;  // of names, where one was given

  double FrameTime_s(double usual_s) const { return frame_s > 0 ? frame_s : usual_s; }
};

/// The beginning of a file, for telling formats apart.
struct SkeletonSample {
  std::string_view name;  // of the file
  std::string_view head;  // its first 64 KiB at most
  /// The first filled lines of the head, without line ends; a last line that may be cut is left out
  /// unless it is the only one.
  std::vector<std::string_view> lines;
};

struct SkeletonFormat {
  std::string_view name;
  bool (*recognises)(const SkeletonSample&);
  SkeletonSequence (*read)(SkeletonInput&);
};

/// Every format, in the order in which they are tried: the ones with unmistakable marks first.
std::span<const SkeletonFormat> AllSkeletonFormats();

// Formats by the file they are written in.
std::span<const SkeletonFormat> PlainFormats();        // skeleton_plain.cpp: jsonl, csv, trc, bvh
std::span<const SkeletonFormat> KinectV1Formats();     // skeleton_kinect_v1.cpp
std::span<const SkeletonFormat> KinectV2Formats();     // skeleton_kinect_v2.cpp
std::span<const SkeletonFormat> PairedFormats();       // skeleton_paired.cpp: UI-PRMD, ITOP
std::span<const SkeletonFormat> UiPrmdFormats();       // skeleton_uiprmd.cpp: its original files
std::span<const SkeletonFormat> AzureFormats();        // skeleton_azure.cpp
std::span<const SkeletonFormat> C3dFormats();          // skeleton_c3d.cpp
std::span<const SkeletonFormat> StreamSaverFormats();  // skeleton_stream_saver.cpp
std::span<const SkeletonFormat> TableFormats();        // skeleton_tables.cpp

/// The file of times that Kinect Stream Saver writes beside its joints: no recording of its own.
inline constexpr const char* kSaverTimes = "liTimeStamp.binary";
/// UI-PRMD's joint angles, which are read together with the positions they belong to.
bool HoldsAngles(std::string_view name);

/// Puts a joint into a body unless the position is the "no reading" of its format.
inline void PutJoint(BodyRecord& body, Joint joint, const Eigen::Vector3d& position_m,
                     std::optional<TrackingState> state = std::nullopt) {
  JointRecord record;
  record.position_m = position_m;
  record.state = state;
  body.joints[joint] = record;
}

/// A frame with one body, id 1.
inline SkeletonFrame OneBodyFrame(size_t index, double time_s, BodyRecord body) {
  SkeletonFrame frame;
  frame.frame = static_cast<int64_t>(index);
  frame.time_s = time_s;
  body.id = 1;
  frame.bodies.push_back(std::move(body));
  return frame;
}

/// Of formats whose frames hold a body whatever was seen: in a recording of which no frame has a
/// joint there is nobody. (Of somebody who is lost for a while the body stays, without joints.)
void TakeOutNobody(SkeletonSequence& sequence);

/// Throws unless the sequence has frames: an empty file is never a silent success.
void RequireFrames(const SkeletonSequence& sequence);

/// How our own formats say a TrackingState, by its value.
inline constexpr std::array<std::string_view, 3> kStateNames = {"not_tracked", "inferred",
                                                                "tracked"};
/// The state of that name; none of another.
std::optional<TrackingState> FindState(std::string_view name);

// Our own formats beside JSONL.
SkeletonSequence ReadSkeletonCsv(SkeletonInput& input);
std::string SkeletonCsvHead();
/// A row a body; a frame with nobody has one, too.
std::string SkeletonCsvRows(const SkeletonFrame& frame);
SkeletonSequence ReadTrc(SkeletonInput& input);

}  // namespace ossa::recon
