#include "recon/models/window_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depth/base/perceptron/train_perceptron.h"
#include "recon/database/posture_database.h"
#include "recon/filters/frame_steps.h"
#include "recon/models/error_gains_internal.h"
#include "recon/models/pose_correction.h"

namespace ossa::recon {
namespace {

constexpr float kStep_m = 0.1F;   // an output of 1: about the largest error; by hand
constexpr float kSoft = 0.1F;     // of kStep_m: errors below a centimetre are noise; by hand
constexpr double kKept_s = 0.75;  // the longest lag and a margin; by hand

/// Training examples from whole recordings: windows are cut from the preceding pairs of a clip.
PerceptronExamples MakeExamples(const std::vector<PosturePair>& pairs, size_t most) {
  const size_t count = std::min(most, pairs.size());
  PerceptronExamples examples;
  examples.input.resize(static_cast<Eigen::Index>(2 * count), WindowSize());
  examples.wanted.resize(static_cast<Eigen::Index>(2 * count), kPostureDims);
  Eigen::Index row = 0;
  for (const bool mirrored : {false, true}) {
    FeatureHistory history;
    size_t taken = 0;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const PosturePair pair = mirrored ? Mirrored(pairs[i]) : pairs[i];
      if (i > 0 && pairs[i].clip != pairs[i - 1].clip) history.Clear();
      const Eigen::VectorXf feature = CorrectionFeature(pair.observed);
      if (taken < count && i == taken * pairs.size() / count) {
        ++taken;
        examples.input.row(row) = history.WindowAt(pairs[i].time_s, feature).transpose();
        for (size_t j = 0; j < kJointCount; ++j) {
          const Eigen::Vector3f offset =
              pair.known[j] > 0.0
                  ? Eigen::Vector3f(pair.residual.position_m[j].cast<float>() / kStep_m)
                  : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
          examples.wanted.block<1, 3>(row, FirstCoordinate(j)) = offset.transpose();
        }
        ++row;
      }
      history.Add(pairs[i].time_s, feature);
    }
  }
  return examples;
}

Perceptron Train(const std::vector<PosturePair>& pairs, size_t most,
                 const WindowCorrectionOptions& options) {
  PerceptronExamples examples = MakeExamples(pairs, most);
  PerceptronTraining training;
  training.hidden = {options.hidden};
  training.outputs = kPostureDims;
  training.epochs = options.epochs;
  training.dropped = options.dropped;
  training.clip_inputs = true;
  training.seed = options.seed;
  training.stop = options.stop;
  training.batch = std::min(training.batch, examples.input.rows());
  return TrainPerceptron(&examples, PointDistanceGradient(kSoft), training);
}

/// Offsets of all pairs, in order.
std::vector<Posture> UnpackOffsets(const WindowCorrection& correction,
                                   const std::vector<PosturePair>& pairs) {
  std::vector<Posture> offsets;
  FeatureHistory history;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0 && pairs[i].clip != pairs[i - 1].clip) history.Clear();
    const Eigen::VectorXf feature = CorrectionFeature(pairs[i].observed);
    offsets.push_back(correction.Offsets(history.WindowAt(pairs[i].time_s, feature)));
    history.Add(pairs[i].time_s, feature);
  }
  return offsets;
}

/// Gains by cross-validation over people.
JointWeights FindGains(const std::vector<PosturePair>& pairs,
                       const WindowCorrectionOptions& options) {
  const std::vector<int> fold = AssignFolds(pairs, options.folds);
  std::vector<Posture> offsets(pairs.size());
  for (int held = 0; held < options.folds; ++held) {
    std::vector<PosturePair> rest, left_out;
    std::vector<size_t> places;
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (fold[i] != held) {
        rest.push_back(pairs[i]);
      } else {
        left_out.push_back(pairs[i]);
        places.push_back(i);
      }
    }
    if (rest.empty() || left_out.empty()) continue;
    WindowCorrection trial;
    trial.network = Train(rest, options.for_gains, options);
    trial.gains.fill(1.0);
    const std::vector<Posture> of_held = UnpackOffsets(trial, left_out);
    for (size_t k = 0; k < places.size(); ++k) offsets[places[k]] = of_held[k];
  }
  return ComputeGains(pairs, fold, offsets);
}

}  // namespace

Eigen::Index WindowSize() {
  static const Eigen::Index kFeatures = CorrectionFeature(Posture()).size();
  return static_cast<Eigen::Index>(WindowCorrection::kLags_s.size()) * kFeatures;
}

WindowCorrection WindowCorrection::Learn(const std::vector<PosturePair>& all_pairs,
                                         const WindowCorrectionOptions& options) {
  const std::vector<PosturePair> pairs = WithoutGrossErrors(all_pairs, options.gross_m);
  WindowCorrection out;
  // With fewer a network is no better than a linear term.
  constexpr size_t kFewest = 1000;  // pairs; by hand
  if (!options.enabled || pairs.size() < kFewest || OfOnePerson(pairs)) return out;
  out.gains = FindGains(pairs, options);
  out.network = Train(pairs, options.most_pairs, options);
  return out;
}

Posture WindowCorrection::Offsets(const Eigen::VectorXf& window) const {
  const RowMatrix offsets = kStep_m * network.Run(window.transpose());
  Posture out;
  for (size_t j = 0; j < kJointCount; ++j) {
    out.position_m[j] =
        gains[j] * offsets.block<1, 3>(0, FirstCoordinate(j)).transpose().cast<double>();
  }
  return out;
}

void FeatureHistory::Add(double time_s, Eigen::VectorXf feature) {
  const bool is_another_recording =
      !past_.empty() && time_s < past_.back().time_s - FrameSteps::kJitter_s;
  if (is_another_recording) past_.clear();
  past_.push_back({time_s, std::move(feature)});
  const auto old = [&](const Sample& sample) { return sample.time_s < time_s - kKept_s; };
  past_.erase(past_.begin(), std::find_if_not(past_.begin(), past_.end(), old));
}

Eigen::VectorXf FeatureHistory::WindowAt(double time_s, const Eigen::VectorXf& now) const {
  const auto& lags_s = WindowCorrection::kLags_s;
  Eigen::VectorXf window(static_cast<Eigen::Index>(lags_s.size()) * now.size());
  for (size_t k = 0; k < lags_s.size(); ++k) {
    const double wanted_s = time_s - lags_s[k];
    const Eigen::VectorXf* nearest = &now;
    double apart_s = lags_s[k];
    for (const Sample& sample : past_) {
      const double of_sample_s = std::abs(sample.time_s - wanted_s);
      if (sample.time_s >= time_s || of_sample_s >= apart_s) continue;
      apart_s = of_sample_s;
      nearest = &sample.feature;
    }
    window.segment(static_cast<Eigen::Index>(k) * now.size(), now.size()) = *nearest;
  }
  return window;
}

}  // namespace ossa::recon
