#pragma once
#include <vector>

#include "tools/people/detection.h"

namespace ossa::people {

/// What candidates are classified with.
struct Classifying {
  const PersonClassifier& classifier;
  const DepthFrame& frame;
  const Scene& scene;
  const std::vector<Track>& tracks;
  const PeopleOptions& options;
};

/// Candidates with the forest's word on them. Those that look more like one person together than
/// alone are merged; one with several heads is cut where the pieces are people themselves. What
/// became part of others, and pieces that are nobody, go to `decided`.
std::vector<Detection> ClassifyCandidates(const Classifying& with,
                                          std::vector<Candidate> candidates,
                                          std::vector<Decision>& decided);

/// Takes off a detected person the furniture that hangs on: what is not near any of their bones,
/// where more is held than a person has, or where all bones are known and something reaches far
/// beyond them.
void CropToBody(const JointTargets& targets, const DepthFrame& frame, const Scene& scene,
                const ClassificationOptions& options, Detection& detection);

/// Whether two pieces are tried as one person: where they would be two people one above the other
/// (`stacked`); and at first, when nobody knows how many there are, where they meet and either
/// looks like a person.
bool MayBePartsOfOne(const Scene& scene, const PeopleOptions& options, const Detection& a,
                     const Detection& b, bool stacked);

/// Whether one is above the other, as the sensor sees it or over the floor.
bool AreStacked(const Scene& scene, const PeopleOptions& options, const Detection& a,
                const Detection& b);

/// False of somebody tracked for long of whom no more shows than before: where the forest sees a
/// second head, as on the back of who bends down, nobody came.
bool MayBeTwo(const Detection& whole, const ClassificationOptions& options);

}  // namespace ossa::people
