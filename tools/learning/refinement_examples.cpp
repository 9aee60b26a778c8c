#include "tools/learning/refinement_examples.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "depth/base/error.h"
#include "depth/base/random.h"
#include "depth/base/train_interrupted.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "forest/targets.h"
#include "forest/training/train.h"
#include "recon/skeleton.h"
#include "tools/learning/segmented_person.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand.

constexpr std::string_view kFromAbove = "ceiling";  // DatasetManifest::view

using recon::kJointCount;
using recon::Posture;
using recon::SampledPerson;

// Reads data sets and asks the forest.
class Gatherer {
 public:
  Gatherer(const forest::ForestModel& model, const RefinementStageOptions& options,
           const std::vector<std::filesystem::path>& datasets)
      : model_(model),
        options_(options),
        refiner_(options.after),
        target_of_joint_(forest::FindTargets(model, recon::kJointNames, options.model_name)) {
    for (const auto& folder : datasets) {
      readers_.emplace_back(folder);
      for (int64_t f = 0; f < readers_.back().frame_count(); ++f) {
        places_.push_back({readers_.size() - 1, f});
      }
    }
  }

  size_t size() const { return places_.size(); }

  /// Of one person of the frame, in turn where there are several; the first as it is. None where
  /// too little is seen or some joint has no proposal.
  std::vector<RefinementExample> Read(size_t index) const {
    const auto [dataset, number] = places_[index];
    const auto person = ReadSegmented(readers_[dataset], number);
    if (!person) return {};
    const auto proposed = Propose(*person);
    if (!proposed) return {};
    const Posture& true_m = person->body.joints_m;
    Random random(options_.seed, index);
    auto input = RunStages(*proposed, recon::MeasureBoneLengths(true_m), random);
    std::vector<RefinementExample> examples;
    if (!input || !AddExample(*input, true_m, &examples)) return {};
    const Posture put_m = input->proposed;
    for (int i = 0; i < options_.shifted; ++i) {
      input->proposed = Shifted(put_m, random);
      AddExample(*input, true_m, &examples);
    }
    return examples;
  }

 private:
  struct Place {
    size_t dataset = 0;
    int64_t frame = 0;
  };

  // False where SampledPerson has nothing to say.
  static bool AddExample(const recon::RefinementInput& input, const Posture& true_m,
                         std::vector<RefinementExample>* examples) {
    const auto person = SampledPerson::Sample(input);
    if (!person) return false;
    RefinementExample& example =
        examples->emplace_back(RefinementExample{*person, {}, recon::MeasureBoneLengths(true_m)});
    example.given_bones_m = input.bones_m.value_or(example.bones_m);
    for (size_t j = 0; j < kJointCount; ++j) {
      example.offset[j] = EncodeOffset(input.proposed.position_m[j], true_m.position_m[j], *person,
                                       recon::RefinementCascade::kOffsets);
    }
    return true;
  }

  Posture Shifted(Posture put_m, Random& random) const {
    for (Eigen::Vector3d& joint_m : put_m.position_m) {
      for (double& axis_m : joint_m) axis_m += random.Normal(0.0, options_.shift_m);
    }
    return put_m;
  }

  // The likeliest place of each joint; the result borrows from `person`.
  std::optional<recon::RefinementInput> Propose(const SegmentedFrame& person) const {
    const depth::DepthFrame& depth = person.frame.depth;
    std::vector<int32_t> pixels;
    for (size_t i = 0; i < person.is_person.size(); ++i) {
      if (person.is_person[i] != 0) pixels.push_back(static_cast<int32_t>(i));
    }
    const auto classes = forest::Classify(model_, depth.view(), depth.camera, pixels);
    const auto proposals = forest::Propose(model_, depth.view(), depth.camera, classes);
    recon::RefinementInput input;
    for (size_t j = 0; j < kJointCount; ++j) {
      const auto& best_first = proposals[target_of_joint_[j]];
      if (best_first.empty()) return std::nullopt;
      input.proposed.position_m[j] = best_first.front().position_m;
      input.confidence[j] = best_first.front().confidence;
      input.seen[j] = best_first.front().seen;
    }
    input.depth = &depth;
    input.is_person = person.is_person;
    if (!options_.after.from_above) return input;
    input.floor = person.frame.floor;
    return input.floor ? std::optional(input) : std::nullopt;
  }

