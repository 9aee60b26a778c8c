// `ossa experiment real`: every stage of the tracker on every real set. Only gains on these sets
// count, not those on rendered people alone.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "tools/experiments/context_models.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/real/real_agreement_internal.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/real/real_holes_internal.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/json/json_text.h"

namespace ossa::tools {
namespace {

using nlohmann::json;

struct ScoredSet {
  std::string name;
  int64_t frames = 0, one_body = 0;
  std::vector<StageScore> scores;
};

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

std::string NameInTable(const RealSet& set, RealStage stage) {
  return stage == RealStage::kPeer ? set.peer : std::string(StageName(stage));
}

std::string Percent(double share) { return fmt::format("{:.1f}", 100 * share); }

Table StillsTable() {
  return {.title = "Real stills with truth, each seen alone",
          .columns = {"set", "stage", "offset removed", "stills", "one body, %", "joints",
                      "found, %", "mean, cm", "within 5 cm, %", "within 10 cm, %"},
          .rows = {},
          .note =
              "Mean of the joints found; the shares are of all joints with truth: a missing one is "
              "wrong. Marks by eye count across the line of sight. Offset removed: of each joint "
              "its median error in camera axes, for eye, rig and other data sets' joints disagree "
              "by centimetres, where three stills or more say it; of itop_* the median over the "
              "other half of the stills, of marked "
              "sets over all of them. peer: a network trained on that data set."};
}

Table JointsTable() {
  return {.title = "Joint by joint: within 10 cm, %, offset removed",
          .columns = {"set", "joint", "raw", "refined", "final", "peer"},
          .rows = {},
          .note = ""};
}

Table VideosTable() {
  return {
      .title = "Real recordings without truth",
      .columns = {"recording", "frames", "bodies a frame", "one body, %", "identity breaks",
                  "jitter raw / refined / final, mm", "leaps raw / refined / final in 100 frames",
                  "bones raw / refined / final, %", "explained, %", "alone: one body, nobody, %"},
      .rows = {},
      .note =
          "Jitter: root mean square about the mean of six frames in which the raw joint holds "
          "still. Leaps: joints that are more than half a metre from where they were a frame "
          "before. Bones: standard deviation of a bone's length. Explained: share of the "
          "users' pixels within 5 cm of the posed body's capsules. Alone: each frame as if it were "
          "the first."};
}

void AddRows(const RealSet& set, const ScoredSet& scored, Table& table) {
  for (const StageScore& s : scored.scores) {
    const double found =
        s.joints == 0 ? 0 : static_cast<double>(s.found) / static_cast<double>(s.joints);
    const double one = static_cast<double>(scored.one_body) / static_cast<double>(scored.frames);
    table.rows.push_back({scored.name, NameInTable(set, s.stage), s.offset_removed ? "yes" : "no",
                          std::to_string(scored.frames), Percent(one), std::to_string(s.joints),
                          Percent(found), Cell(s.mean_cm), Percent(s.within_5cm),
                          Percent(s.within_10cm)});
  }
}

Table StatesTable() {
  return {.title = "Final joints by their state: within 10 cm, %, offset removed",
          .columns = {"set", "tracked, % of joints", "of tracked ones", "of all others"},
          .rows = {},
          .note = ""};
}

Table RawAndFinalTable() {
  return {
      .title = "Final against raw: the joints that raw has, offset removed",
      .columns = {"set", "joints", "raw: mean, cm", "final: mean, cm", "change, %"},
      .rows = {},
      .note =
          "The first table's means are each of the joints found; here both are of the same ones."};
}

void AddRow(const std::string& set, const RawAndFinal& s, Table& table) {
  if (s.joints == 0 || !s.offset_removed) return;
  table.rows.push_back({set, std::to_string(s.joints), fmt::format("{:.2f}", s.raw_cm),
                        fmt::format("{:.2f}", s.final_cm),
                        fmt::format("{:+.1f}", 100 * (s.final_cm / s.raw_cm - 1))});
}

Table HolesTable() {
  return {.title = "Stills with pixels missing: final joints, offset removed",
          .columns = {"set", "missing", "one body, %", "mean, cm", "within 10 cm, %"},
          .rows = {},
          .note = "The same stills with readings taken out, as other sensors leave them out."};
}

void AddHolesRow(const ScoredSet& scored, std::string_view holes, Table& table) {
  for (const StageScore& s : scored.scores) {
    if (s.stage != RealStage::kFinal || !s.offset_removed) continue;
    const double one = static_cast<double>(scored.one_body) / static_cast<double>(scored.frames);
    table.rows.push_back(
        {scored.name, std::string(holes), Percent(one), Cell(s.mean_cm), Percent(s.within_10cm)});
  }
}

void AddStateRow(const RealSet& set, const StateScore& s, Table& table) {
  if (!s.offset_removed) return;
  const auto share = [](int64_t part, int64_t whole) {
    return whole == 0 ? std::string("-")
                      : Percent(static_cast<double>(part) / static_cast<double>(whole));
  };
  table.rows.push_back({set.name, share(s.tracked, s.tracked + s.others),
                        share(s.tracked_within_10cm, s.tracked),
                        share(s.others_within_10cm, s.others)});
}

void AddJointRows(const RealSet& set, const ScoredSet& scored, Table& table) {
  for (const std::string& joint : set.joint_names) {
    std::map<RealStage, std::string> cell;
    for (const StageScore& s : scored.scores) {
      const auto share = s.per_joint_10cm.find(joint);
      if (s.offset_removed && share != s.per_joint_10cm.end())
        cell[s.stage] = Percent(share->second);
    }
    if (cell.empty()) continue;
    table.rows.push_back({set.name, joint, cell[RealStage::kRaw], cell[RealStage::kRefined],
                          cell[RealStage::kFinal],
                          set.peer.empty() ? "-" : cell[RealStage::kPeer]});
  }
}

Table AgreementTable() {
  return {
      .title = "Final joints and the peer's: stills within 10 cm of the truth, offset removed",
      .columns = {"set", "joint", "joints", "both", "final only", "peer only", "neither",
                  "of neither: within 10 cm of each other",
                  "of neither: final to truth, median, cm", "final to peer, median, cm"},
      .rows = {},
      .note =
          "Where neither is near the truth but both are near each other the truth is in doubt."};
}

std::string CentimetresCell(const std::vector<double>& values_m) {
  return values_m.empty() ? "-" : fmt::format("{:.1f}", 100 * ossa::Median(values_m));
}

void AddRow(const std::string& set, const std::string& joint, const PeerAgreement& a,
            Table& table) {
  if (a.joints == 0) return;
  table.rows.push_back({set, joint, std::to_string(a.joints), std::to_string(a.both),
                        std::to_string(a.only_final), std::to_string(a.only_peer),
                        std::to_string(a.neither), std::to_string(a.agreeing),
                        CentimetresCell(a.to_truth_m), CentimetresCell(a.to_peer_m)});
}

json AgreementToJson(const std::string& set, const std::string& joint, const PeerAgreement& a) {
  return {{"name", set},
          {"joint", joint},
          {"joints", a.joints},
          {"both_within_10cm", a.both},
          {"final_only", a.only_final},
          {"peer_only", a.only_peer},
          {"neither", a.neither},
          {"neither_within_10cm_of_each_other", a.agreeing}};
}

std::string ByStage(const std::map<RealStage, double>& values) {
  std::string text;
  for (const RealStage stage : kRealStages) {
    const auto value = values.find(stage);
    text += (text.empty() ? "" : " / ") +
            (value == values.end() ? std::string("-") : fmt::format("{:.1f}", value->second));
  }
  return text;
}

void AddRow(const RealVideo& video, const VideoScore& s, Table& table) {
  const auto frames = static_cast<double>(s.frames);
  table.rows.push_back({video.name, std::to_string(s.frames),
                        fmt::format("{:.2f}", static_cast<double>(s.bodies) / frames),
                        Percent(static_cast<double>(s.one_body) / frames),
                        std::to_string(s.identity_breaks), ByStage(s.jitter_mm), ByStage(s.leaps),
                        ByStage(s.bone_variation), Percent(s.explained),
                        Percent(static_cast<double>(s.one_alone) / frames) + " / " +
                            Percent(static_cast<double>(s.nobody_alone) / frames)});
}

json SetToJson(const RealSet& set, const ScoredSet& scored) {
  json list = json::array();
  for (const StageScore& s : scored.scores) {
    list.push_back(
        {{"name", scored.name},
         {"stage", NameInTable(set, s.stage)},
         {"frames", scored.frames},
         {"one_body", static_cast<double>(scored.one_body) / static_cast<double>(scored.frames)},
         {"mean_cm", s.mean_cm ? json(*s.mean_cm) : json()},
         {"within_5cm", s.within_5cm},
         {"within_10cm", s.within_10cm},
         {"per_joint", s.per_joint_10cm},
         {"offset_removed", s.offset_removed}});
  }
  return list;
}

json VideoToJson(const RealVideo& video, const VideoScore& s) {
  json jitter, leaps, bones;
  for (const auto& [stage, value] : s.jitter_mm) jitter[std::string(StageName(stage))] = value;
  for (const auto& [stage, value] : s.leaps) leaps[std::string(StageName(stage))] = value;
  for (const auto& [stage, value] : s.bone_variation) bones[std::string(StageName(stage))] = value;
  return {{"name", video.name},
          {"frames", s.frames},
          {"bodies_per_frame", static_cast<double>(s.bodies) / static_cast<double>(s.frames)},
          {"one_body", static_cast<double>(s.one_body) / static_cast<double>(s.frames)},
          {"identity_breaks", s.identity_breaks},
          {"jitter_mm", jitter},
          {"leaps_per_100_frames", leaps},
          {"bone_variation_percent", bones},
          {"explained", s.explained},
          {"one_body_alone", static_cast<double>(s.one_alone) / static_cast<double>(s.frames)},
          {"nobody_alone", static_cast<double>(s.nobody_alone) / static_cast<double>(s.frames)}};
}

json StatesToJson(const RealSet& set, const StateScore& s) {
  return {{"name", set.name},
          {"tracked", s.tracked},
          {"tracked_within_10cm", s.tracked_within_10cm},
          {"offset_removed", s.offset_removed},
          {"others", s.others},
          {"others_within_10cm", s.others_within_10cm}};
}

std::vector<StillResult> EvaluateStillsOfSets(const RealSet& set, tracker::Tracker& tracker,
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
    const auto results = EvaluateStillsOfSets(set, tracker_, context_);
    const ScoredSet scored = ScoreSet(set, results, true);
    AddJointRows(set, scored, joints_);
    for (const auto& [joint, agreement] : CompareJointsWithPeer(set, results)) {
      AddRow(set.name, joint, agreement, agreement_);
      report_["agreement"].push_back(AgreementToJson(set.name, joint, agreement));
    }
    AddScores(set, scored);
    AddRow(set.name, ScoreRawAndFinal(set, results), raw_and_final_);
    AddHolesRow(scored, "none", holes_);
    for (const Holes holes : kAllHoles) AddWithHoles(set, holes);
    const StateScore by_state = ScoreStates(set, results);
    AddStateRow(set, by_state, states_);
    report_["states"].push_back(StatesToJson(set, by_state));
    if (std::none_of(set.joints.begin(), set.joints.end(), IsFoot)) return;
    AddScores(set, ScoreSet(set, results, false));
    if (!set.peer.empty()) AddAnklesForFeet(set);
  }

