// `ossa experiment indoor-scenes`: one to six people in rendered indoor scenes, standing, crossing,
// among furniture.
#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "depth/base/error.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/context_models.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/indoor_scenes/indoor_scenes_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/tracker/picture.h"

namespace ossa::tools {
namespace {

struct Job {
  size_t scenario;
  uint64_t seed;
  int pictures_every;  // frames; 0: none
};

IndoorScore RunScenario(const IndoorScenario& scenario, const IndoorSceneInputs& inputs,
                        const Job& job, const tracker::TrackerOptions& how,
                        const ExperimentContext& context) {
  IndoorSceneRenderer renderer(scenario, inputs, job.seed);
  tracker::Tracker tracker(how);
  IndoorEvaluator evaluator;
  for (int64_t f = 0; f < renderer.size(); f += inputs.frame_step) {
    context.ThrowIfInterrupted();
    const LabelledFrame frame = renderer.RenderFrame(f);
    const tracker::BodyFrame answer = tracker.Track(frame.depth);
    evaluator.AddFrame(frame, answer);
    if (job.pictures_every == 0 || f % job.pictures_every != 0) continue;
    const auto name = fmt::format("{} {} {:03}.png", scenario.name, job.seed, f);
    tracker::WritePicture(context.out / name, frame.depth, answer);
  }
  return std::move(evaluator.score);
}

std::vector<IndoorScore> RunScenarios(const std::vector<Job>& jobs,
                                      const std::vector<IndoorScenario>& scenarios,
                                      const IndoorSceneInputs& inputs,
                                      const tracker::TrackerOptions& how,
                                      ExperimentContext& context) {
  std::vector<IndoorScore> scores(jobs.size());
  std::mutex mutex;
  size_t done = 0;
  RunJobs(jobs.size(), context.threads, [&](size_t i) {
    const IndoorScenario& scenario = scenarios[jobs[i].scenario];
    scores[i] = RunScenario(scenario, inputs, jobs[i], how, context);
    const std::lock_guard lock(mutex);
    ++done;
    if (!context.progress) return;
    context.progress(static_cast<double>(done), static_cast<double>(jobs.size()), scenario.name);
  });
  return scores;
}

std::string Share(int64_t part, int64_t whole) {
  if (whole == 0) return "-";
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string Cell(const std::optional<double>& value, double scale, int digits) {
  return value ? fmt::format("{:.{}f}", scale * *value, digits) : "-";
}

Table WhereTable() {
  return {.title = "Who is where",
          .columns = {"scenario", "frames", "people in view", "found, %", "cut, per 100 frames",
                      "invented, per 100 frames", "identity switches", "IoU of pixels"},
          .rows = {},
          .note =
              "In view: 0.1 m2 and six joints seen, each person in each frame. Cut: a second "
              "body on somebody who has one. Invented: a body that is nobody's."};
}

Table JointsTable() {
  return {.title = "Joints of the people in view",
          .columns = {"scenario", "raw: mAP 10 cm, %", "final: mAP 10 cm, %", "raw: mean error, cm",
                      "final: mean error, cm", "raw, seen joints: mAP 10 cm, %"},
          .rows = {},
          .note =
              "All 20 joints, also those hidden or outside the image. Raw: those that the forest "
              "does not find at all are missing, and in no error; final: all are placed. Last "
              "those that are seen. Who is not found has no joint right."};
}

Table JitterTable() {
  return {.title = "A still person, 3 m away",
          .columns = {"positions", "RMS about their means, mm", "wanted"},
          .rows = {},
          .note = "After the first second; the last performance."};
}

void AddRow(const std::string& name, const IndoorScore& s, Table& where, Table& joints) {
  where.rows.push_back(
      {name, std::to_string(s.frames), std::to_string(s.in_view), Share(s.found, s.in_view),
       Share(s.cut, s.frames), Share(s.invented, s.frames), std::to_string(s.switches),
       s.found == 0 ? "-" : fmt::format("{:.3f}", s.iou / static_cast<double>(s.found))});
  if (s.in_view == 0) return;
  const ClipMetrics raw = Measure(s.raw), last = Measure(s.final);
  joints.rows.push_back({name, Cell(raw.map_10cm, 100, 1), Cell(last.map_10cm, 100, 1),
                         Cell(raw.mean_joint_error_cm, 1, 2), Cell(last.mean_joint_error_cm, 1, 2),
                         Cell(Measure(s.raw_seen).map_10cm, 100, 1)});
}

// RMS distance of a resting person's joints from their means, millimetres, over joints present in
// nearly every frame. The first second is skipped: filters settle.
std::optional<double> Jitter_mm(const PairedTracks& track) {
  constexpr size_t kSettled = 30;  // frames, by hand: a second
  double square = 0, count = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    std::vector<Eigen::Vector3d> places;
    for (size_t f = kSettled; f < track.result.size(); ++f) {
      if (track.result[f].present[j]) places.push_back(track.result[f].position_m[j]);
    }
    if (places.empty() || 10 * places.size() < 9 * (track.result.size() - kSettled)) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : places) mean += p / static_cast<double>(places.size());
    for (const auto& p : places) square += (p - mean).squaredNorm();
    count += static_cast<double>(places.size());
  }
  if (count == 0) return std::nullopt;
  return 1000 * std::sqrt(square / count);
}

void AddJitterRows(const IndoorScore& s, Table& jitter) {
  jitter.rows.push_back({"raw, tracked joints", Cell(Jitter_mm(s.raw), 1, 1), "-"});
  jitter.rows.push_back({"final, default smoothing", Cell(Jitter_mm(s.final), 1, 1), "5"});
}

constexpr int kWidestImage = 4096;  // pixels, by hand: wider than any depth camera's

constexpr double kWidestLane_m = 3.0;  // by hand: two lanes fill a room

struct SceneSettings {
  std::vector<std::string> sources;
  int performances = 0, frames = 0, frame_step = 1, width = 0, pictures_every = 0;
  std::string only;  // part of a scenario's name
  Split split = Split::kTest;
  std::string method;
  bool physics = true, carried = false;
  double lane_m = 0.0;
};

SceneSettings ReadSettings(ExperimentContext& context) {
  Parameters& parameters = context.parameters;
  SceneSettings settings;
  settings.sources = parameters.Motions("mocap");
  settings.performances = parameters.Integer("performances", context.full ? 6 : 2, 1);
  settings.frames = parameters.Integer("frames", context.full ? 150 : 90, 2);
  settings.frame_step = parameters.Integer("frame_step", 1, 1, settings.frames - 1);
  settings.width = parameters.Integer("width", 640, 160, kWidestImage);
  settings.pictures_every = parameters.Integer("pictures_every", 0);
  settings.only = parameters.Text("only", "");
  settings.split = *SplitFromName(parameters.OneOf("split", {"train", "test"}, "test"));
  settings.method =
      parameters.OneOf("method", recon::ReconstructionMethods(), tracker::TrackerOptions().method);
  settings.physics = parameters.Flag("physics", true);
  settings.carried = parameters.Flag("carried_sensor", false);
  settings.lane_m = parameters.Number("lane_m", kUsualLane_m, 0.1, kWidestLane_m);
  return settings;
}

tracker::TrackerOptions MakeTrackerOptions(const ExperimentContext& context,
                                           const SceneSettings& settings) {
  tracker::TrackerOptions how;
  how.method = settings.method;
  how.models = LoadModels(context, how.method);
  how.physics = settings.physics;
  how.keep_parts = settings.pictures_every > 0;
  return how;
}

}  // namespace