  // Runs the earlier stages. Earlier frames would estimate the bones as well as this frame or
  // better: a random share, up to half, of its error is removed.
  std::optional<recon::RefinementInput> RunStages(recon::RefinementInput input,
                                                  const recon::BoneLengths& true_m,
                                                  Random& random) const {
    constexpr double kLeastLeft = 0.5;  // share
    auto refined = refiner_.Refine(input);
    if (refined && refined->bones_m) {
      const double left = random.Uniform(kLeastLeft, 1.0);
      input.bones_m = true_m;
      for (size_t i = 0; i < kJointCount; ++i) {
        (*input.bones_m)[i] += left * ((*refined->bones_m)[i] - true_m[i]);
      }
      if (!options_.after.bone_conditioned.empty()) refined = refiner_.Refine(input);
    }
    if (!refined) return std::nullopt;
    return input.MovedTo(refined->joints_m);
  }

  const forest::ForestModel& model_;
  const RefinementStageOptions& options_;
  recon::JointRefiner refiner_;
  std::vector<size_t> target_of_joint_;
  std::vector<DatasetReader> readers_;
  std::vector<Place> places_;
};

}  // namespace

bool AreSeenFromAbove(const std::vector<std::filesystem::path>& datasets) {
  std::optional<bool> from_above;
  for (const auto& folder : datasets) {
    const std::string view = DatasetReader(folder).manifest().view;
    if (from_above.value_or(view == kFromAbove) != (view == kFromAbove)) {
      throw InputError(fmt::format(
          "{}: expected people seen as in {}: all from the ceiling or none, found view {}",
          folder.string(), datasets.front().string(), view));
    }
    from_above = view == kFromAbove;
  }
  return from_above.value_or(false);
}

RefinementExamples GatherRefinementExamples(const forest::ForestModel& model,
                                            const std::vector<std::filesystem::path>& datasets,
                                            const RefinementStageOptions& options) {
  const Gatherer gatherer(model, options, datasets);
  // Not all at once: there may be more of them than memory holds twice.
  constexpr size_t kBlock = 4096;
  std::vector<std::vector<RefinementExample>> found(kBlock);
  RefinementExamples out;
  out.all.reserve(gatherer.size() * static_cast<size_t>(1 + options.shifted));
  for (size_t first = 0; first < gatherer.size(); first += kBlock) {
    const size_t count = std::min(kBlock, gatherer.size() - first);
    oneapi::tbb::parallel_for(size_t{0}, count, [&](size_t i) {
      if (!options.stop || !options.stop()) found[i] = gatherer.Read(first + i);
    });
    if (options.stop && options.stop()) throw TrainInterrupted("interrupted");
    for (size_t i = 0; i < count; ++i) {
      out.people += found[i].empty() ? 0 : 1;
      out.all.insert(out.all.end(), found[i].begin(), found[i].end());
    }
  }
  constexpr size_t kFewest = kPerceptronBatch;
  if (out.people < kFewest) {
    throw InputError(
        fmt::format("refinement cascade: expected at least {} people who are seen, found {}",
                    kFewest, out.people));
  }
  return out;
}

PerceptronTraining MakeNetworkOptions(const RefinementStageOptions& options, Eigen::Index outputs) {
  PerceptronTraining learning;
  learning.hidden = {options.hidden, options.hidden / 2};
  learning.outputs = outputs;
  learning.epochs = options.epochs;
  learning.batch = 2 * kPerceptronBatch;
  learning.rate = static_cast<float>(options.rate);
  learning.dropped = 0.0F;
  learning.seed = options.seed;
  learning.stop = options.stop;
  return learning;
}

}  // namespace ossa::tools
