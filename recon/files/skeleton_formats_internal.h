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

/// Frame time of Kinect SDK files that state no times: 30 Hz, that SDK's rate.
inline constexpr double kKinectStep_s = 1.0 / 30.0;

/// Input of a format's reader.
struct SkeletonInput {
  std::istream& stream;
  std::string name;      // of the file; for messages
  std::string columns;   // SkeletonReadOptions::columns, "truth", "observed" or ""
  double frame_s = 0.0;  // frame time to assume; 0: the format's default
  /// The text of another file of the same recording, by its full name; empty if there is none.
  std::function<std::optional<std::string>(const std::string& name)> sibling;
  const BoneMapping* mapping = nullptr;  // joint names of a mapping file, if one was given

  double FrameTime_s(double usual_s) const { return frame_s > 0 ? frame_s : usual_s; }
};

/// The beginning of a file, for recognising its format.
struct SkeletonSample {
  std::string_view name;  // of the file
  std::string_view head;  // its first 64 KiB at most
  /// The first non-blank lines of the head, without line ends. A last line that may be truncated is
  /// left out, unless it is the only one.
  std::vector<std::string_view> lines;
};

struct SkeletonFormat {
  std::string_view name;
  bool (*recognises)(const SkeletonSample&);
  SkeletonSequence (*read)(SkeletonInput&);
};

/// All formats in the order in which they are tried: unambiguous ones first.
std::span<const SkeletonFormat> AllSkeletonFormats();
/// Throws InputError with the known names.
const SkeletonFormat& FormatNamed(const std::string& format);
/// The format of a file by its beginning; the stream is then at the beginning again. Throws
/// InputError that says what the file seems to be.
const SkeletonFormat& DetectFormat(std::istream& stream, const std::string& name);

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
std::span<const SkeletonFormat> XefFormats();          // skeleton_xef.cpp
std::span<const SkeletonFormat> DataSetFormats();      // skeleton_data_sets.cpp: MSRC-12 and others

/// The file of times that Kinect Stream Saver writes beside its joints; not a recording itself.
inline constexpr const char* kSaverTimes = "liTimeStamp.binary";
/// Whether this is one of UI-PRMD's joint angle files, which are read together with their
/// positions.
bool HoldsAngles(std::string_view name);

/// Adds a joint to a body, unless the position is the format's "no reading".
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

/// For formats whose frames hold a body even if nothing was seen: removes the bodies of a recording
/// in which no frame has a joint. (A person who is lost for a while stays, without joints.)
void RemoveEmptyBodies(SkeletonSequence& sequence);

/// Throws unless the sequence has frames: an empty file is never a silent success.
void RequireFrames(const SkeletonSequence& sequence);

/// Names of TrackingState in our own formats, by value.
inline constexpr std::array<std::string_view, 3> kStateNames = {"not_tracked", "inferred",
                                                                "tracked"};
/// The state of that name; none for an unknown name.
std::optional<TrackingState> FindState(std::string_view name);

// Our own formats beside JSONL.
SkeletonSequence ReadSkeletonCsv(SkeletonInput& input);
std::string SkeletonCsvHead();
/// One row per body; a frame without bodies has one row, too.
std::string SkeletonCsvRows(const SkeletonFrame& frame);
SkeletonSequence ReadTrc(SkeletonInput& input);

}  // namespace ossa::recon
