#include "tools/learning/look_examples.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <optional>

#include "depth/error.h"
#include "forest/classify.h"
#include "forest/propose.h"
#include "forest/targets.h"
#include "forest/train.h"
#include "recon/skeleton.h"
#include "tools/learning/segmented_person.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {
namespace {

using recon::kJointCount;
using recon::LookDescription;

// Reads data sets and asks the forest.
class Gatherer {
 public:
  Gatherer(const forest::ForestModel& model, const CloseLookOptions& options,
           const std::vector<std::filesystem::path>& datasets)
      : model_(model),
        looker_(options.after),
        target_of_joint_(forest::TargetsNamed(model, recon::kJointNames, options.model_name)) {
    for (const auto& folder : datasets) {
      readers_.emplace_back(folder);
      for (int64_t f = 0; f < readers_.back().frame_count(); ++f) {
        places_.push_back({readers_.size() - 1, f});
      }
    }
  }

  size_t size() const { return places_.size(); }

  /// Of one person of the frame, in turn where there are several. Nothing where too little is seen
  /// or some joint has no proposal.
  std::optional<LookExample> Read(size_t index) const {
    const auto [dataset, number] = places_[index];
    const DatasetReader& reader = readers_[dataset];
    LabelledFrame frame = Uncropped(reader.Read(number), reader.manifest().camera);
    if (frame.bodies.empty()) return std::nullopt;
    LayFloor(&frame);
    const TruthBody& body = frame.bodies[static_cast<size_t>(number) % frame.bodies.size()];
    std::vector<uint8_t> is_person;
    const auto input = Propose(frame, body.id, &is_person);
    if (!input) return std::nullopt;
    const auto description = LookDescription::Of(*input);
    if (!description) return std::nullopt;
    LookExample example{*description, {}, recon::BoneLengthsOf(body.joints_m)};
    for (size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d offset_m = body.joints_m.position_m[j] - input->proposed.position_m[j];
      example.offset_m[j] = (description->frame_from_camera * offset_m).cast<float>();
    }
    return example;
  }

 private:
  struct Place {
    size_t dataset = 0;
    int64_t frame = 0;
  };

  // The likeliest place of each joint, after the glances that are known already; the result borrows
  // from frame and `is_person`.
  std::optional<recon::LookInput> Propose(const LabelledFrame& frame, int id,
                                          std::vector<uint8_t>* is_person) const {
    constexpr size_t kFewest = 200;  // pixels: fewer are a hand or a head
    const depth::DepthFrame& depth = frame.depth;
    std::vector<int32_t> pixels;
    *is_person = SegmentedPerson(frame, id);
    for (size_t i = 0; i < is_person->size(); ++i) {
      if ((*is_person)[i] != 0) pixels.push_back(static_cast<int32_t>(i));
    }
    if (pixels.size() < kFewest) return std::nullopt;
    const auto classes = forest::Classify(model_, depth.view(), depth.camera, pixels);
    const auto proposals = forest::Propose(model_, depth.view(), depth.camera, classes);
    recon::LookInput input;
    for (size_t j = 0; j < kJointCount; ++j) {
      const auto& best_first = proposals[target_of_joint_[j]];
      if (best_first.empty()) return std::nullopt;
      input.proposed.position_m[j] = best_first.front().position_m;
      input.confidence[j] = best_first.front().confidence;
      input.seen[j] = best_first.front().seen;
    }
    input.depth = &depth;
    input.is_person = *is_person;
    const auto looked = looker_.Look(input);
    if (!looked) return std::nullopt;
    return input.MovedTo(looked->joints_m);
  }

  const forest::ForestModel& model_;
  recon::Looker looker_;
  std::vector<size_t> target_of_joint_;
  std::vector<DatasetReader> readers_;
  std::vector<Place> places_;
};

}  // namespace

std::vector<LookExample> GatherLookExamples(const forest::ForestModel& model,
                                            const std::vector<std::filesystem::path>& datasets,
                                            const CloseLookOptions& options) {
  const Gatherer gatherer(model, options, datasets);
  std::vector<std::optional<LookExample>> found(gatherer.size());
  oneapi::tbb::parallel_for(size_t{0}, found.size(), [&](size_t i) {
    if (!options.stop || !options.stop()) found[i] = gatherer.Read(i);
  });
  if (options.stop && options.stop()) throw forest::TrainInterrupted("interrupted");
  std::vector<LookExample> people;
  for (auto& example : found) {
    if (example) people.push_back(std::move(*example));
    example.reset();
  }
  constexpr size_t kFewest = forest::kNetworkBatch;
  if (people.size() < kFewest) {
    throw InputError(fmt::format("close look: expected at least {} people who are seen, found {}",
                                 kFewest, people.size()));
  }
  return people;
}

forest::NetworkOptions LookLearning(const CloseLookOptions& options, Eigen::Index outputs) {
  forest::NetworkOptions learning;
  learning.hidden = {options.hidden, options.hidden / 2};
  learning.outputs = outputs;
  learning.epochs = options.epochs;
  learning.batch = 2 * forest::kNetworkBatch;
  learning.rate = 2e-3F;
  learning.dropped = 0.0F;
  learning.seed = options.seed;
  learning.stop = options.stop;
  return learning;
}

}  // namespace ossa::tools
