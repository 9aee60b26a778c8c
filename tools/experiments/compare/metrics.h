#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// Errors of a result over one clip. Lengths in centimetres; measures that cannot be computed
/// (missing joint, too few frames) are empty.
struct ClipMetrics {
  std::string name;
  int64_t frames = 0;  // that have at least one joint in truth and result
  double offset_s = 0.0;
  bool same_clock = true;

  std::optional<double> mean_joint_error_cm;
  /// Shum 2013 eq. 18 (Plantard 2016 eq. 13): each joint relative to its parent. Departure: the
  /// root, which has none, is not counted (it would count as 0 and lower the mean by 5 %). If a
  /// parent is missing, the nearest ancestor that both have is used; joints without one are left
  /// out.
  std::optional<double> parent_relative_error_cm;
  /// Share of frames whose eq. 13 is 20 cm or more (Plantard 2016, section 8.2).
  std::optional<double> fraction_frames_over_20cm;
  /// PCK at 10 cm: share of true joints found within 10 cm; missing joints count as not found.
  std::optional<double> fraction_joints_within_10cm;
  /// Mean over joints of the average precision at 10 cm (Shotton 2011), joints ranked by
  /// confidence.
  std::optional<double> map_10cm;
  /// Mean length of the difference of second differences, centimetres per frame squared.
  std::optional<double> acceleration_error_cm_per_frame2;
  /// Mean joint error after subtracting each joint's mean offset over the clip.
  std::optional<double> offset_removed_error_cm;
  /// Standard deviation over mean of each bone's length in the result, mean over bones, percent.
  std::optional<double> bone_length_variation_percent;
  std::optional<double> p95_cm;  // percentiles of the joint error
  std::optional<double> p99_cm;
  /// Share of true joints that the result lacks.
  std::optional<double> fraction_joints_missing;
  recon::JointArray<std::optional<double>> per_joint_cm;
  recon::JointArray<std::optional<double>> ap_10cm;
};

ClipMetrics Measure(const PairedTracks& pair);

/// ClipMetrics::parent_relative_error_cm of the mirrored result, left and right exchanged. It is
/// small if the result comes from mirrored depth images.
std::optional<double> MirroredRelativeError_cm(PairedTracks pair);

/// Error of one frame, centimetres, for plots and counts; empty if nothing can be compared.
struct FrameErrors {
  std::vector<std::optional<double>> mean_joint_cm;
  std::vector<std::optional<double>> parent_relative_cm;
};
FrameErrors ErrorsByFrame(const PairedTracks& pair);

/// All joint errors, centimetres, for cumulative curves.
std::vector<double> JointErrors_cm(const PairedTracks& pair);

/// One result over all its clips: the mean of each measure over the clips that have it, independent
/// of their length; frames are summed.
ClipMetrics MeanOverClips(const std::string& name, const std::vector<ClipMetrics>& clips);

/// The values of a measure, for the clips that have it, in their order.
std::vector<double> Values(const std::vector<ClipMetrics>& clips,
                           std::optional<double> ClipMetrics::*member);

/// values[result][clip] of a measure for paired tests, over the clips (matched by name) for which
/// every result has it.
std::vector<std::vector<double>> SharedValues(const std::vector<std::vector<ClipMetrics>>& clips,
                                              std::optional<double> ClipMetrics::*member);

}  // namespace ossa::tools
