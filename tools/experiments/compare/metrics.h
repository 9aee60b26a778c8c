#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// How far a result is from the truth over one clip. Lengths in centimetres; a number that cannot
/// be had (no such joint, too few frames) is empty.
struct ClipMetrics {
  std::string name;
  int64_t frames = 0;  // that have at least one joint in truth and result
  double offset_s = 0.0;
  bool same_clock = true;

  std::optional<double> mean_joint_error_cm;
  /// Shum 2013 eq. 18 (Plantard 2016 eq. 13): each joint relative to its parent. Where a file has
  /// no such parent, the nearest ancestor that both have stands in; joints without any are left
  /// out.
  std::optional<double> parent_relative_error_cm;
  /// Share of frames whose eq. 13 is 20 cm or more (Plantard 2016, section 8.2).
  std::optional<double> fraction_frames_over_20cm;
  /// PCK at 10 cm: true joints that are found within 10 cm; a missing joint is not found.
  std::optional<double> fraction_joints_within_10cm;
  /// Mean over joints of the average precision at 10 cm (Shotton 2011), joints ranked by
  /// confidence.
  std::optional<double> map_10cm;
  /// Mean length of the difference of second differences, centimetres per frame squared.
  std::optional<double> acceleration_error_cm_per_frame2;
  /// Mean joint error after each joint's constant offset over the clip is taken away.
  std::optional<double> offset_removed_error_cm;
  /// Standard deviation over mean of each bone's length in the result, mean over bones, percent.
  std::optional<double> bone_length_variation_percent;
  std::optional<double> p95_cm;  // percentiles of the joint error
  std::optional<double> p99_cm;
  /// True joints that the result does not have.
  std::optional<double> fraction_joints_missing;
  recon::JointArray<std::optional<double>> per_joint_cm;
  recon::JointArray<std::optional<double>> ap_10cm;
};

ClipMetrics Measure(const PairedTracks& pair);

/// ClipMetrics::parent_relative_error_cm of the result as a mirror shows it, left and right
/// exchanged: small where its depth images were mirrored and nobody said so.
std::optional<double> MirroredRelativeError_cm(PairedTracks pair);

/// Error of one frame, centimetres, for plots and counts; empty where nothing can be compared.
struct FrameErrors {
  std::vector<std::optional<double>> mean_joint_cm;
  std::vector<std::optional<double>> parent_relative_cm;
};
FrameErrors ErrorsByFrame(const PairedTracks& pair);

/// All joint errors, centimetres, for cumulative curves.
std::vector<double> JointErrors_cm(const PairedTracks& pair);

/// One result over all its clips: every number is the mean over the clips that have it, so that a
/// long clip counts as much as a short one; frames are summed.
ClipMetrics MeanOverClips(const std::string& name, const std::vector<ClipMetrics>& clips);

/// A number of the clips that have it, in their order.
std::vector<double> Values(const std::vector<ClipMetrics>& clips,
                           std::optional<double> ClipMetrics::*member);

/// values[result][clip] of clips[result][clip], for paired tests: only of the clips, known by their
/// names, of which every result has the number.
std::vector<std::vector<double>> SharedValues(const std::vector<std::vector<ClipMetrics>>& clips,
                                              std::optional<double> ClipMetrics::*member);

}  // namespace ossa::tools
