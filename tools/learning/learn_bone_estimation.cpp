#include "tools/learning/learn_bone_estimation.h"

#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/threads.h"
#include "recon/refine/bone_estimation.h"
#include "tools/learning/refinement_examples.h"

namespace ossa::tools {
namespace {

constexpr auto kBones = static_cast<Eigen::Index>(recon::kEstimatedBones.size());

// Two rows a person: as it is, and mirrored.
PerceptronExamples MakeExamples(const std::vector<RefinementExample>& people) {
  const auto rows = 2 * static_cast<Eigen::Index>(people.size());
  PerceptronExamples out{RowMatrix(rows, recon::kBoneFeatures), RowMatrix(rows, kBones)};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const RefinementExample& example = people[static_cast<size_t>(row / 2)];
    const recon::ProposedPerson& seen = example.person;
    out.input.row(row) = recon::ComputeBoneFeatures(row % 2 == 0 ? seen : seen.Mirrored());
    out.wanted.row(row) = recon::EncodeBoneLengths(example.bones_m);
  }
  return out;
}

}  // namespace

recon::RefinementCascade LearnBoneEstimation(const forest::ForestModel& model,
                                             const std::vector<std::filesystem::path>& datasets,
                                             const RefinementStageOptions& options) {
  const ThreadLimit limit(options.threads);
  recon::RefinementCascade cascade = options.after;
  RefinementStageOptions as_they_are = options;
  as_they_are.shifted = 0;
  const RefinementExamples found = GatherRefinementExamples(model, datasets, as_they_are);
  PerceptronExamples examples = MakeExamples(found.all);
  PerceptronTraining learning = MakeNetworkOptions(options, kBones);
  learning.decay = 0.02F;
  learning.progress = options.progress;
  constexpr float kSoft = 0.2F;  // steps: errors below 2 % pull less; by hand
  cascade.measured = found.people;
  cascade.bones = TrainPerceptron(&examples, AbsoluteErrorGradient(kSoft), learning);
  return cascade;
}

}  // namespace ossa::tools
