#include "tools/people/feature_collector.h"

#include "tools/people/classify_candidates.h"
#include "tools/people/forest_evidence.h"
#include "tools/people/pose_evidence.h"
#include "tools/people/propose_candidates.h"

namespace ossa::people {

struct FeatureCollector::State {
  forest::ForestModel model;
  JointTargets targets;
  PeopleOptions options;
};

namespace {

struct SingleFrame {
  Scene scene;
  std::vector<Candidate> candidates;
};

// Without the state of earlier frames.
SingleFrame ProposeFromSingleFrame(const DepthFrame& frame, const PeopleOptions& options) {
  depth::SceneState empty_state;
  Scene scene = depth::MeasureScene(frame, empty_state, options.scene);
  auto proposed =
      ProposeCandidates(frame, scene, {}, options.association.reidentify, options.candidates);
  return {std::move(scene), std::move(proposed.candidates)};
}

}  // namespace

std::span<const std::string_view> PersonFeatureNames() { return kPersonFeatureNames; }
size_t CountSurfaceFeatures() { return static_cast<size_t>(PersonFeature::kTrust); }

FeatureCollector::FeatureCollector(const std::filesystem::path& model, bool from_above) {
  forest::ForestModel read = forest::ReadForestModel(model);
  const auto targets = FindJointTargets(read, model);
  state_ = std::make_unique<State>(
      State{std::move(read), targets, from_above ? PeopleOptionsFromAbove() : PeopleOptions()});
}
FeatureCollector::~FeatureCollector() = default;

std::vector<CandidateFeatures> FeatureCollector::Collect(const depth::DepthFrame& frame) const {
  constexpr double kAnyScore =
      -1;  // a score below all, so that joints are proposed for every candidate
  const PeopleOptions& options = state_->options;
  SingleFrame single = ProposeFromSingleFrame(frame, options);
  const PersonClassifier classifier{state_->model, state_->targets};
  std::vector<CandidateFeatures> all;
  for (Candidate& candidate : single.candidates) {
    const auto evidence =
        ClassifyCandidate(classifier, frame, candidate, {}, kAnyScore, options.evidence);
    all.push_back({std::move(candidate.pixels),
                   {evidence.features.begin(), evidence.features.end()},
                   evidence.score});
  }
  return all;
}

std::vector<CandidatePose> FeatureCollector::CollectPoses(const depth::DepthFrame& frame,
                                                          const recon::PoseNetwork& network) const {
  const PeopleOptions& options = state_->options;
  SingleFrame single = ProposeFromSingleFrame(frame, options);
  const PersonClassifier classifier{state_->model, state_->targets};
  std::vector<Decision> merged;
  auto detections = ClassifyCandidates({classifier, frame, single.scene, {}, options},
                                       std::move(single.candidates), merged);
  std::vector<CandidatePose> all;
  for (Detection& detection : detections) {
    const double forest = detection.evidence.score;
    if (forest < options.evidence.min_surface_score) continue;
    const auto pose = ReadPose(network, frame, detection.candidate.pixels);
    if (!pose) continue;
    all.push_back({std::move(detection.candidate.pixels), forest, MeasureCertainty(*pose)});
  }
  return all;
}

}  // namespace ossa::people
