#include "tools/learning/learn_refinement_stage.h"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <numeric>

#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/threads.h"
#include "recon/refine/bone_estimation.h"
#include "recon/skeleton.h"
#include "tools/learning/refinement_examples.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand.

using recon::kStageJoints;

// The target of the network of a joint; none for a joint that is off by more than a stage may move
// it: it was confused with something else, and the surface near the proposal does not contain the
// error.
void WriteTarget(const Eigen::RowVector3f& offset, PerceptronExamples& out, Eigen::Index row) {
  constexpr OffsetScale kOffsets = recon::RefinementCascade::kOffsets;
  const bool in_reach = kOffsets.step_m * offset.cast<double>().norm() < kOffsets.farthest_m;
  // Value by value: GCC 12 sees a packet read past a row of three.
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    out.wanted(row, axis) = in_reach ? offset[axis] : std::numeric_limits<float>::quiet_NaN();
  }
}

// Two rows an example: as it is, and mirrored.
PerceptronExamples MakeExamples(const std::vector<RefinementExample>& examples, recon::Joint joint,
                                bool bone_conditioned) {
  const auto rows = 2 * static_cast<Eigen::Index>(examples.size());
  const int features = bone_conditioned ? recon::kBoneConditionedFeatures : recon::kStageFeatures;
  PerceptronExamples out{RowMatrix(rows, features), RowMatrix(rows, 3)};
  const auto index = recon::Index(joint);
  const auto other = recon::kMirroredJoint[index];
  for (size_t i = 0; i < examples.size(); ++i) {
    const RefinementExample& example = examples[i];
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const auto put = [&](Eigen::Index at, const recon::SampledPerson& seen) {
      out.input.row(at).head(recon::kStageFeatures) = recon::ComputeStageFeatures(seen, joint);
      if (!bone_conditioned) return;
      out.input.row(at).tail(features - recon::kStageFeatures) =
          recon::EncodeBoneLengths(example.given_bones_m);
    };
    put(row, example.person);
    WriteTarget(example.offset[index], out, row);
    put(row + 1, example.person.Mirrored());
    WriteTarget(example.offset[other].cwiseProduct(Eigen::RowVector3f(-1.0F, 1.0F, 1.0F)), out,
                row + 1);
  }
  return out;
}

}  // namespace

recon::RefinementCascade LearnRefinementStage(const forest::ForestModel& model,
                                              const std::vector<std::filesystem::path>& datasets,
                                              const RefinementStageOptions& options) {
  const ThreadLimit limit(options.threads);
  recon::RefinementCascade cascade = options.after;
  const RefinementExamples found = GatherRefinementExamples(model, datasets, options);
  cascade.people = found.people;
  const bool bone_conditioned = !cascade.bones.empty();
  recon::RefinementStage& learned =
      (bone_conditioned ? cascade.bone_conditioned : cascade.stages).emplace_back();
  std::mutex mutex;
  std::array<int64_t, kStageJoints.size()> done{};
  ParallelFor(kStageJoints.size(), [&](size_t k) {
    PerceptronExamples examples = MakeExamples(found.all, kStageJoints[k], bone_conditioned);
    PerceptronTraining learning = MakeNetworkOptions(options, 3);
    // Of decays of 0.02 to 1, with and without dropout, the best on validation subjects.
    learning.decay = 0.5F;
    learning.progress = [&](int64_t step, int64_t steps) {
      const std::lock_guard lock(mutex);
      done[k] = step;
      if (!options.progress) return;
      options.progress(std::accumulate(done.begin(), done.end(), int64_t{0}),
                       steps * static_cast<int64_t>(done.size()));
    };
    constexpr float kSoft = 0.2F;  // steps: errors below 2 cm pull less
    learned[k] = TrainPerceptron(&examples, PointDistanceGradient(kSoft), learning);
  });
  return cascade;
}

}  // namespace ossa::tools
