#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/depth/scene/shots.h"
#include "tools/people/associate_tracks.h"
#include "tools/people/detect_people.h"
#include "tools/people/propose_candidates.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {

using depth::GridOf;
using depth::KinectV1Camera;
using depth::PersonAt;
using depth::Shot;
using tests::CapsulePose;
using tests::CapsuleRender;
using tests::CapsuleScene;

/// The candidates of a frame by geometry and tracks.
struct Proposed {
  Scene scene;
  std::vector<Candidate> candidates;
  std::vector<Decision> excluded;
};

/// The steps of DetectPeople before classification.
inline Proposed Propose(const CapsuleRender& render, PeopleState& state,
                        const PeopleOptions& options = {}) {
  const DepthFrame& frame = render.frame;
  const ReidentifyOptions& reidentify = options.association.reidentify;
  Proposed result;
  result.scene = depth::MeasureScene(frame, state.scene, options.scene);
  auto& tracks = state.tracks.tracks;
  std::erase_if(tracks, [&](const Track& track) {
    return result.scene.changed || IsForgotten(track, frame.time_s, reidentify);
  });
  auto proposed = ProposeCandidates(frame, result.scene, tracks, reidentify, options.candidates,
                                    options.trace_surfaces);
  result.candidates = std::move(proposed.candidates);
  result.excluded = std::move(proposed.excluded);
  return result;
}

inline Proposed ProposeAlone(const CapsuleRender& render) {
  PeopleState state;
  return Propose(render, state);
}

/// The steps after classification, which accepted these candidates with this score: their ids.
inline std::vector<int> Confirm(const Proposed& proposed, const std::vector<Candidate>& people,
                                double time_s, PeopleState& state,
                                const std::vector<Keypoints>& keypoints_m = {},
                                double score = 0.0) {
  std::vector<Detection> detections(people.size());
  for (size_t i = 0; i < people.size(); ++i) {
    detections[i].candidate = people[i];
    detections[i].score = score;
    if (!keypoints_m.empty()) detections[i].keypoints_m = keypoints_m[i];
  }
  const auto ids = AssociateTracks(proposed.scene, FindRivals(proposed.candidates), detections,
                                   time_s, state.tracks);
  depth::LearnBackground(proposed.scene.grid,
                         MarkPeople(proposed.scene, detections, state.tracks.tracks, time_s),
                         state.scene.background);
  return ids;
}

/// The share of a person's pixels that a candidate has, and of the candidate that is the person's.
inline std::pair<double, double> MeasureCover(const CapsuleRender& render,
                                              const Candidate& candidate, int person) {
  double whole = 0, common = 0;
  for (const uint8_t p : render.person.data) whole += p == person ? 1 : 0;
  for (const int32_t pixel : candidate.pixels)
    common += render.person.data[static_cast<size_t>(pixel)] == person ? 1 : 0;
  return {common / whole, common / static_cast<double>(candidate.pixels.size())};
}

}  // namespace ossa::people
