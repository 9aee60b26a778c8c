// How far modes are trusted against the prediction by the other targets, and how likely the place
// where both meet is right: fitted on images never trained on.
#include <oneapi/tbb/parallel_for.h>

#include "forest/agree_internal.h"
#include "forest/train/learn_internal.h"

namespace ossa::forest {
namespace {

constexpr double kTrackedPrecision = 0.90;
constexpr double kInferredPrecision = 0.50;

struct Heard {
  ModesOfTargets modes;
  Beliefs beliefs;
};

std::vector<Heard> HearAll(const ForestModel& model, const std::vector<ValidationImage>& images) {
  std::vector<Heard> heard(images.size());
  oneapi::tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) {
    for (size_t t = 0; t < model.targets().size(); ++t) {
      heard[i].modes.push_back(FindModes(images[i].evidence, model.targets()[t], t));
    }
    heard[i].beliefs = Agree(model, images[i].context, heard[i].modes);
  });
  return heard;
}

// Hits within 10 cm, and half as much for being within 5 cm as well.
double Score(const std::vector<ValidationImage>& images, const std::vector<Heard>& heard, size_t t,
             double noise_m) {
  double score = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    if (!images[i].target_m[t].allFinite()) continue;
    const Eigen::Vector3d place = Fuse(heard[i].beliefs.target[t], heard[i].modes[t], noise_m);
    const double error_m = (place - images[i].target_m[t].cast<double>()).norm();
    score += (error_m < kHitRadius_m ? 1.0 : 0.0) + (error_m < kHitRadius_m / 2 ? 0.5 : 0.0);
  }
  return score;
}

void TuneNoise(const std::vector<ValidationImage>& images, const std::vector<Heard>& heard,
               size_t t, ProposalTarget* target) {
  double best = -1;
  for (const float noise_m : {0.003F, 0.01F, 0.02F, 0.03F, 0.045F, 0.065F, 0.09F}) {
    const double score = Score(images, heard, t, noise_m);
    if (score <= best) continue;
    best = score;
    target->mode_noise_m = noise_m;
  }
}

using JudgedPlace = Judged<Agreement::kFeatures>;

struct JudgedPlaces {
  std::vector<JudgedPlace> fused, apart;
  std::vector<bool> fused_seen, apart_seen;  // by what mean shift saw
};

JudgedPlaces JudgePlaces(const std::vector<ValidationImage>& images,
                         const std::vector<Heard>& heard, const ProposalTarget& target, size_t t) {
  JudgedPlaces judged;
  for (size_t i = 0; i < images.size(); ++i) {
    if (!images[i].target_m[t].allFinite()) continue;
    const Eigen::Vector3d truth_m = images[i].target_m[t].cast<double>();
    const std::vector<Mode>& modes = heard[i].modes[t];
    for (const Candidate& candidate : Candidates(target, heard[i].beliefs, t, modes)) {
      const bool seen =
          candidate.mode >= 0 &&
          Evaluate(target.visible, modes[static_cast<size_t>(candidate.mode)].feature) >= 0.5;
      (candidate.is_fused ? judged.fused : judged.apart)
          .push_back({candidate.feature, (candidate.position_m - truth_m).norm() < kHitRadius_m,
                      images[i].target_visible[t] != 0});
      (candidate.is_fused ? judged.fused_seen : judged.apart_seen).push_back(seen);
    }
  }
  return judged;
}

void AppendRated(const std::vector<JudgedPlace>& judged, const std::vector<bool>& seen,
                 const Agreement& agreement, std::vector<RatedPlace>* rated) {
  for (size_t i = 0; i < judged.size(); ++i) {
    rated->push_back(
        {Evaluate(agreement, judged[i].feature), judged[i].is_near, judged[i].visible, seen[i]});
  }
}

// The least confidence from which on (by all of at least as much) the wanted share is right.
float ThresholdFor(std::vector<std::pair<double, bool>> rated, double precision) {
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

void SetThresholds(const std::vector<RatedPlace>& rated, ProposalTarget* target) {
  std::vector<std::pair<double, bool>> all;
  std::vector<std::pair<double, bool>> seen;
  for (const RatedPlace& place : rated) {
    all.emplace_back(place.confidence, place.is_near);
    if (place.seen) seen.emplace_back(place.confidence, place.is_near && place.visible);
  }
  target->inferred_confidence = ThresholdFor(all, kInferredPrecision);
  target->tracked_confidence =
      std::max(target->inferred_confidence, ThresholdFor(seen, kTrackedPrecision));
}

ForestModel LearnAgreement(const ForestModel& model, const std::vector<ValidationImage>& images) {
  const std::vector<Heard> heard = HearAll(model, images);
  ForestData data = model.data();
  oneapi::tbb::parallel_for(size_t{0}, data.targets.size(), [&](size_t t) {
    ProposalTarget& target = data.targets[t];
    TuneNoise(images, heard, t, &target);
    const JudgedPlaces judged = JudgePlaces(images, heard, target, t);
    target.fused = FitLogistic(judged.fused, &JudgedPlace::is_near);
    target.apart = FitLogistic(judged.apart, &JudgedPlace::is_near);
    std::vector<RatedPlace> rated;
    AppendRated(judged.fused, judged.fused_seen, target.fused, &rated);
    AppendRated(judged.apart, judged.apart_seen, target.apart, &rated);
    SetThresholds(rated, &target);
  });
  return ForestModel(std::move(data));
}

}  // namespace ossa::forest
