#pragma once
#include <vector>

#include "depth/image/image.h"
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "tools/people/candidate.h"
#include "tools/people/joint_targets.h"
#include "tools/people/person_features.h"

namespace ossa::recon {
class PoseNetwork;  // recon/refine/pose_network.h
}

namespace ossa::people {

/// The forest, its targets for the joints, and an optional pose network.
struct PersonClassifier {
  const forest::ForestModel& model;
  const JointTargets& targets;
  const recon::PoseNetwork* network = nullptr;  // null: the forest alone decides
};

/// The classification of one candidate by the forest.
struct ForestEvidence {
  forest::Classification classification;
  int scale = 1;  // classified on every scale-th pixel in both directions
  std::vector<std::vector<forest::Proposal>> proposals;  // by target of the model, best first
  std::vector<Eigen::Vector3d> heads_m;  // clusters of head pixels, largest first, camera space
  double leg_area_m2 = 0.0;              // of samples labelled as legs
  PersonFeatures features{};
  double score = 0.0;  // probability of being a person, [0, 1]
  double classify_ms = 0.0, propose_ms = 0.0;
};

/// Classifies a candidate. `facing_prior`: probability of each of the model's contexts, empty for
/// its own (forest::ClassifyOptions). Joints are proposed only if the score by the surface is at
/// least `min_surface_score`.
ForestEvidence ClassifyCandidate(const PersonClassifier& classifier, const DepthFrame& frame,
                                 const Candidate& candidate, std::vector<float> facing_prior,
                                 double min_surface_score, const EvidenceOptions& options);

/// Writes the part labels of the candidate's pixels into an image of the frame's size: classified
/// again at full resolution, given the facing and the joints (forest::Relabel). Returns the
/// classification by the trees alone.
forest::Classification LabelParts(const forest::ForestModel& model, const DepthFrame& frame,
                                  const Candidate& candidate, const ForestEvidence& evidence,
                                  depth::Image<uint8_t>& parts);

}  // namespace ossa::people