void ReadIndoorScenesParameters(ExperimentContext& context) { ReadSettings(context); }

std::vector<Table> RunIndoorScenes(ExperimentContext& context) {
  const SceneSettings settings = ReadSettings(context);
  const tracker::TrackerOptions how = MakeTrackerOptions(context, settings);
  const auto clips = recon::LoadMocap(settings.sources);
  const auto model = LoadFetchedBody();
  const recon::Wardrobe wardrobe(model);
  const int width = settings.width;
  const IndoorSceneInputs inputs{model,
                                 wardrobe,
                                 clips,
                                 settings.split,
                                 width,
                                 width * 3 / 4,
                                 settings.frames,
                                 settings.frame_step,
                                 settings.carried,
                                 settings.lane_m};

  const auto scenarios = IndoorScenarios();
  std::vector<Job> jobs;
  for (size_t s = 0; s < scenarios.size(); ++s) {
    if (scenarios[s].name.find(settings.only) == std::string::npos) continue;
    for (int k = 0; k < settings.performances; ++k) {
      jobs.push_back(
          {s, context.seed * 1000 + s * 50 + static_cast<uint64_t>(k), settings.pictures_every});
    }
  }
  if (jobs.empty())
    throw InputError(fmt::format("indoor-scenes: no scenario has '{}' in its name", settings.only));
  const auto scores = RunScenarios(jobs, scenarios, inputs, how, context);

  Table where = WhereTable(), joints = JointsTable(), jitter = JitterTable();
  IndoorScore all;
  for (size_t i = 0; i < jobs.size();) {
    const size_t scenario = jobs[i].scenario;
    IndoorScore sum;
    for (; i < jobs.size() && jobs[i].scenario == scenario; ++i) sum.Add(scores[i]);
    if (scenarios[scenario].still) AddJitterRows(scores[i - 1], jitter);
    AddRow(scenarios[scenario].name, sum, where, joints);
    all.Add(sum);
  }
  AddRow("all", all, where, joints);
  if (jitter.rows.empty()) return {where, joints};
  return {where, joints, jitter};
}

}  // namespace ossa::tools
