#include "tools/people/feature_collector.h"

#include "tools/people/forest_evidence.h"
#include "tools/people/propose_candidates.h"

namespace ossa::people {

struct FeatureCollector::State {
  forest::ForestModel model;
  JointTargets targets;
};

std::span<const std::string_view> PersonFeatureNames() { return kPersonFeatureNames; }
size_t CountSurfaceFeatures() { return static_cast<size_t>(PersonFeature::kTrust); }

FeatureCollector::FeatureCollector(const std::filesystem::path& model) {
  forest::ForestModel read = forest::ReadForestModel(model);
  const auto targets = FindJointTargets(read, model);
  state_ = std::make_unique<State>(State{std::move(read), targets});
}
FeatureCollector::~FeatureCollector() = default;

std::vector<CandidateFeatures> FeatureCollector::Collect(const depth::DepthFrame& frame) const {
  constexpr double kAnyScore = -1;  // a score, so that joints are proposed for everything
  const PeopleOptions options;
  depth::SceneState nothing_before;
  const Scene scene = depth::MeasureScene(frame, nothing_before, options.scene);
  auto proposed =
      ProposeCandidates(frame, scene, {}, options.association.reidentify, options.candidates);
  const PersonClassifier classifier{state_->model, state_->targets};
  std::vector<CandidateFeatures> all;
  for (Candidate& candidate : proposed.candidates) {
    const auto evidence =
        ClassifyCandidate(classifier, frame, candidate, {}, kAnyScore, options.evidence);
    all.push_back({std::move(candidate.pixels),
                   {evidence.features.begin(), evidence.features.end()},
                   evidence.score});
  }
  return all;
}

}  // namespace ossa::people
