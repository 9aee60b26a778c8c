#include "tools/learning/learn_bone_measure.h"

#include "forest/thread_limit.h"
#include "recon/refine/bone_measure.h"
#include "tools/learning/learn_rectified_network.h"
#include "tools/learning/look_examples.h"

namespace ossa::tools {
namespace {

constexpr auto kBones = static_cast<Eigen::Index>(recon::kMeasuredBones.size());

// Two rows a person: as it is, and mirrored.
forest::NetworkExamples ExamplesOf(const std::vector<LookExample>& people) {
  const auto rows = 2 * static_cast<Eigen::Index>(people.size());
  forest::NetworkExamples out{forest::RowMatrix(rows, recon::kBoneInputs),
                              forest::RowMatrix(rows, kBones)};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const LookExample& person = people[static_cast<size_t>(row / 2)];
    const recon::ProposedPerson& seen = person.description;
    out.input.row(row) = recon::BoneNumbersOf(row % 2 == 0 ? seen : seen.Mirrored()).transpose();
    out.wanted.row(row) = recon::BoneOutputsOf(person.bones_m).transpose();
  }
  return out;
}

}  // namespace

recon::CloseLook LearnBoneMeasure(const forest::ForestModel& model,
                                  const std::vector<std::filesystem::path>& datasets,
                                  const CloseLookOptions& options) {
  const forest::ThreadLimit limit(options.threads);
  recon::CloseLook look = options.after;
  CloseLookOptions as_they_are = options;
  as_they_are.shifted = 0;
  const LookExamples found = GatherLookExamples(model, datasets, as_they_are);
  forest::NetworkExamples examples = ExamplesOf(found.all);
  forest::NetworkOptions learning = LookLearning(options, kBones);
  learning.decay = 0.02F;
  learning.progress = options.progress;
  constexpr float kSoft = 0.2F;  // steps: errors below 2 % pull less
  look.measured = found.people;
  look.bones = LearnRectifiedNetwork(&examples, GradientOfNumbers(kSoft), learning);
  return look;
}

}  // namespace ossa::tools
