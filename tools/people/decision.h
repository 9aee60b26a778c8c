#pragma once
#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace ossa::people {

/// Which rule decided about a piece of the scene. Texts: DescribeRule.
enum class Rule {
  // Geometry: it never was a candidate.
  kTooSmall,
  kFurniture,
  kBackground,
  // It was not classified.
  kCandidateLimit,
  kRejectedBefore,
  // It became part of something else, whose decision is another entry.
  kMerged,
  kSplitAtHeads,
  // Not, or not yet, a person.
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
  kFreshScene,
  kReturning,
  kEntered,
  kEnoughObservations,
  kPieceWithHead,
  kJoinedPieces,
  kCount
};

/// What became of a piece of the scene. Texts: NameOutcome.
enum class Outcome {
  kExcluded,   // by geometry
  kMerged,     // in another entry
  kRejected,   // the forest takes it for no person
  kTentative,  // looked at again in the next frames
  kConfirmed,  // a person; `track` is the id
};

/// A short name for files, e.g. "too_small"; what it means, one line.
std::string_view NameRule(Rule rule);
std::string_view DescribeRule(Rule rule);
std::string_view NameOutcome(Outcome outcome);
Outcome FindOutcome(Rule rule);

/// Why a piece of the scene was taken for a person or not.
struct Decision {
  Rule rule = Rule::kFirstLook;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // middle of the seen surface, camera space
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();   // of the box around it
  double area_m2 = 0;                                 // of the surface, as seen frontally
  bool classified = false;                            // what follows was computed
  double score = 0;         // that it is a person by the forest, this look alone, [0, 1]
  double mean_score = 0;    // ... and all observations
  double needed_score = 0;  // that the rule asks for; above 1: no score is enough
  int observations = 0;     // detections of the track, or observations of the tentative one
  int track = 0;            // id of the person; 0 nobody
};

/// Confirmed tracks are seen, lost ones are remembered.
enum class TrackStatus { kConfirmed, kLost };
/// Somebody who is followed.
struct TrackSummary {
  int id = 0;
  TrackStatus status = TrackStatus::kConfirmed;
  double last_seen_s = 0;
  int age = 0;  // detections
};

/// All decisions of one frame, and who is followed after it.
struct FrameDecisions {
  bool fresh_scene = false;  // no frame of this scene was seen a moment ago
  std::vector<Decision> candidates;
  std::vector<TrackSummary> tracks;
};

}  // namespace ossa::people
