// The tables of `ossa experiment real`.
#include <fmt/format.h>

#include <map>

#include "depth/base/statistics.h"
#include "tools/experiments/real/real_tables_internal.h"
#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {
namespace {

std::string Percent(double share) { return fmt::format("{:.1f}", 100 * share); }

std::string PercentOf(int64_t part, int64_t whole) {
  return whole == 0 ? "-" : Percent(static_cast<double>(part) / static_cast<double>(whole));
}

std::string CentimetresCell(const std::vector<double>& values_m) {
  return values_m.empty() ? "-" : fmt::format("{:.1f}", 100 * ossa::Median(values_m));
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

}  // namespace

std::string NameInTable(const RealSet& set, RealStage stage) {
  return stage == RealStage::kPeer ? set.peer : std::string(StageName(stage));
}

Table StillsTable() {
  return {.title = "Real stills with truth, each tracked alone",
          .columns = {"set", "stage", "offset removed", "stills", "one body, %", "joints",
                      "found, %", "mean, cm", "within 5 cm, %", "within 10 cm, %"},
          .rows = {},
          .note =
              "The mean is over the joints found; shares are of all joints with truth: a missing "
              "joint is wrong. Joints marked by eye are compared perpendicular to the line of "
              "sight. Offset removed: each joint's median error in camera axes is subtracted, "
              "because data sets define joints centimetres apart; for itop_* the median over the "
              "other half of the stills, for marked sets over all of them; at least three stills. "
              "A2J: a network trained on ITOP."};
}

void AddStillsRows(const RealSet& set, const ScoredSet& scored, Table& table) {
  for (const StageScore& s : scored.scores) {
    table.rows.push_back({scored.name, NameInTable(set, s.stage), s.offset_removed ? "yes" : "no",
                          std::to_string(scored.frames), PercentOf(scored.one_body, scored.frames),
                          std::to_string(s.joints), PercentOf(s.found, s.joints), Cell(s.mean_cm),
                          Percent(s.within_5cm), Percent(s.within_10cm)});
  }
}

Table RawAndFinalTable() {
  return {.title = "Final against raw: the joints that raw has, offset removed",
          .columns = {"set", "joints", "raw: mean, cm", "final: mean, cm", "change, %"},
          .rows = {},
          .note = "In the first table each mean is over the joints that its stage has."};
}

void AddRawAndFinalRow(const std::string& set, const RawAndFinal& s, Table& table) {
  if (s.joints == 0 || !s.offset_removed) return;
  table.rows.push_back({set, std::to_string(s.joints), fmt::format("{:.2f}", s.raw_cm),
                        fmt::format("{:.2f}", s.final_cm),
                        fmt::format("{:+.1f}", 100 * (s.final_cm / s.raw_cm - 1))});
}

Table HolesTable() {
  return {
      .title = "Stills with pixels missing: final joints, offset removed",
      .columns = {"set", "missing", "one body, %", "mean, cm", "within 10 cm, %"},
      .rows = {},
      .note = "The same stills; readings are removed that other sensors would not have either."};
}

void AddHolesRow(const ScoredSet& scored, std::string_view holes, Table& table) {
  for (const StageScore& s : scored.scores) {
    if (s.stage != RealStage::kFinal || !s.offset_removed) continue;
    table.rows.push_back({scored.name, std::string(holes),
                          PercentOf(scored.one_body, scored.frames), Cell(s.mean_cm),
                          Percent(s.within_10cm)});
  }
}

Table JointsTable() {
  return {.title = "Joint by joint: within 10 cm, %, offset removed",
          .columns = {"set", "joint", "raw", "refined", "final", "peer"},
          .rows = {},
          .note = ""};
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
          "Where neither is near the truth but both are near each other, the truth is in doubt."};
}

void AddAgreementRow(const std::string& set, const std::string& joint, const PeerAgreement& a,
                     Table& table) {
  if (a.joints == 0) return;
  table.rows.push_back({set, joint, std::to_string(a.joints), std::to_string(a.both),
                        std::to_string(a.only_final), std::to_string(a.only_peer),
                        std::to_string(a.neither), std::to_string(a.agreeing),
                        CentimetresCell(a.to_truth_m), CentimetresCell(a.to_peer_m)});
}

Table StatesTable() {
  return {.title = "Final joints by their state: within 10 cm, %, offset removed",
          .columns = {"set", "tracked, % of joints", "of tracked ones", "of all others"},
          .rows = {},
          .note = ""};
}

void AddStatesRow(const RealSet& set, const StateScore& s, Table& table) {
  if (!s.offset_removed) return;
  table.rows.push_back({set.name, PercentOf(s.tracked, s.tracked + s.others),
                        PercentOf(s.tracked_within_10cm, s.tracked),
                        PercentOf(s.others_within_10cm, s.others)});
}

Table HeldTable() {
  return {.title = "Stills shown for a second, with a sensor's noise",
          .columns = {"set", "images", "first frame: one body, nobody, %", "bodies",
                      "last frame: one body, nobody, %", "bodies"},
          .rows = {},
          .note = "Nothing moves: the last frame shows the same people as the first."};
}

void AddHeldRow(const std::string& set, const HeldScore& score, Table& table) {
  std::vector<std::string> row = {set, std::to_string(score.images)};
  for (const BodyCounts& counts : {score.first, score.last}) {
    row.push_back(PercentOf(counts.one, score.images) + " / " +
                  PercentOf(counts.nobody, score.images));
    row.push_back(std::to_string(counts.bodies));
  }
  table.rows.push_back(std::move(row));
}

Table RecordingsTable() {
  return {
      .title = "Real recordings without truth",
      .columns = {"recording", "frames", "bodies a frame", "one body, %", "identity breaks",
                  "jitter raw / refined / final, mm", "leaps raw / refined / final in 100 frames",
                  "bones raw / refined / final, %", "explained, %", "alone: one body, nobody, %"},
      .rows = {},
      .note =
          "Jitter: RMS distance from the mean over six frames in which the raw joint is at rest. "
          "Leaps: joints that are more than half a metre from their position one frame before. "
          "Bones: standard deviation of a bone's length. Explained: share of the users' pixels "
          "within 5 cm of the posed body's capsules. Alone: each frame tracked as a first one."};
}

void AddRecordingRow(const RealVideo& video, const VideoScore& s, Table& table) {
  table.rows.push_back(
      {video.name, std::to_string(s.frames),
       fmt::format("{:.2f}", static_cast<double>(s.bodies) / static_cast<double>(s.frames)),
       PercentOf(s.one_body, s.frames), std::to_string(s.identity_breaks), ByStage(s.jitter_mm),
       ByStage(s.leaps), ByStage(s.bone_variation), Percent(s.explained),
       PercentOf(s.one_alone, s.frames) + " / " + PercentOf(s.nobody_alone, s.frames)});
}

}  // namespace ossa::tools
