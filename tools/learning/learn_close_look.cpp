#include "tools/learning/learn_close_look.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <numeric>

#include "forest/thread_limit.h"
#include "recon/refine/bone_measure.h"
#include "recon/skeleton.h"
#include "tools/learning/learn_rectified_network.h"
#include "tools/learning/look_examples.h"

namespace ossa::tools {
namespace {

using recon::kLookJoints;

// Two rows an example: as it is, and mirrored. What is off by more was mistaken for something else,
// and nothing near the proposal tells of it.
forest::NetworkExamples ExamplesOf(const std::vector<LookExample>& examples, recon::Joint joint,
                                   bool told) {
  constexpr float kFarthest_m = 0.6F;
  const auto rows = 2 * static_cast<Eigen::Index>(examples.size());
  forest::NetworkExamples out{
      forest::RowMatrix(rows, told ? recon::kToldInputs : recon::kLookInputs),
      forest::RowMatrix(rows, 3)};
  const auto index = recon::Index(joint);
  const auto other = recon::kMirroredJoint[index];
  const auto want = [&out](Eigen::Index row, const Eigen::Vector3f& offset_m) {
    const bool is_near = offset_m.norm() < kFarthest_m;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      out.wanted(row, axis) = is_near
                                  ? offset_m[axis] / static_cast<float>(recon::CloseLook::kStep_m)
                                  : std::numeric_limits<float>::quiet_NaN();
    }
  };
  for (size_t i = 0; i < examples.size(); ++i) {
    const LookExample& person = examples[i];
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const auto put = [&](Eigen::Index at, const recon::LookDescription& seen) {
      out.input.row(at).head(recon::kLookInputs) = recon::NumbersOf(seen, joint).transpose();
      if (!told) return;
      out.input.row(at).tail(recon::kToldInputs - recon::kLookInputs) =
          recon::BoneOutputsOf(person.told_m).transpose();
    };
    put(row, person.description);
    want(row, person.offset_m[index]);
    put(row + 1, person.description.Mirrored());
    want(row + 1, person.offset_m[other].cwiseProduct(Eigen::Vector3f(-1, 1, 1)));
  }
  return out;
}

}  // namespace

recon::CloseLook LearnCloseLook(const forest::ForestModel& model,
                                const std::vector<std::filesystem::path>& datasets,
                                const CloseLookOptions& options) {
  const forest::ThreadLimit limit(options.threads);
  recon::CloseLook look = options.after;
  const LookExamples found = GatherLookExamples(model, datasets, options);
  look.people = found.people;
  const bool told = !look.bones.empty();
  recon::Glance& learned = (told ? look.told : look.glances).emplace_back();
  std::mutex mutex;
  std::array<int64_t, kLookJoints.size()> done{};
  oneapi::tbb::parallel_for(size_t{0}, kLookJoints.size(), [&](size_t k) {
    forest::NetworkExamples examples = ExamplesOf(found.all, kLookJoints[k], told);
    forest::NetworkOptions learning = LookLearning(options, 3);
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
    learned[k] = LearnRectifiedNetwork(&examples, GradientOfLengths(kSoft), learning);
  });
  return look;
}

}  // namespace ossa::tools
