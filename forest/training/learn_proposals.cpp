// Learns the parameters of mean shift on images never used for training: the effective number of
// independent pixels of a figure, and for each target bandwidth, threshold, push-back and the
// weights of the two kinds of votes (Shotton et al. 2011, sec. 3.3: "optimized on a hold-out
// validation set").
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/threads.h"
#include "forest/classification/classify.h"
#include "forest/training/train.h"
#include "forest/training/validation_internal.h"

namespace ossa::forest {
namespace {

depth::DepthView MakeView(const TrainingImage& image) {
  const int width = image.camera.width;
  return {image.depth_mm.data(), width, image.camera.height, width};
}

std::vector<size_t> ChooseImages(const TrainingSource& source, size_t most) {
  if (source.size() == 0) throw InputError("validation data: no images");
  std::vector<size_t> chosen;
  const size_t count = std::min(source.size(), most);
  for (size_t i = 0; i < count; ++i) chosen.push_back(i * source.size() / count);
  return chosen;
}

ForestModel WithScale(const ForestModel& model, float scale) {
  ForestData data = model.data();
  data.evidence_scale = scale;
  return ForestModel(std::move(data));
}

// Truth with another vocabulary than the model's would be misinterpreted.
void CheckTruth(const ForestModel& model, const TrainingImage& image) {
  if (image.target_m.size() != model.targets().size()) {
    throw InputError("validation data: expected places of " +
                     std::to_string(model.targets().size()) + " targets, found " +
                     std::to_string(image.target_m.size()));
  }
  if (model.context_count() > 1 && image.context >= model.context_count()) {
    throw InputError("validation data: expected a context below " +
                     std::to_string(model.context_count()) + ", found " +
                     std::to_string(image.context));
  }
}

// The scale with the largest likelihood of the true contexts.
float LearnEvidenceScale(const ForestModel& model, const TrainingSource& source,
                         const std::vector<size_t>& chosen) {
  if (model.context_count() < 2) return model.data().evidence_scale;
  // With scale 1 the mean evidence can be recovered: log posterior - log prior + constant.
  const ForestModel unit = WithScale(model, 1.0F);
  const auto& prior = model.data().context_prior;
  std::vector<Eigen::VectorXd> evidence(chosen.size());
  std::vector<uint8_t> truth(chosen.size());
  oneapi::tbb::parallel_for(size_t{0}, chosen.size(), [&](size_t i) {
    const TrainingImage image = source.Read(chosen[i]);
    CheckTruth(model, image);
    const Classification result = ClassifyImage(unit, image);
    truth[i] = image.context;
    if (result.pixel.empty()) return;
    evidence[i].resize(model.context_count());
    for (size_t k = 0; k < prior.size(); ++k) {
      evidence[i][static_cast<Eigen::Index>(k)] =
          std::log(std::max(result.context[k], 1e-30F)) - std::log(std::max(prior[k], 1e-4F));
    }
  });
  float best_scale = model.data().evidence_scale;
  double best = -1e300;
  for (const float scale : {1.F, 2.F, 4.F, 6.F, 9.F, 13.F, 20.F, 30.F, 45.F, 65.F, 100.F, 150.F}) {
    double log_likelihood = 0;
    for (size_t i = 0; i < chosen.size(); ++i) {
      if (evidence[i].size() == 0) continue;
      Eigen::VectorXd score = evidence[i] * scale;
      for (size_t k = 0; k < prior.size(); ++k) {
        score[static_cast<Eigen::Index>(k)] += std::log(std::max(prior[k], 1e-4F));
      }
      const double top = score.maxCoeff();
      log_likelihood += score[truth[i]] - top - std::log((score.array() - top).exp().sum());
    }
    if (log_likelihood > best) {
      best = log_likelihood;
      best_scale = scale;
    }
  }
  return best_scale;
}

std::vector<ValidationImage> GatherAll(const ForestModel& model, const TrainingSource& source,
                                       const std::vector<size_t>& chosen) {
  std::vector<ValidationImage> images(chosen.size());
  oneapi::tbb::parallel_for(size_t{0}, chosen.size(), [&](size_t i) {
    images[i] = GatherImage(model, source.Read(chosen[i]));
  });
  std::erase_if(images, [](const ValidationImage& image) { return image.evidence.count == 0; });
  if (images.empty()) throw InputError("validation data: no image shows a labelled object");
  return images;
}

// Number of hits within 10 cm, plus a third for each within 5 cm.
double Score(const std::vector<ValidationImage>& images, const ProposalTarget& target, size_t t) {
  double score = 0;
  for (const ValidationImage& image : images) {
    if (!image.target_m[t].allFinite()) continue;
    const std::vector<Mode> modes = FindModes(image.evidence, target, t);
    if (modes.empty()) continue;
    const float error_m = (modes.front().position_m - image.target_m[t]).norm();
    score += (error_m < kHitRadius_m ? 1.0 : 0.0) + (error_m < kHitRadius_m / 2 ? 0.33 : 0.0);
  }
  return score;
}

struct Knob {
  float ProposalTarget::*value;
  std::vector<float> choices;
};

// Coordinate ascent over short lists: the optimum is flat, so a finer search gains nothing.
void TuneTarget(const std::vector<ValidationImage>& images, size_t t, ProposalTarget* target) {
  const std::vector<Knob> knobs = {
      {&ProposalTarget::class_weight, {0.0F, 0.1F, 0.3F, 1.0F, 3.0F}},
      {&ProposalTarget::bandwidth_m, {0.03F, 0.045F, 0.065F, 0.09F, 0.13F}},
      {&ProposalTarget::vote_sharpness_m, {0.03F, 0.05F, 0.08F, 0.14F}},
      {&ProposalTarget::push_back_m, {0.0F, 0.02F, 0.04F, 0.06F, 0.09F, 0.12F}},
      {&ProposalTarget::vote_radius_m, {0.2F, 0.4F, 0.7F, 1.3F}},
      {&ProposalTarget::probability_threshold, {0.05F, 0.15F, 0.3F}}};
  double best = Score(images, *target, t);
  for (int round = 0; round < 2; ++round) {
    for (const Knob& knob : knobs) {
      for (const float choice : knob.choices) {
        ProposalTarget trial = *target;
        trial.*knob.value = choice;
        const double score = Score(images, trial, t);
        if (score > best) {
          best = score;
          *target = trial;
        }
      }
    }
  }
}

std::vector<JudgedMode> JudgeModes(const std::vector<ValidationImage>& images,
                                   const ProposalTarget& target, size_t t) {
  std::vector<JudgedMode> judged;
  for (const ValidationImage& image : images) {
    if (!image.target_m[t].allFinite()) continue;
    for (const Mode& mode : FindModes(image.evidence, target, t)) {
      judged.push_back({mode.feature, (mode.position_m - image.target_m[t]).norm() < kHitRadius_m,
                        image.target_visible[t] != 0});
    }
  }
  return judged;
}

void LearnConfidence(const std::vector<JudgedMode>& judged, ProposalTarget* target) {
  target->correct = FitLogistic(judged, &JudgedMode::is_near);
  target->visible = FitLogistic(judged, &JudgedMode::visible);
  std::vector<RatedPlace> rated;
  for (const JudgedMode& mode : judged) {
    rated.push_back({Evaluate(target->correct, mode.feature), mode.is_near, mode.visible,
                     Evaluate(target->visible, mode.feature) >= 0.5});
  }
  SetThresholds(rated, target);
}

}  // namespace

Classification ClassifyImage(const ForestModel& model, const TrainingImage& image) {
  std::vector<int32_t> pixels;
  for (size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != 0) pixels.push_back(static_cast<int32_t>(i));
  }
  return Classify(model, MakeView(image), image.camera, pixels);
}

