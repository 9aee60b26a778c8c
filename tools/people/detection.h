#pragma once
#include <optional>
#include <vector>

#include "recon/refine/pose_network.h"
#include "tools/people/candidate.h"
#include "tools/people/decision.h"
#include "tools/people/forest_evidence.h"
#include "tools/people/track.h"

namespace ossa::people {

/// What is known of a candidate's person from the frames before.
struct TrackPrior {
  std::vector<float> facing;    // of the model's contexts; empty: nothing is known
  std::optional<double> score;  // mean of the last seconds
  int age = 0;                  // detections so far
  bool moved = false;           // since it was first seen
  bool moving = false;          // lately
  float full_m2 = 0;            // the most surface seen of it lately
};
TrackPrior MakeTrackPrior(const Candidate& candidate, const std::vector<Track>& tracks,
                          double time_s, const TrackPriorOptions& options);

/// Whose word counts on whether a detection is a person.
enum class Judge {
  kForest,
  kForestAndNetwork,  // the score is of both
  kSurfaceFit,        // the forest is sure of it, the network is not
};

/// A candidate with the forest's word on it; a person once a rule confirms it.
struct Detection {
  Candidate candidate;
  ForestEvidence evidence;
  TrackPrior prior;
  double score = 0.0;      // that it is a person: mean over the frames, [0, 1]
  int age = 1;             // detections of the track, this one included
  bool is_piece = false;   // cut off around one of several heads
  bool is_joined = false;  // of pieces that are nobody by themselves
  Judge judge = Judge::kForest;
  std::optional<recon::NetworkPose> pose{};  // what the network read in these pixels
  Decision decision;                         // why it is a person, or none
  // Of people: what tells them from others, and how they move.
  FrameMeasures measures{};
  Keypoints keypoints_m;
};

/// The score is the forest's and the pose network's.
bool IsJudgedByPose(const Detection& detection);

/// What a decision says of a detection.
Decision DescribeDetection(const Detection& detection, Rule rule, double needed_score);

}  // namespace ossa::people
