// `ossa experiment real`: every stage of the tracker on every real set. Only gains on these sets
// count, not those on rendered people alone.
#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/random.h"
#include "tools/experiments/context_models.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/real/real_agreement_internal.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/real/real_held_internal.h"
#include "tools/experiments/real/real_holes_internal.h"
#include "tools/experiments/real/real_tables_internal.h"
#include "tools/json/json_text.h"

namespace ossa::tools {
namespace {

using nlohmann::json;

bool IsFoot(recon::Joint joint) {
  return joint == recon::Joint::kFootLeft || joint == recon::Joint::kFootRight;
}

// ITOP's feet compared with our ankles: ITOP has NiTE's 15 joints, whose foot is the ankle. The
// offset from ankle to foot depends on the foot's direction and is not constant.
RealSet WithAnklesForFeet(RealSet set) {
  set.name += "_ankles";
  for (recon::Joint& joint : set.joints) {
    if (joint == recon::Joint::kFootLeft) joint = recon::Joint::kAnkleLeft;
    if (joint == recon::Joint::kFootRight) joint = recon::Joint::kAnkleRight;
  }
  return set;
}

ScoredSet ScoreSet(const RealSet& set, const std::vector<StillResult>& results, bool feet) {
  ScoredSet scored{.name = set.name + (feet ? "" : "_without_feet"), .scores = {}};
  scored.frames = static_cast<int64_t>(results.size());
  for (const StillResult& result : results) scored.one_body += result.bodies == 1;
  std::vector<bool> counted;
  for (const recon::Joint joint : set.joints) counted.push_back(feet || !IsFoot(joint));
  std::vector<RealStage> stages(kRealStages.begin(), kRealStages.end());
  if (!set.peer.empty()) stages.push_back(RealStage::kPeer);
  for (const bool removed : {false, true}) {
    for (const RealStage stage : stages) {
      const StageScore score = ScoreStage(set, results, stage, removed, counted);
      if (score.offset_removed == removed) scored.scores.push_back(score);
    }
  }
  return scored;
}

std::vector<StillResult> EvaluateAllStills(const RealSet& set, tracker::Tracker& tracker,
                                           ExperimentContext& context) {
  std::vector<StillResult> results;
  for (const RealStill& still : set.stills) {
    context.ThrowIfInterrupted();
    results.push_back(EvaluateStill(set, still, tracker));
    if (context.progress) {
      context.progress(static_cast<double>(results.size()), static_cast<double>(set.stills.size()),
                       set.name);
    }
  }
  return results;
}

void WriteJson(const ExperimentContext& context, const json& report) {
  AtomicFile file(context.out / "real.json");
  file.stream() << JsonText(report) << "\n";
  file.Commit();
}

struct RealSettings {
  int frames = 0;  // at most, of each set and recording; 0: all
  std::string pose_network;
  int lag = 0;
  bool fit = true;
};

RealSettings ReadSettings(Parameters& parameters) {
  return {parameters.Integer("frames", 0), parameters.Text("pose_network", ""),
          parameters.Integer("lag", 0, 0, 2), parameters.Flag("fit", true)};
}

tracker::TrackerOptions MakeOptions(const ExperimentContext& context,
                                    const RealSettings& settings) {
  tracker::TrackerOptions options;
  options.models = LoadModels(context, options.method);
  const std::string& network = settings.pose_network;
  if (!network.empty()) options.models->pose_network = tracker::LoadPoseNetwork(network);
  options.threads = context.threads;
  options.lag = settings.lag;
  if (!settings.fit) options.fit.reset();
  return options;
}

// Builds the tables and real.json, set by set.
class RealReport {
 public:
  RealReport(ExperimentContext& context, tracker::Tracker& tracker)
      : context_(context), tracker_(tracker) {}

