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

/// The forest that people are told by, which of its targets are their joints, and the network that
/// has its say about who is new.
struct PersonClassifier {
  const forest::ForestModel& model;
  const JointTargets& targets;
  const recon::PoseNetwork* network = nullptr;  // null: the forest's word is all
};

/// What the forest says of one candidate.
struct ForestEvidence {
  forest::Classification classification;
  int scale = 1;  // classified on every scale-th pixel of the frame both ways
  std::vector<std::vector<forest::Proposal>> proposals;  // by target of the model, best first
  std::vector<Eigen::Vector3d> heads_m;  // clusters of head pixels, largest first, camera space
  double leg_area_m2 = 0.0;              // of samples labelled as legs
  PersonFeatures features{};
  double score = 0.0;  // that it is a person, [0, 1]
  double classify_ms = 0.0, propose_ms = 0.0;
};

/// `facing_prior`: of the model's contexts, empty for its own (forest::ClassifyOptions). Joints are
/// proposed only where the surface alone scores `min_surface_score`.
ForestEvidence ClassifyCandidate(const PersonClassifier& classifier, const DepthFrame& frame,
                                 const Candidate& candidate, std::vector<float> facing_prior,
                                 double min_surface_score, const EvidenceOptions& options);

/// Labels of the candidate's pixels into an image of the frame's size: classified once more at full
/// resolution, with the facing and the joints in mind that are known by then (forest::Relabel).
/// Returns what the trees alone say of them.
forest::Classification LabelParts(const forest::ForestModel& model, const DepthFrame& frame,
                                  const Candidate& candidate, const ForestEvidence& evidence,
                                  depth::Image<uint8_t>& parts);

}  // namespace ossa::people
