#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "recon/refine/pose_network.h"
#include "tools/people/candidate.h"
#include "tools/people/decision.h"
#include "tools/people/forest_evidence.h"
#include "tools/people/track.h"

namespace ossa::people {

/// Prior of a candidate from its track.
struct TrackPrior {
  std::vector<float> facing;    // probability of each of the model's contexts; empty: unknown
  std::optional<double> score;  // weighted mean over the frames
  int age = 0;                  // detections so far
  bool moved = false;           // since it was first seen
  bool moving = false;          // recently
  bool certain = false;         // a person for sure not long ago
  double lay_s = -std::numeric_limits<double>::infinity();  // as Track::lay_s
  float full_m2 = 0;                                        // largest recent visible surface
};
TrackPrior MakeTrackPrior(const Candidate& candidate, const std::vector<Track>& tracks,
                          double time_s, const TrackPriorOptions& options);

/// Which model decides whether a detection is a person.
enum class Verifier {
  kForest,
  kForestAndNetwork,  // the score combines both
  kSurfaceFit,        // the forest is confident, the network is not
};

/// A classified candidate; a person once a rule accepts it.
struct Detection {
  Candidate candidate;
  ForestEvidence evidence;
  TrackPrior prior;
  double score = 0.0;       // probability of being a person: weighted mean over the frames, [0, 1]
  int age = 1;              // detections of the track, this one included
  bool is_piece = false;    // a segment around one of several heads
  bool is_cut_off = false;  // ... and was somebody else's who is tracked, where nothing has moved
  bool is_joined = false;   // merged from regions that are no person by themselves
  bool was_withdrawn = false;  // accepted before, and withdrawn because no fitted body explained it
  Verifier verifier = Verifier::kForest;
  std::optional<recon::NetworkPose> pose{};  // joints by the pose network, where it was applied
  Decision decision;                         // why it was accepted or not
  // Of people, for association: body measures and keypoints.
  FrameMeasures measures{};
  Keypoints keypoints_m;
};

/// Whether the score combines the forest and the pose network.
bool IsVerifiedByPose(const Detection& detection);

/// Whether the forest is confident and the network is not, so that the surface fit decides.
bool IsContested(const Detection& detection);

/// The decision record of a detection.
Decision DescribeDetection(const Detection& detection, Rule rule, double needed_score);

}  // namespace ossa::people
