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
  Perception perception;      // its person_score is the mean over the looks
  double single_score = 0.0;  // of this look
  int looks = 1;
  bool moved = false;   // of somebody known: since it was first seen,
  bool moving = false;  // ... and lately
  float full_m2 = 0;    // the most surface seen of them lately
};

/// What was looked at and not taken for a person, so far: judged by all looks together, for noise
/// makes single ones vary; what is hopeless is not looked at again in every frame.
struct Doubt {
  std::vector<int> cells;  // of the last look, ascending
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();
  float first_m2 = 0;   // surface at the first look
  bool moved = false;   // since then
  double time_s = 0.0;  // of the last look
  double mean_score = 0.0;
  int looks = 1;
  int unbroken = 1;          // of them without a gap
  bool fallen = false;       // it was taken for a person, but did not stay one or never moved
  bool before_room = false;  // any of it was seen where the room behind was seen before
  bool arrived = false;      // it came here, and goes on moving
  double went_m = 0.0;       // from the first look's place
};

struct FinderState {
  std::vector<Doubt> doubts;
};

struct Known {
  std::vector<float> context_prior;    // of its facing (ClassifyOptions)
  std::optional<double> person_score;  // mean of the last seconds
  int looks = 0;                       // that mean is of
  bool moved = false;                  // since it was first seen
  bool moving = false;                 // lately
  float full_m2 = 0;                   // the most surface seen of it lately
};

/// What candidates are looked at with.
struct Eyes {
  const forest::ForestModel& model;
  const recon::JointArray<int>& targets;
  /// What is known of a candidate's person from before.
  std::function<Known(const depth::Candidate&)> known;
};

struct FindOptions {
  int max_users = 6;
  int threads = 1;
  // Of a newcomer with a head's shape in a fresh scene, where there is one look only, or as the
  // mean of a few looks at what moved; of other newcomers in a fresh scene, and as the mean of a
  // few looks at what stands still; and of somebody tracked a moment ago: hysteresis keeps a person
  // who turns away.
  double new_person = 0.6;
  double sure_person = 0.93;
  int probation_looks = 4;
  int standing_looks = 3;  // of what has not moved, unbroken: scraps of furniture come and go
  double known_person = 0.25;
  // Of what came into view where the room was seen before: furniture does not. At the first look;
  // and, where something nearer hides part of it, so that little is seen, as the mean of a few.
  double sure_arrived = 0.6;
  double arrived_person = 0.15;
  double arrived_known = 0.02;  // ... and once it was accepted, while it moves
  // ... and of what also went so far over the floor since the first look, with nobody beside whose
  // rest it may be: only people walk.
  double walked_m = 0.5;
  double walked_person = 0.02;
  // Of somebody accepted a few looks ago: what was a person by luck is none on average.
  double young_person = 0.4;
  int young_looks = 12;
  // Of what has not moved at all after so many looks: most likely furniture. Of somebody accepted
  // less, for who sits behind a thing that does not move seems not to move, either.
  double still_person = 0.75;
  double still_known = 0.7;
  int still_looks = 10;
  size_t max_candidates = 16;  // looked at per frame, the largest first
  double hopeful = 0.35;       // what scores less is looked at again only ...
  double look_again_s = 0.25;  // ... so much later
  double forget_s = 2.0;       // a doubt that is not renewed
  double memory = 0.85;        // share of a known person's mean score in the new one
  int grown_up_looks = 30;     // after so many a person is not taken for part of another,
  float grown_share = 1.2F;    // ... nor for two, unless so much more is there than was lately
};

/// The same thing looked at before, at the same place unless it moves; null if there was none.
Doubt* DoubtOf(const depth::Candidate& candidate, double time_s, FinderState& state);

/// Most of it stands where the room behind it was seen before.
bool Arrived(const depth::Candidate& candidate);

/// Some of it may be out of sight: little consent is asked for. What is seen whole must look like a
/// person, however it came: dogs and pushed chairs come, too.
bool MayHideMore(const depth::Candidate& candidate);

/// Whether what was looked at is somebody; what is not is remembered.
bool Accepted(Found& looked, const depth::Scene& scene, double time_s, const FindOptions& options,
              FinderState& state);

/// One above the other, as the sensor sees it or over the floor.
bool Stacked(const depth::Scene& scene, const Found& a, const Found& b);

/// Pieces of two regions are tried as one person where they would be two people, one above the
/// other
/// (`stacked`); and at first, when nobody knows how many there are, where they meet and either
/// looks like a person.
bool MayBeParts(const depth::Scene& scene, const FindOptions& options, const Found& a,
                const Found& b, bool stacked);

/// False of somebody tracked for long of whom no more shows than before: where the forest sees a
/// second head, as on the back of who bends down, nobody came.
bool MayBeTwo(const Found& whole, const FindOptions& options);

/// What hangs on to a person and is not near any of their bones is furniture: it is taken off where
/// more is held than a person has, or where all bones are known and something reaches far beyond
/// them. `targets` as in Eyes.
void TrimToBody(const recon::JointArray<int>& targets, const depth::DepthFrame& frame,
                const depth::Scene& scene, Found& found);

/// The people among the scene's candidates, known ones first. Candidates with two heads are cut;
/// pieces of one region that are more of a person together than alone are joined.
std::vector<Found> FindPeople(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, FinderState& state);

}  // namespace ossa::tracker
