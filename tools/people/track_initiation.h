#pragma once
#include <vector>

#include "tools/people/detection.h"

namespace ossa::people {

/// A classified candidate that is not accepted as a person so far. The decision is by the mean over
/// its observations, because noise makes single ones vary; with a low score it is not classified in
/// every frame.
struct TentativeTrack {
  std::vector<int> cells;                                  // of the last observation, ascending
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();        // of the last observation
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();  // of the first observation
  float first_m2 = 0;                                      // the same
  bool moved = false;                                      // since then
  double walked_m = 0.0;  // horizontal distance from the first observation
  double last_seen_s = 0.0;
  double mean_score = 0.0;
  int observations = 1;
  int unbroken_observations = 1;  // consecutive ones, to the last
  bool was_rejected = false;      // it was accepted before, and rejected later
  bool was_withdrawn = false;     // ... because no fitted body explained it
  bool was_contested = false;     // forest and network disagreed about an observation
  bool was_foreground = false;    // some of it was foreground
  bool is_foreground = false;     // most of it was foreground in the last observation
  bool is_joined = false;         // it is one of several regions together (Detection::is_joined)
};

/// The first observation of a tentative track.
TentativeTrack StartTentative(const Detection& detection, double time_s);

/// The candidates to classify in this frame, in their order. The others go to `decided`. Deletes
/// old tentative tracks.
std::vector<Candidate> SelectCandidates(std::vector<Candidate> candidates, bool fresh_scene,
                                        double time_s, const PeopleOptions& options,
                                        std::vector<TentativeTrack>& tentative,
                                        std::vector<Decision>& decided);

/// Marks the cells where a tentative track is that has scored like a person more than once: they
/// touch furniture in most frames, or are hardly separable from a wall, and must not become part of
/// the room before there are enough observations.
void MarkLikelyPeople(const std::vector<TentativeTrack>& tentative,
                      const InitiationOptions& options, std::vector<uint8_t>& marked);

/// The score that a segment around one of several heads needs to be a person: more if its region
/// was one person so far, whose track another segment continues. They may hold a carton.
double RequireOfPiece(const Detection& piece, bool one_so_far, const InitiationOptions& options);

/// Decides whether a detection is a person, and by which rule (`detection.decision`). Of a new
/// person `score` becomes the mean of all observations. A rejected detection becomes a tentative
/// track.
bool DecidePerson(bool fresh_scene, double time_s, const InitiationOptions& options,
                  std::vector<TentativeTrack>& tentative, Detection& detection);

/// The accepted people: tracked ones first, then by score, at most `max_users`. All others go to
/// `decided`.
std::vector<Detection> SelectPeople(std::vector<Detection> detections, bool fresh_scene,
                                    double time_s, const InitiationOptions& options,
                                    std::vector<TentativeTrack>& tentative,
                                    std::vector<Decision>& decided);

}  // namespace ossa::people