ValidationImage GatherImage(const ForestModel& model, const TrainingImage& image) {
  CheckTruth(model, image);
  const Classification result = ClassifyImage(model, image);
  return {image.camera, GatherEvidence(model, MakeView(image), image.camera, result),
          result.context, image.target_m, image.target_visible};
}

ForestModel LearnProposals(const ForestModel& model, const TrainingSource& validation,
                           size_t max_images, int threads) {
  const ThreadLimit limit(threads);
  const std::vector<size_t> chosen = ChooseImages(validation, max_images);
  ForestData data = model.data();
  data.evidence_scale = LearnEvidenceScale(model, validation, chosen);
  const ForestModel scaled{ForestData(data)};
  const std::vector<ValidationImage> images = GatherAll(scaled, validation, chosen);
  oneapi::tbb::parallel_for(size_t{0}, data.targets.size(), [&](size_t t) {
    TuneTarget(images, t, &data.targets[t]);
    LearnConfidence(JudgeModes(images, data.targets[t], t), &data.targets[t]);
  });
  const ForestModel single{std::move(data)};
  return single.data().pose_priors.empty() ? single : LearnPoseInference(single, images);
}

ForestModel LearnConfidences(const ForestModel& model, const TrainingSource& validation,
                             size_t max_images, int threads) {
  const ThreadLimit limit(threads);
  return LearnPoseInference(model,
                            GatherAll(model, validation, ChooseImages(validation, max_images)));
}

}  // namespace ossa::forest
