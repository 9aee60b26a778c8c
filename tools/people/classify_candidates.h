#pragma once
#include <vector>

#include "tools/people/detection.h"

namespace ossa::people {

/// Input of the classification of a frame's candidates.
struct ClassificationInput {
  const PersonClassifier& classifier;
  const DepthFrame& frame;
  const Scene& scene;
  const std::vector<Track>& tracks;
  const PeopleOptions& options;
  // Whether rejected candidates are also cropped and joined, as always in a fresh scene.
  bool thorough = false;
};

/// Classifies the candidates by the forest, and by the pose network where there is one. Pairs that
/// score higher merged than apart are merged; a candidate with several heads is split if its
/// segments are people themselves. Candidates that were merged or split, and rejected segments, go
/// to `decided`.
std::vector<Detection> ClassifyCandidates(const ClassificationInput& with,
                                          std::vector<Candidate> candidates,
                                          std::vector<Decision>& decided);

/// Removes furniture that touches a detected person: cells that are not near any of their bones, if
/// the surface is larger than one person's, or if all bones are known and the segment extends far
/// beyond them.
void CropToBody(const JointTargets& targets, const DepthFrame& frame, const Scene& scene,
                const ClassificationOptions& options, Detection& detection);

/// Whether merging two detections is tried: where they would be two people one above the other
/// (`stacked`); and in the first frames, where the number of people is unknown, if they share a rim
/// and either is classified as a person.
bool MayBePartsOfOnePerson(const Scene& scene, const PeopleOptions& options, const Detection& a,
                           const Detection& b, bool stacked);

/// Whether one is above the other, in the image or over the floor.
bool AreStacked(const Scene& scene, const PeopleOptions& options, const Detection& a,
                const Detection& b);

/// Whether `part` may be a lost person who comes into view again (MayBeReturning at `time_s`), and
/// not a part of the long-lived `track`.
bool MayReturnBeside(const PointGrid& grid, const Detection& part, const Detection& track,
                     const std::vector<Track>& tracks, double time_s, const PeopleOptions& options);

/// Whether `part` was cut off a long-lived track other than `track`.
bool IsOfOtherTrack(const Detection& part, const Detection& track, const std::vector<Track>& tracks,
                    const ClassificationOptions& options = {});

/// The segment, as an index, that covers most of the cells where the track is predicted to be; the
/// first of equals. The head that the forest is most certain of may be another one's.
size_t FindSegmentOf(const PointGrid& grid, const Track& track,
                     const std::vector<Candidate>& segments, double time_s,
                     const PredictionOptions& options = {});

/// Whether a detection with two heads may be split. False for a long-lived track whose surface did
/// not grow: the second head is a misclassification, as on the back of a person who bends down.
bool MayBeTwoPeople(const Detection& whole, const ClassificationOptions& options);

}  // namespace ossa::people
