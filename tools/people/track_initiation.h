#pragma once
#include <vector>

#include "tools/people/detection.h"

namespace ossa::people {

/// What was classified and is no person, so far: judged by all observations together, for noise
/// makes single ones vary; what scores low is not classified again in every frame.
struct TentativeTrack {
  std::vector<int> cells;                                  // of the last look, ascending
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();        // of the last look
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();  // of the first one,
  float first_m2 = 0;                                      // ... and its surface
  bool moved = false;                                      // since then
  double walked_m = 0.0;                                   // ... so far over the floor
  double last_seen_s = 0.0;
  double mean_score = 0.0;
  int observations = 1;
  int unbroken_observations = 1;  // of them without a gap
  bool was_rejected = false;      // it was a person, but did not stay one or never moved
  bool was_foreground = false;    // any of it was seen before a known background
  bool is_foreground = false;     // most of it is, and goes on moving
};

/// The candidates that are worth classifying, in their order. What is not goes to `decided`; what
/// was not seen for long is forgotten.
std::vector<Candidate> SelectCandidates(std::vector<Candidate> candidates, bool fresh_scene,
                                        double time_s, const PeopleOptions& options,
                                        std::vector<TentativeTrack>& tentative,
                                        std::vector<Decision>& decided);

/// Whether a detection is a person, and by which rule (`detection.decision`). Of a new person
/// `score` becomes the mean of all observations. Who is none is remembered.
bool DecidePerson(bool fresh_scene, double time_s, const InitiationOptions& options,
                  std::vector<TentativeTrack>& tentative, Detection& detection);

/// The people among detections: those continued first, then by score, at most `max_users`. All
/// others go to `decided`.
std::vector<Detection> SelectPeople(std::vector<Detection> detections, bool fresh_scene,
                                    double time_s, const InitiationOptions& options,
                                    std::vector<TentativeTrack>& tentative,
                                    std::vector<Decision>& decided);

}  // namespace ossa::people
