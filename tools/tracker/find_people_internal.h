#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "depth/scene/scene.h"
#include "forest/forest.h"
#include "tools/tracker/perceive_internal.h"

namespace ossa::tracker {

/// A candidate the forest takes for a person.
struct Found {
  depth::Candidate candidate;
  Perception perception;
};

/// What was looked at and found to be no person: it is not looked at again in every frame, and
/// then judged by all looks together, for noise makes single ones vary.
struct Rejection {
  std::vector<int> cells;  // ascending
  double time_s = 0.0;     // of the last look
  double mean_score = 0.0;
  int looks = 1;
};

struct FinderState {
  std::vector<Rejection> rejections;
};

struct Known {
  std::vector<float> context_prior;    // of its facing (ClassifyOptions)
  std::optional<double> person_score;  // mean of the last seconds
};

/// What candidates are looked at with.
struct Eyes {
  const forest::ForestModel& model;
  const std::array<int, recon::kJointCount>& targets;
  /// What is known of a candidate's person from before.
  std::function<Known(const depth::Candidate&)> known;
};

struct FindOptions {
  int max_users = 6;
  int threads = 1;
  // Of a newcomer, and of somebody tracked a moment ago: hysteresis keeps a person who turns away.
  double new_person = 0.6;
  double known_person = 0.25;
  bool keep_resolution = false;  // see PerceiveOptions
  size_t max_candidates = 16;    // looked at per frame, the largest first
  double look_again_s = 0.25;    // a quarter of a second late nobody notices
  double forget_s = 2.0;         // a rejection that is not renewed
  double memory = 0.85;          // share of a known person's mean score in the new one
};

/// The people among the scene's candidates, known ones first; candidates with two heads are cut and
/// looked at again.
std::vector<Found> FindPeople(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, FinderState& state);

}  // namespace ossa::tracker
