#include "tools/learning/learn_close_look.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <thread>

#include "depth/error.h"
#include "forest/classify.h"
#include "forest/propose.h"
#include "forest/targets.h"
#include "forest/train.h"
#include "recon/skeleton.h"
#include "tools/learning/learn_rectified_network.h"
#include "tools/learning/segmented_person.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {
namespace {

using recon::kJointCount;
using recon::kLookJoints;
using recon::LookDescription;

// A person as proposed, and how far from there the joints are, in the description's axes.
struct Example {
  LookDescription description;
  std::array<Eigen::Vector3f, kJointCount> offset_m{};
};

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
  std::optional<Example> Read(size_t index) const {
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
    Example example{*description, {}};
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
    return input.MovedTo(*looked);
  }

  const forest::ForestModel& model_;
  recon::Looker looker_;
  std::vector<size_t> target_of_joint_;
  std::vector<DatasetReader> readers_;
  std::vector<Place> places_;
};

// Two rows a person: as it is, and mirrored. What is off by more was mistaken for something else,
// and nothing near the proposal tells of it.
forest::NetworkExamples ExamplesOf(const std::vector<Example>& people, recon::Joint joint) {
  constexpr float kFarthest_m = 0.6F;
  const auto rows = 2 * static_cast<Eigen::Index>(people.size());
  forest::NetworkExamples out{forest::RowMatrix(rows, recon::kLookInputs),
                              forest::RowMatrix(rows, 3)};
  const auto index = static_cast<size_t>(recon::Index(joint));
  const auto other = static_cast<size_t>(recon::kMirroredJoint[index]);
  const auto want = [&out](Eigen::Index row, const Eigen::Vector3f& offset_m) {
    const bool is_near = offset_m.norm() < kFarthest_m;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      out.wanted(row, axis) = is_near
                                  ? offset_m[axis] / static_cast<float>(recon::CloseLook::kStep_m)
                                  : std::numeric_limits<float>::quiet_NaN();
    }
  };
  for (size_t i = 0; i < people.size(); ++i) {
    const Example& person = people[i];
    const auto row = 2 * static_cast<Eigen::Index>(i);
    out.input.row(row) = recon::NumbersOf(person.description, joint).transpose();
    want(row, person.offset_m[index]);
    out.input.row(row + 1) = recon::NumbersOf(person.description.Mirrored(), joint).transpose();
    want(row + 1, person.offset_m[other].cwiseProduct(Eigen::Vector3f(-1, 1, 1)));
  }
  return out;
}

std::vector<Example> Gather(const Gatherer& gatherer, const CloseLookOptions& options) {
  std::vector<std::optional<Example>> found(gatherer.size());
  oneapi::tbb::parallel_for(size_t{0}, found.size(), [&](size_t i) {
    if (!options.stop || !options.stop()) found[i] = gatherer.Read(i);
  });
  if (options.stop && options.stop()) throw forest::TrainInterrupted("interrupted");
  std::vector<Example> people;
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

}  // namespace

recon::CloseLook LearnCloseLook(const forest::ForestModel& model,
                                const std::vector<std::filesystem::path>& datasets,
                                const CloseLookOptions& options) {
  const oneapi::tbb::global_control limit(
      oneapi::tbb::global_control::max_allowed_parallelism,
      options.threads > 0 ? static_cast<size_t>(options.threads)
                          : std::max<size_t>(1, std::thread::hardware_concurrency()));
  recon::CloseLook look = options.after;
  const std::vector<Example> people = Gather(Gatherer(model, options, datasets), options);
  look.people = people.size();
  recon::Glance& learned = look.glances.emplace_back();
  std::mutex mutex;
  std::array<int64_t, kLookJoints.size()> done{};
  oneapi::tbb::parallel_for(size_t{0}, kLookJoints.size(), [&](size_t k) {
    forest::NetworkExamples examples = ExamplesOf(people, kLookJoints[k]);
    forest::NetworkOptions learning;
    learning.hidden = {options.hidden, options.hidden / 2};
    learning.outputs = 3;
    learning.epochs = options.epochs;
    // Of decays of 0.02 to 1, with and without dropout, the best on validation subjects.
    learning.batch = 2 * forest::kNetworkBatch;
    learning.rate = 2e-3F;
    learning.decay = 0.5F;
    learning.dropped = 0.0F;
    learning.seed = options.seed;
    learning.stop = options.stop;
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