  void Add(const RealSet& set) {
    const auto results = EvaluateAllStills(set, tracker_, context_);
    const ScoredSet scored = ScoreSet(set, results, true);
    AddJointRows(set, scored, joints_);
    for (const auto& [joint, agreement] : CompareJointsWithPeer(set, results)) {
      AddAgreementRow(set.name, joint, agreement, agreement_);
      report_["agreement"].push_back(AgreementToJson(set.name, joint, agreement));
    }
    AddScores(set, scored);
    AddRawAndFinalRow(set.name, ScoreRawAndFinal(set, results), raw_and_final_);
    AddHolesRow(scored, "none", holes_);
    for (const Holes holes : kAllHoles) AddWithHoles(set, holes);
    AddHeldFrames(set.name, set.stills, &RealStill::frame);
    const StateScore by_state = ScoreStates(set, results);
    AddStatesRow(set, by_state, states_);
    report_["states"].push_back(StatesToJson(set, by_state));
    if (std::none_of(set.joints.begin(), set.joints.end(), IsFoot)) return;
    AddScores(set, ScoreSet(set, results, false));
    if (!set.peer.empty()) AddAnklesForFeet(set);
  }

  void Add(const RealVideo& video) {
    context_.ThrowIfInterrupted();
    const VideoScore score = EvaluateVideo(video, tracker_);
    AddRecordingRow(video, score, recordings_);
    report_["recordings"].push_back(VideoToJson(video, score));
    if (video.stills) AddHeldFrames(video.name, video.frames);
  }

  std::vector<Table> Write() const {
    WriteJson(context_, report_);
    return {stills_, raw_and_final_, holes_, joints_, agreement_, states_, recordings_, held_};
  }

 private:
  void AddScores(const RealSet& set, const ScoredSet& scored) {
    AddStillsRows(set, scored, stills_);
    for (const json& row : SetToJson(set, scored)) report_["sets"].push_back(row);
  }

  void AddAnklesForFeet(const RealSet& set) {
    const RealSet ankles = WithAnklesForFeet(set);
    const auto results = EvaluateAllStills(ankles, tracker_, context_);
    AddScores(ankles, ScoreSet(ankles, results, true));
    AddRawAndFinalRow(ankles.name, ScoreRawAndFinal(ankles, results), raw_and_final_);
  }

  void AddWithHoles(const RealSet& set, Holes holes) {
    const RealSet holed = WithHoles(set, holes, context_.seed);
    const ScoredSet scored = ScoreSet(holed, EvaluateAllStills(holed, tracker_, context_), true);
    AddHolesRow(scored, HolesName(holes), holes_);
    for (json row : SetToJson(holed, scored)) {
      row["missing"] = HolesName(holes);
      report_["with_holes"].push_back(row);
    }
  }

  // Each still of a set; `frame_of` gives its depth frame.
  template <typename Still, typename FrameOf = std::identity>
  void AddHeldFrames(const std::string& name, const std::vector<Still>& stills,
                     FrameOf frame_of = {}) {
    HeldScore score;
    for (const Still& still : stills) {
      context_.ThrowIfInterrupted();
      AddHeld(std::invoke(frame_of, still),
              MixSeed(context_.seed, static_cast<uint64_t>(score.images)), tracker_, score);
    }
    AddHeldRow(name, score, held_);
    report_["held"].push_back(HeldToJson(name, score));
  }

  ExperimentContext& context_;
  tracker::Tracker& tracker_;
  Table stills_ = StillsTable(), joints_ = JointsTable(), states_ = StatesTable();
  Table agreement_ = AgreementTable();
  Table raw_and_final_ = RawAndFinalTable(), holes_ = HolesTable();
  Table recordings_ = RecordingsTable(), held_ = HeldTable();
  json report_ = {{"sets", json::array()},       {"with_holes", json::array()},
                  {"agreement", json::array()},  {"states", json::array()},
                  {"recordings", json::array()}, {"held", json::array()}};
};

}  // namespace

void ReadRealParameters(ExperimentContext& context) { ReadSettings(context.parameters); }

std::vector<Table> RunReal(ExperimentContext& context) {
  if (context.shared.empty()) throw InputError("real: expected --shared FOLDER with real/ in it");
  const RealSettings settings = ReadSettings(context.parameters);
  tracker::Tracker tracker(MakeOptions(context, settings));
  const auto sets = ReadRealSets(context.shared, settings.frames);
  const auto videos = ReadRealVideos(context.shared, settings.frames);
  if (sets.empty() && videos.empty()) {
    throw InputError(
        fmt::format("{}: expected real/depth_frames, real/itop_depth, "
                    "real/kinect_v1_seated_video or real/recordings in it",
                    context.shared.string()));
  }
  RealReport report(context, tracker);
  for (const RealSet& set : sets) report.Add(set);
  for (const RealVideo& video : videos) report.Add(video);
  return report.Write();
}

}  // namespace ossa::tools
