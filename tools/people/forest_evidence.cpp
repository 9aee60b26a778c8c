#include "tools/people/forest_evidence.h"

#include <algorithm>
#include <cmath>

#include "depth/base/stopwatch.h"
#include "forest/proposals/relabel.h"
#include "tools/people/subsample.h"

namespace ossa::people {
namespace {

int ChooseScale(const DepthFrame& frame, const Candidate& candidate,
                const EvidenceOptions& options) {
  constexpr double kNearest_m =
      0.3;  // sensor: by hand, nearer than any measures; against division by 0
  const double z_m = std::max(kNearest_m, static_cast<double>(candidate.region.mean_m.z()));
  int scale = std::clamp(static_cast<int>(options.sample_m * frame.camera.fx / z_m), 1, 8);
  const size_t most =
      candidate.recently_rejected ? options.max_rejected_pixels : options.max_pixels;
  while (candidate.pixels.size() / static_cast<size_t>(scale * scale) > most && scale < 16) {
    ++scale;
  }
  return scale;
}

// Heads that may belong to different people: side by side, and of similar size.
std::vector<Eigen::Vector3d> SelectHeads(const std::vector<HeadCluster>& heads,
                                         const EvidenceOptions& options) {
  std::vector<Eigen::Vector3d> kept;
  for (const HeadCluster& head : heads) {
    const double least_m2 =
        std::max(options.min_head_m2, options.min_head_share * heads.front().area_m2);
    if (head.area_m2 < least_m2) continue;
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](const Eigen::Vector3d& other) {
      return Eigen::Vector2d(head.mean_m.x() - other.x(), head.mean_m.z() - other.z()).norm() >
             options.min_head_distance_m;
    });
    if (apart) kept.push_back(head.mean_m);
  }
  return kept;
}

}  // namespace

ForestEvidence ClassifyCandidate(const PersonClassifier& classifier, const DepthFrame& frame,
                                 const Candidate& candidate, std::vector<float> facing_prior,
                                 double min_surface_score, const EvidenceOptions& options) {
  ForestEvidence evidence;
  const Stopwatch watch;
  evidence.scale = ChooseScale(frame, candidate, options);
  const bool thin = evidence.scale > 1;
  const Subsampled subsampled =
      thin ? Subsample(frame, candidate.pixels, evidence.scale) : Subsampled{};
  const DepthFrame& seen = thin ? subsampled.frame : frame;
  forest::ClassifyOptions classify;
  classify.context_prior = facing_prior;
  evidence.classification = forest::Classify(classifier.model, seen.view(), seen.camera,
                                             thin ? subsampled.pixels : candidate.pixels, classify);
  const auto heads = FindHeadClusters(seen, evidence.classification);
  evidence.heads_m = SelectHeads(heads, options);
  evidence.leg_area_m2 = MeasureLegArea_m2(seen, evidence.classification);
  AddSurfaceFeatures(seen, candidate, evidence.classification, heads, evidence.features);
  evidence.score = ComputeSurfaceScore(evidence.features, options.from_above);
  evidence.classify_ms = watch.milliseconds();
  evidence.proposals.resize(classifier.model.targets().size());
  if (evidence.score < min_surface_score) return evidence;
  const Stopwatch propose_watch;
  evidence.proposals =
      forest::Propose(classifier.model, seen.view(), seen.camera, evidence.classification);
  AddProposalFeatures(evidence.proposals, classifier.targets, evidence.features);
  evidence.score = ComputePersonScore(evidence.features, options.from_above);
  evidence.propose_ms = propose_watch.milliseconds();
  return evidence;
}

forest::Classification LabelParts(const forest::ForestModel& model, const DepthFrame& frame,
                                  const Candidate& candidate, const ForestEvidence& evidence,
                                  depth::Image<uint8_t>& parts) {
  forest::ClassifyOptions options;
  options.context_prior = evidence.classification.context;
  forest::Classification seen =
      forest::Classify(model, frame.view(), frame.camera, candidate.pixels, options);
  const std::vector<uint8_t> labels =
      forest::Relabel(model, frame.view(), frame.camera, seen, evidence.proposals);
  for (size_t i = 0; i < labels.size(); ++i) {
    parts.data[static_cast<size_t>(seen.pixel[i])] = labels[i];
  }
  return seen;
}

}  // namespace ossa::people
