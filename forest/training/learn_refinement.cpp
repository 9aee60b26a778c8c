// Learns the second stage (forest/proposals/refinement.cpp) on images that the trees have not seen:
// on their own training images trees have unrealistically small errors.
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/threads.h"
#include "depth/base/train_interrupted.h"
#include "forest/joint_features_internal.h"
#include "forest/proposals/refinement_internal.h"
#include "forest/training/validation_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand on validation subjects (`ossa evaluate`).

constexpr float kWindow_m = 0.07F;  // errors of this size count as 0.6 of a hit, of 10 cm 0.36
constexpr float kPull = 0.1F;       // of distant positions relative to hits; weight
constexpr float kSoft_m = 0.02F;    // smaller errors have smaller gradients
constexpr float kConfidenceShare = 0.5F;  // share

// Training examples, one image per row. Input: image × JointFeatureCount; wanted: image × target ·
// 3, offsets in refinement steps, NaN: unknown.
using Examples = PerceptronExamples;

// False if nothing is visible.
bool AddExample(const ForestModel& model, const TrainingImage& image, Eigen::Index row,
                Examples* out) {
  const ValidationImage gathered = GatherImage(model, image);
  const FirstStage first = RunFirstStage(model, gathered);
  const bool is_blank = std::all_of(first.modes.begin(), first.modes.end(),
                                    [](const std::vector<Mode>& modes) { return modes.empty(); });
  if (is_blank) return false;
  const JointFeatures features = ComputeJointFeatures(
      model, image.camera, gathered.evidence, gathered.context, first.modes, first.marginals);
  out->input.row(row) = features.value;
  for (size_t t = 0; t < image.target_m.size(); ++t) {
    out->wanted.block<1, 3>(row, static_cast<Eigen::Index>(3 * t)) = EncodeOffset(
        features.place_m[t], image.target_m[t].cast<double>(), features.frame, OffsetScale());
  }
  return true;
}

Examples GatherExamples(const ForestModel& model, const TrainingSource& source,
                        const RefinementOptions& options) {
  const size_t targets = model.targets().size();
  const auto size =
      static_cast<Eigen::Index>(JointFeatureCount(targets, static_cast<size_t>(model.class_count()),
                                                  static_cast<size_t>(model.context_count())));
  const auto count = static_cast<Eigen::Index>(source.size());
  Examples examples{RowMatrix(count, size),
                    RowMatrix(count, static_cast<Eigen::Index>(3 * targets))};
  std::vector<uint8_t> is_there(source.size(), 0);
  oneapi::tbb::parallel_for(size_t{0}, source.size(), [&](size_t i) {
    if (options.stop && options.stop()) return;
    const bool added = AddExample(model, source.Read(i), static_cast<Eigen::Index>(i), &examples);
    is_there[i] = added ? 1 : 0;
  });
  if (options.stop && options.stop()) throw TrainInterrupted("interrupted while reading");
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (is_there[static_cast<size_t>(i)] == 0) continue;
    examples.input.row(kept) = examples.input.row(i).eval();
    examples.wanted.row(kept++) = examples.wanted.row(i).eval();
  }
  examples.input.conservativeResize(kept, Eigen::NoChange);
  examples.wanted.conservativeResize(kept, Eigen::NoChange);
  return examples;
}

// Gradient of the loss with respect to the outputs. An error e costs 1 - exp(-e² / 2 w²), which
// counts misses, plus a little of its length, which attracts positions beyond the window; the
// confidence costs the cross entropy with whether the position is within 10 cm.
RowMatrix ComputeGradient(const RowMatrix& out, const RowMatrix& wanted) {
  const auto step_m = static_cast<float>(OffsetScale().step_m);
  const Eigen::Index targets = wanted.cols() / 3;
  RowMatrix gradient = RowMatrix::Zero(out.rows(), out.cols());
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    for (Eigen::Index t = 0; t < targets; ++t) {
      const Eigen::RowVector3f error_m =
          step_m * (out.block<1, 3>(i, 3 * t) - wanted.block<1, 3>(i, 3 * t));
      if (!error_m.allFinite()) continue;
      const float square = error_m.squaredNorm();
      const float within = std::exp(-square / (2.0F * kWindow_m * kWindow_m));
      const float pull = kPull / (std::sqrt(square + kSoft_m * kSoft_m) * step_m);
      gradient.block<1, 3>(i, 3 * t) = step_m * (within / (kWindow_m * kWindow_m) + pull) * error_m;
      const float hit = square < kHitRadius_m * kHitRadius_m ? 1.0F : 0.0F;
      const float confidence = 1.0F / (1.0F + std::exp(-out(i, 3 * targets + t)));
      gradient(i, 3 * targets + t) = kConfidenceShare * (confidence - hit);
    }
  }
  return gradient / static_cast<float>(out.rows() * targets);
}

}  // namespace

ForestModel LearnRefinement(const ForestModel& model, const TrainingSource& source,
                            const RefinementOptions& options) {
  const ThreadLimit limit(options.threads);
  if (model.data().pose_priors.empty()) {
    throw InputError("refinement: the model has no pose priors to start from");
  }
  Examples examples = GatherExamples(model, source, options);
  if (examples.input.rows() < kPerceptronBatch) {
    throw InputError("refinement: expected at least " + std::to_string(kPerceptronBatch) +
                     " images that show something, found " + std::to_string(examples.input.rows()));
  }
  ForestData data = model.data();
  PerceptronTraining network;
  network.hidden = {options.hidden};
  network.outputs = 4 * static_cast<Eigen::Index>(model.targets().size());
  network.epochs = options.epochs;
  network.dropped = options.dropped;
  network.least_deviation = 1e-4;  // units of the inputs; by hand: small shares are informative
  network.clip_inputs = true;
  network.seed = options.seed;
  network.progress = options.progress;
  network.stop = options.stop;
  data.refinement = TrainPerceptron(&examples, ComputeGradient, network);
  return ForestModel(std::move(data));
}

}  // namespace ossa::forest
