#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/experiments/real/real_sets_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {

/// A joint this near to the truth is correct, metres: by definition, the 10 cm of the tables.
inline constexpr double kNearTruth_m = 0.1;

/// The evaluated stages of the tracker, in the order of the data flow.
enum class RealStage { kRaw, kRefined, kFinal, kPeer };
inline constexpr std::array kRealStages = {RealStage::kRaw, RealStage::kRefined, RealStage::kFinal};
std::string_view StageName(RealStage stage);

/// The 20 joints of one stage; empty where it has no position.
using StageJoints = recon::JointArray<std::optional<Eigen::Vector3d>>;
StageJoints JointsAtStage(const tracker::Body& body, RealStage stage);

/// Error of each joint of one still: estimate minus truth, camera axes, metres; only across the
/// line of sight if the truth is a mark. Empty if either is missing.
using JointErrors = std::vector<std::optional<Eigen::Vector3d>>;

struct StillResult {
  size_t bodies = 0;
  std::map<RealStage, JointErrors> errors;
  std::vector<bool> has_truth;             // by joint
  std::vector<bool> tracked{};             // by joint, of the evaluated body, as returned
  std::optional<recon::SurfaceFit> fit{};  // of the evaluated body, with TrackerOptions::fit
  double fit_ms = 0.0;                     // of all bodies
};

/// Evaluates a still; the tracker is reset first. If there are several bodies, the one whose raw
/// joints are nearest to the truth counts.
StillResult EvaluateStill(const RealSet& set, const RealStill& still, tracker::Tracker& tracker);

/// Error of joint `j` of still `i` less the joint's constant offset; empty where the joint is
/// missing, or too few stills give an offset.
std::optional<Eigen::Vector3d> ErrorWithoutOffset(const RealSet& set,
                                                  const std::vector<StillResult>& results,
                                                  RealStage stage, size_t i, size_t j);

/// Accuracy of one stage over a set.
struct StageScore {
  RealStage stage = RealStage::kRaw;
  bool offset_removed = false;                 // of one joint at least; too few stills say none
  std::optional<double> mean_cm;               // of the joints found; none where none is
  double within_5cm = 0.0, within_10cm = 0.0;  // shares of all joints with truth: missing is wrong
  int64_t joints = 0, found = 0;
  std::map<std::string, double> per_joint_10cm;  // share within 10 cm by joint of the set
};

/// Accuracy by state: final joints within 10 cm, offset
/// removed.
struct StateScore {
  int64_t tracked = 0, tracked_within_10cm = 0;
  int64_t others = 0, others_within_10cm = 0;  // inferred or not tracked
  bool offset_removed = false;                 // as of StageScore
};
StateScore ScoreStates(const RealSet& set, const std::vector<StillResult>& results);

/// `counted[j]`: joint j of the set counts.
StageScore ScoreStage(const RealSet& set, const std::vector<StillResult>& results, RealStage stage,
                      bool remove_offset, const std::vector<bool>& counted);

/// Mean errors of raw and of final joints over the joints that both have, offset removed.
struct RawAndFinal {
  int64_t joints = 0;
  double raw_cm = 0.0, final_cm = 0.0;
  bool offset_removed = false;  // as of StageScore
};
RawAndFinal ScoreRawAndFinal(const RealSet& set, const std::vector<StillResult>& results);

/// Measures without truth.
struct VideoScore {
  int64_t frames = 0, bodies = 0, one_body = 0;
  int64_t one_alone = 0, nobody_alone = 0;  // frames, each as if it were the first
  int64_t identity_breaks = 0;              // frames in which somebody goes on under another number
  std::map<RealStage, double> jitter_mm;    // of joints of somebody who holds still
  std::map<RealStage, double> bone_variation;  // standard deviation over mean of bones, per cent
  std::map<RealStage, double> leaps;           // jumps of joints in 100 frames
  double explained = 0.0;  // share of users' pixels within 5 cm of the posed body
};

/// The tracker is reset first, and for stills before each frame.
VideoScore EvaluateVideo(const RealVideo& video, tracker::Tracker& tracker);

}  // namespace ossa::tools
