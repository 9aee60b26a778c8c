// Learns how much modes are trusted relative to the prediction by other targets, and the
// probability that the fused position is correct, on images never used for training.
#include <oneapi/tbb/parallel_for.h>

#include "forest/proposals/refinement_internal.h"
#include "forest/training/validation_internal.h"

namespace ossa::forest {
namespace {

// Constants: precisions asked for, by hand.

constexpr double kTrackedPrecision = 0.90;   // share
constexpr double kInferredPrecision = 0.50;  // share

// Inference results of an image, and the refined targets, if there is a refinement.
struct InferredImage : FirstStage {
  std::vector<RefinedPlace> refined;

  const RefinedPlace* refined_place(size_t t) const {
    return refined.empty() ? nullptr : &refined[t];
  }
};

std::vector<InferredImage> InferAll(const ForestModel& model,
                                    const std::vector<ValidationImage>& images) {
  std::vector<InferredImage> inferred(images.size());
  const RoundedPerceptron& refinement = model.refinement();
  oneapi::tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) {
    const ValidationImage& image = images[i];
    InferredImage& one = inferred[i];
    static_cast<FirstStage&>(one) = RunFirstStage(model, image);
    if (refinement.empty()) return;
    one.refined = Refine(refinement, ComputeJointFeatures(model, image.camera, image.evidence,
                                                          image.context, one.modes, one.marginals));
  });
  return inferred;
}

// Number of hits within 10 cm, plus half for each within 5 cm.
double Score(const std::vector<ValidationImage>& images, const std::vector<InferredImage>& inferred,
             size_t t, double noise_m) {
  double score = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    if (!images[i].target_m[t].allFinite()) continue;
    const Eigen::Vector3d place =
        Fuse(inferred[i].marginals.target[t], inferred[i].modes[t], noise_m);
    const double error_m = (place - images[i].target_m[t].cast<double>()).norm();
    score += (error_m < kHitRadius_m ? 1.0 : 0.0) + (error_m < kHitRadius_m / 2 ? 0.5 : 0.0);
  }
  return score;
}

void TuneNoise(const std::vector<ValidationImage>& images,
               const std::vector<InferredImage>& inferred, size_t t, ProposalTarget* target) {
  double best = -1;
  for (const float noise_m : {0.003F, 0.01F, 0.02F, 0.03F, 0.045F, 0.065F, 0.09F}) {
    const double score = Score(images, inferred, t, noise_m);
    if (score <= best) continue;
    best = score;
    target->mode_noise_m = noise_m;
  }
}

// A candidate with its ground truth.
struct JudgedCandidate {
  PlaceCandidate candidate;
  bool is_near = false;  // near the target's true position
  bool visible = false;  // whether the target is visible
  bool seen = false;     // seen by mean shift
};

std::vector<JudgedCandidate> JudgeCandidates(const std::vector<ValidationImage>& images,
                                             const std::vector<InferredImage>& inferred,
                                             const ProposalTarget& target, size_t t) {
  std::vector<JudgedCandidate> judged;
  for (size_t i = 0; i < images.size(); ++i) {
    if (!images[i].target_m[t].allFinite()) continue;
    const Eigen::Vector3d truth_m = images[i].target_m[t].cast<double>();
    const std::vector<Mode>& modes = inferred[i].modes[t];
    for (const PlaceCandidate& candidate :
         Candidates(target, inferred[i].marginals, t, modes, inferred[i].refined_place(t))) {
      const bool seen =
          candidate.mode >= 0 &&
          Evaluate(target.visible, modes[static_cast<size_t>(candidate.mode)].feature) >= 0.5;
      judged.push_back({candidate, (candidate.position_m - truth_m).norm() < kHitRadius_m,
                        images[i].target_visible[t] != 0, seen});
    }
  }
  return judged;
}

// P(within 10 cm) of the fused or of the separate candidates.
PlaceConfidence FitAgreement(const std::vector<JudgedCandidate>& judged, bool is_fused) {
  using Example = Judged<PlaceConfidence::kFeatures>;
  std::vector<Example> examples;
  for (const JudgedCandidate& one : judged) {
    if (one.candidate.is_fused != is_fused) continue;
    examples.push_back({one.candidate.feature, one.is_near, one.visible});
  }
  return FitLogistic(examples, &Example::is_near);
}

// The smallest confidence threshold above which the requested precision holds.
float FindThreshold(std::vector<std::pair<double, bool>> rated, double precision) {
  std::sort(rated.begin(), rated.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  double right = 0;
  float threshold = 0.99F;
  for (size_t i = 0; i < rated.size(); ++i) {
    right += rated[i].second ? 1.0 : 0.0;
    if (right >= precision * static_cast<double>(i + 1)) {
      threshold = std::min(0.99F, static_cast<float>(rated[i].first));
    }
  }
  return threshold;
}

}  // namespace

FirstStage RunFirstStage(const ForestModel& model, const ValidationImage& image) {
  FirstStage inferred;
  for (size_t t = 0; t < model.targets().size(); ++t) {
    inferred.modes.push_back(FindModes(image.evidence, model.targets()[t], t));
  }
  inferred.marginals = InferPose(model, image.context, inferred.modes);
  return inferred;
}

void SetThresholds(const std::vector<RatedPlace>& rated, ProposalTarget* target) {
  std::vector<std::pair<double, bool>> all;
  std::vector<std::pair<double, bool>> seen;
  for (const RatedPlace& place : rated) {
    all.emplace_back(place.confidence, place.is_near);
    if (place.seen) seen.emplace_back(place.confidence, place.is_near && place.visible);
  }
  target->inferred_confidence = FindThreshold(all, kInferredPrecision);
  target->tracked_confidence =
      std::max(target->inferred_confidence, FindThreshold(seen, kTrackedPrecision));
}

ForestModel LearnPoseInference(const ForestModel& model,
                               const std::vector<ValidationImage>& images) {
  const std::vector<InferredImage> inferred = InferAll(model, images);
  ForestData data = model.data();
  oneapi::tbb::parallel_for(size_t{0}, data.targets.size(), [&](size_t t) {
    ProposalTarget& target = data.targets[t];
    // The refinement was trained with this noise and predicts the confidence of fused positions
    // itself.
    const bool is_refined = !data.refinement.empty();
    if (!is_refined) TuneNoise(images, inferred, t, &target);
    const std::vector<JudgedCandidate> judged = JudgeCandidates(images, inferred, target, t);
    if (!is_refined) target.fused = FitAgreement(judged, true);
    target.apart = FitAgreement(judged, false);
    std::vector<RatedPlace> rated;
    for (const JudgedCandidate& one : judged) {
      rated.push_back(
          {ComputeConfidence(target, one.candidate), one.is_near, one.visible, one.seen});
    }
    SetThresholds(rated, &target);
  });
  return ForestModel(std::move(data));
}

}  // namespace ossa::forest
