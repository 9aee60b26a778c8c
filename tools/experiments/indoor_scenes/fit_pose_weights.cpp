// `ossa experiment person-classifier`: fits the combination of forest and pose network that
// classifies people and furniture (tools/people/pose_weights.inc).
#include <fmt/format.h>

#include <array>
#include <iterator>
#include <mutex>
#include <optional>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/motion/mocap.h"
#include "recon/refine/pose_network.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/indoor_scenes/first_frames_internal.h"
#include "tools/experiments/indoor_scenes/person_weights_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/people/feature_collector.h"
#include "tools/people/pose_evidence.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"
#include "tools/tracker/shipped.h"

namespace ossa::tools {
namespace {

// Parts of a person have joints, too: negative examples have hardly any pixels of people.
std::optional<bool> IsPerson(const std::vector<int32_t>& pixels, const LabelledFrame& truth) {
  const PixelShares shares = MeasureShares(pixels, truth);
  if (shares.of_piece > 0.4 && shares.of_person > 0.5) return true;
  if (shares.of_piece < 0.2) return false;
  return std::nullopt;
}

struct PoseWeightInputs {
  const recon::BodyModel& model;
  std::vector<recon::RigPose> poses;
  const people::FeatureCollector& collector;
  const recon::PoseNetwork& network;
  Split split;
  uint64_t seed;
  int images;  // of each kind and place
};

std::vector<LogisticExample> CollectExamples(const PoseWeightInputs& inputs,
                                             const FirstFrameKind& kind,
                                             const FirstFramePlace& place,
                                             ExperimentContext& context) {
  const FrameOptions options = FirstFrameOptions(kind, place, inputs.split, inputs.seed);
  const FrameInputs frame_inputs(inputs.model, inputs.poses, options);
  FrameMaker maker(frame_inputs);
  std::vector<LogisticExample> examples;
  for (int i = 0; i < inputs.images; ++i) {
    context.ThrowIfInterrupted();
    const LabelledFrame frame = Uncropped(maker.Make(i), MakeCamera(options));
    for (const auto& seen : inputs.collector.CollectPoses(frame.depth, inputs.network)) {
      const auto person = IsPerson(seen.pixels, frame);
      if (!person) continue;
      const auto terms = people::PoseTerms(seen.forest_score, seen.certainty);
      examples.push_back({*person, Eigen::Map<const Eigen::VectorXd>(
                                       terms.data(), static_cast<Eigen::Index>(terms.size()))});
    }
  }
  return examples;
}

std::vector<LogisticExample> Gather(const PoseWeightInputs& inputs, ExperimentContext& context) {
  constexpr size_t kRows = kFirstFrameKinds.size() * kFirstFramePlaces.size();
  std::vector<std::vector<LogisticExample>> rows(kRows);
  std::mutex mutex;
  int done = 0;
  RunJobs(kRows, context.threads, [&](size_t i) {
    rows[i] = CollectExamples(inputs, kFirstFrameKinds[i % kFirstFrameKinds.size()],
                              kFirstFramePlaces[i / kFirstFrameKinds.size()], context);
    const std::lock_guard lock(mutex);
    if (context.progress) context.progress(++done, static_cast<double>(kRows), "first frames");
  });
  std::vector<LogisticExample> all;
  for (auto& row : rows) std::move(row.begin(), row.end(), std::back_inserter(all));
  if (all.empty()) throw InputError("first frames: expected anything like a person, found nothing");
  return all;
}

}  // namespace

Table FitPoseWeights(ExperimentContext& context) {
  const PersonClassifierSettings settings = ReadPersonClassifierSettings(context);
  const recon::BodyModel model = LoadFetchedBody();
  const auto forest = context.model.empty() ? tracker::ShippedFile("body.ossa") : context.model;
  const people::FeatureCollector collector(forest);
  const auto network = recon::PoseNetwork::Load(tracker::ShippedFile(recon::kShippedPoseNetwork));
  const auto gather = [&](const std::string& mocap, Split split, uint64_t seed) {
    auto poses = MakePoseBank(recon::LoadMocap({mocap}), MakeBankOptions(Poses::kNatural));
    if (poses.empty()) throw InputError(mocap + ": expected motion, found no frames");
    return Gather({model, std::move(poses), collector, network, split, seed, settings.images},
                  context);
  };
  const auto fitted = gather(settings.train, Split::kTrain, context.seed + 1);
  const Eigen::VectorXd weights = FitLogistic(fitted, settings.prior);
  AtomicFile file(context.out / "pose_weights.inc");
  file.stream() << "// Written by `ossa experiment person-classifier`.\n"
                << ArrayText("kPoseWeights", weights);
  file.Commit();
  Table table{.title = "People and other things, by forest and pose network, single images",
              .columns = kPassedColumns,
              .rows = {},
              .note = "Weights: pose_weights.inc, to be put into tools/people."};
  AddPassedRows("fitted on", weights, fitted, table);
  AddPassedRows("others", weights, gather(settings.check, Split::kTest, context.seed), table);
  AddPassedRows("others, on the floor", weights,
                gather(kFloorMotion, Split::kTest, context.seed + 2), table);
  return table;
}

}  // namespace ossa::tools
