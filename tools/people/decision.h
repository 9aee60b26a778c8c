#pragma once
#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace ossa::people {

/// Which rule decided about a segment of the scene. Texts: DescribeRule.
enum class Rule {
  // Excluded by geometry.
  kTooSmall,
  kFurniture,
  kBackground,
  // Not classified.
  kCandidateLimit,
  kRejectedBefore,
  // Merged or split: the result is another entry.
  kMerged,
  kSplitAtHeads,
  // Rejected or tentative.
  kPlanar,
  kFirstLook,
  kFewObservations,
  kLowMeanScore,
  kTrackLowScore,
  kPieceLowScore,
  kUserLimit,
  kUnlikeABody,
  // A person.
  kTrackContinued,
  kTrackRests,
  kFreshScene,
  kReturning,
  kEntered,
  kEnoughObservations,
  kPieceWithHead,
  kJoinedPieces,
  kCount
};

/// The result for a segment of the scene. Texts: NameOutcome.
enum class Outcome {
  kExcluded,   // by geometry
  kMerged,     // into another entry
  kRejected,   // the score is too low
  kTentative,  // classified again in the next frames
  kConfirmed,  // accepted as a person; `track` is the id
};

/// A short name for files, e.g. "too_small"; a one-line explanation.
std::string_view NameRule(Rule rule);
std::string_view DescribeRule(Rule rule);
std::string_view NameOutcome(Outcome outcome);
Outcome FindOutcome(Rule rule);

/// Why a segment of the scene was accepted as a person or not.
struct Decision {
  Rule rule = Rule::kFirstLook;
  Eigen::Vector3d place_m =
      Eigen::Vector3d::Zero();  // centroid of the visible surface, camera space
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  // of its bounding box
  double area_m2 = 0;                                // of the surface, as seen frontally
  bool classified = false;                           // the members below are set
  double score = 0;         // probability of being a person in this frame alone, [0, 1]
  double mean_score = 0;    // mean over all observations, [0, 1]
  double needed_score = 0;  // threshold of the rule; above 1: cannot be reached
  int observations = 0;     // detections of the track, or observations of the tentative track
  int track = 0;            // id of the person; 0 for none
};

/// Confirmed: seen in this frame. Lost: out of view, but may return.
enum class TrackStatus { kConfirmed, kLost };
/// A tracked person.
struct TrackSummary {
  int id = 0;
  TrackStatus status = TrackStatus::kConfirmed;
  double last_seen_s = 0;
  int age = 0;  // detections
};

/// All decisions of one frame, and the tracks after it.
struct FrameDecisions {
  bool fresh_scene = false;  // the first frame, or the first after the scene changed
  std::vector<Decision> candidates;
  std::vector<TrackSummary> tracks;
};

}  // namespace ossa::people
