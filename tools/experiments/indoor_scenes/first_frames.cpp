// `ossa experiment first-frames`: people found in single images, with held objects and occluders.
#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/context_models.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/indoor_scenes/first_frames_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {
namespace {

struct Row {
  FirstFrameKind kind;
  FirstFramePlace where;
  int images = 0;                 // that show a person
  int one = 0;                    // exactly one body, at the person
  int nobody = 0;                 // no body at the person
  int more = 0;                   // extra bodies, at the person or elsewhere
  std::vector<double> error_m{};  // mean over the final joints of each person who was found
};

struct FirstFrameInputs {
  const recon::BodyModel& model;
  const std::vector<recon::RigPose>& poses;
  const tracker::TrackerOptions& how;
  int images;
};

// Mean over all joints.
double Distance_m(const tracker::Body& body, const TruthBody& truth) {
  double sum_m = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j)
    sum_m += (body.joints[j].position_m - truth.joints_m.position_m[j]).norm();
  return sum_m / static_cast<double>(recon::kJointCount);
}

void AddImage(const LabelledFrame& frame, const tracker::BodyFrame& answer, Row& row) {
  constexpr double kAt_m = 0.5;  // by hand: half a body's width and more
  constexpr int kShown =
      6;  // joints, by hand as in indoor-scenes: with fewer visible, a miss does not count
  const TruthBody& truth = frame.bodies.at(0);
  if (std::ranges::count(truth.visible, true) < kShown) return;
  ++row.images;
  std::optional<double> nearest_m;
  for (const tracker::Body& body : answer.bodies) {
    const double off_m = Distance_m(body, truth);
    if (off_m < nearest_m.value_or(kAt_m)) nearest_m = off_m;
  }
  const auto bodies = static_cast<int>(answer.bodies.size());
  row.nobody += nearest_m ? 0 : 1;
  row.more += bodies - (nearest_m ? 1 : 0);
  row.one += nearest_m && bodies == 1 ? 1 : 0;
  if (nearest_m) row.error_m.push_back(*nearest_m);
}

void EvaluateRow(const FirstFrameInputs& inputs, ExperimentContext& context, Row& row) {
  const FrameOptions options = FirstFrameOptions(row.kind, row.where, Split::kTest, context.seed);
  const FrameInputs frame_inputs(inputs.model, inputs.poses, options);
  FrameMaker maker(frame_inputs);
  tracker::Tracker tracker(inputs.how);
  for (int i = 0; i < inputs.images; ++i) {
    context.ThrowIfInterrupted();
    const LabelledFrame frame = Uncropped(maker.Make(i), MakeCamera(options));
    tracker.Reset();  // each image is a first frame
    AddImage(frame, tracker.Track(frame.depth), row);
  }
}

std::string PerCent(int part, int whole) {
  return whole == 0 ? "-" : fmt::format("{:.1f}", 100.0 * part / whole);
}

// Each pair of a background and an occluder, in the order of the tables.
std::vector<Row> EvaluateRows(ExperimentContext& context, const FirstFrameInputs& inputs) {
  std::vector<Row> rows;
  for (const FirstFramePlace& where : kFirstFramePlaces) {
    for (const FirstFrameKind& kind : kFirstFrameKinds)
      rows.push_back({.kind = kind, .where = where});
  }
  std::mutex mutex;
  size_t done = 0;
  RunJobs(rows.size(), context.threads, [&](size_t i) {
    EvaluateRow(inputs, context, rows[i]);
    const std::lock_guard lock(mutex);
    ++done;
    if (!context.progress) return;
    context.progress(static_cast<double>(done), static_cast<double>(rows.size()),
                     std::string(rows[i].kind.name));
  });
  return rows;
}

struct FirstFrameSettings {
  std::vector<std::string> sources;
  int images = 0;
};

FirstFrameSettings ReadSettings(ExperimentContext& context) {
  return {context.parameters.Motions("mocap"),
          context.parameters.Integer("images", context.full ? 200 : 25, 1)};
}

}  // namespace

FrameOptions FirstFrameOptions(const FirstFrameKind& kind, const FirstFramePlace& place,
                               Split split, uint64_t seed) {
  FrameOptions options;
  options.split = split;
  options.occluders = kind.occluders;
  options.background = place.background;
  options.hanging_clothes = true;
  options.variation = MakeVariation(Poses::kNatural);
  options.seed = seed;
  return options;
}

void ReadFirstFramesParameters(ExperimentContext& context) { ReadSettings(context); }

std::vector<Table> RunFirstFrames(ExperimentContext& context) {
  const auto [sources, images] = ReadSettings(context);
  tracker::TrackerOptions how;
  how.models = LoadModels(context, how.method);
  const auto clips = recon::LoadMocap(sources);
  const auto poses = MakePoseBank(clips, MakeBankOptions(Poses::kNatural));
  if (poses.empty()) throw InputError(sources.front() + ": expected motion, found no frames");
  const auto model = LoadFetchedBody();
  std::vector<Row> rows = EvaluateRows(context, {model, poses, how, images});

  Table table{.title = "First frames: one person in each image, seen once",
              .columns = {"background", "occluder", "images", "exactly one body, %", "nobody, %",
                          "extra bodies per 100 images", "joints' error, cm, median"},
              .rows = {},
              .note =
                  "Images in which six joints are seen or more. A body is the person's where its "
                  "joints are within 0.5 m of theirs in the mean. Bodies of the test split, in any "
                  "clothes."};
  for (Row& row : rows) {
    table.rows.push_back(
        {std::string(row.where.name), std::string(row.kind.name), std::to_string(row.images),
         PerCent(row.one, row.images), PerCent(row.nobody, row.images),
         PerCent(row.more, row.images),
         row.error_m.empty() ? "-" : fmt::format("{:.1f}", 100.0 * ossa::Median(row.error_m))});
  }
  return {table};
}

}  // namespace ossa::tools
