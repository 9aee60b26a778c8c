#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// Joints of one person at one time. Joints that a sensor does not track are absent; joints that a
/// method has placed without seeing them (recon::HasPlace) count like any other joint.
struct SparsePosture {
  recon::JointArray<Eigen::Vector3d> position_m;
  recon::JointArray<bool> present{};
  recon::JointArray<double> confidence{};

  SparsePosture() { position_m.fill(Eigen::Vector3d::Zero()); }
};

/// One person over time. Times increase.
struct JointTrack {
  std::vector<double> time_s;
  std::vector<SparsePosture> postures;  // as many
};

SparsePosture ToSparsePosture(const recon::BodyRecord& body);

/// The posture at a time, interpolated linearly between two frames at most 0.2 s apart; else empty.
std::optional<SparsePosture> PostureAt(const JointTrack& track, double time_s);

/// Truth and result of the same person at the same times.
struct PairedTracks {
  std::string name;  // which of several true people; empty for one
  std::vector<double> time_s;
  std::vector<SparsePosture> truth;
  std::vector<SparsePosture> result;
  double offset_s = 0.0;   // added to the result's times
  bool same_clock = true;  // the offset was not looked for: the frame times agree
};

enum class TimeAlignment {
  kAuto,       // none where the frame times of both agree, else as kCorrelate
  kNone,       // times are not changed
  kCorrelate,  // the offset with the best cross-correlation of joint speeds: of recordings that
               // began together, or of one clock
  kFixed,      // a given offset
};

struct PairOptions {
  TimeAlignment time = TimeAlignment::kAuto;
  double offset_s = 0.0;  // for kFixed: added to the result's times
  // Correlation looks this far either way; by hand: two recorders started by one person
  double max_offset_s = 2.0;
  bool rigid = false;       // Procrustes without scale over the whole clip, person by person
  bool found_only = false;  // of the result no joints that a method has placed unseen
  /// Called during the clock search, which takes minutes for long recordings; if it returns true,
  /// Interruption (tools/experiments/experiment.h) is thrown.
  std::function<bool()> stop = {};
};

/// Aligns a result with the truth: matches people, aligns clocks, interpolates the truth linearly
/// at the result's times (not across gaps of more than 0.2 s), and optionally applies one rigid
/// transform per clip, after which several people are matched in a common space
/// (compare/assign_bodies.h). Each person of the truth gives a pair. Frames that the result lacks
/// (compare/absent_frames.h) become postures without joints.
std::vector<PairedTracks> PairUp(const recon::SkeletonSequence& truth,
                                 const recon::SkeletonSequence& result,
                                 const PairOptions& options = {});

}  // namespace ossa::tools