  void Add(const RealVideo& video) {
    context_.ThrowIfInterrupted();
    const VideoScore score = EvaluateVideo(video, tracker_);
    AddRow(video, score, recordings_);
    report_["recordings"].push_back(VideoToJson(video, score));
  }

  std::vector<Table> Write() const {
    WriteJson(context_, report_);
    return {stills_, raw_and_final_, holes_, joints_, agreement_, states_, recordings_};
  }

 private:
  void AddScores(const RealSet& set, const ScoredSet& scored) {
    AddRows(set, scored, stills_);
    for (const json& row : SetToJson(set, scored)) report_["sets"].push_back(row);
  }

  void AddAnklesForFeet(const RealSet& set) {
    const RealSet ankles = WithAnklesForFeet(set);
    const auto results = EvaluateStillsOfSets(ankles, tracker_, context_);
    AddScores(ankles, ScoreSet(ankles, results, true));
    AddRow(ankles.name, ScoreRawAndFinal(ankles, results), raw_and_final_);
  }

  void AddWithHoles(const RealSet& set, Holes holes) {
    const RealSet holed = WithHoles(set, holes, context_.seed);
    const ScoredSet scored = ScoreSet(holed, EvaluateStillsOfSets(holed, tracker_, context_), true);
    AddHolesRow(scored, HolesName(holes), holes_);
    for (json row : SetToJson(holed, scored)) {
      row["missing"] = HolesName(holes);
      report_["with_holes"].push_back(row);
    }
  }

  ExperimentContext& context_;
  tracker::Tracker& tracker_;
  Table stills_ = StillsTable(), joints_ = JointsTable(), states_ = StatesTable();
  Table agreement_ = AgreementTable();
  Table raw_and_final_ = RawAndFinalTable(), holes_ = HolesTable();
  Table recordings_ = VideosTable();
  json report_ = {{"sets", json::array()},
                  {"with_holes", json::array()},
                  {"agreement", json::array()},
                  {"states", json::array()},
                  {"recordings", json::array()}};
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
