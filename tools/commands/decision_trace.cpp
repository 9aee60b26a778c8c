#include "tools/commands/decision_trace.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/commands/outputs.h"

namespace ossa::commands {
namespace {

using nlohmann::ordered_json;

double RoundToMillimetres(double x) { return std::round(1000 * x) / 1000; }

ordered_json MakeVector(const Eigen::Vector3d& v) {
  return {RoundToMillimetres(v.x()), RoundToMillimetres(v.y()), RoundToMillimetres(v.z())};
}

ordered_json MakeCandidate(const people::Decision& decision) {
  ordered_json json = {{"rule", people::NameRule(decision.rule)},
                       {"outcome", people::NameOutcome(people::FindOutcome(decision.rule))},
                       {"why", people::DescribeRule(decision.rule)},
                       {"place_m", MakeVector(decision.place_m)},
                       {"size_m", MakeVector(decision.size_m)},
                       {"area_m2", RoundToMillimetres(decision.area_m2)}};
  if (decision.classified) {
    json["score"] = RoundToMillimetres(decision.score);
    // A threshold above 1 cannot be reached: the rule requires more observations.
    json["needed_score"] =
        decision.needed_score > 1 ? ordered_json() : ordered_json(decision.needed_score);
  }
  if (decision.observations > 0) {
    json["mean_score"] = RoundToMillimetres(decision.mean_score);
    json["observations"] = decision.observations;
  }
  if (decision.track > 0) json["track"] = decision.track;
  return json;
}

ordered_json MakeTrack(const people::TrackSummary& track) {
  const bool confirmed = track.status == people::TrackStatus::kConfirmed;
  return {{"id", track.id},
          {"status", confirmed ? "confirmed" : "lost"},
          {"detections", track.age},
          {"last_seen_s", track.last_seen_s}};
}

}  // namespace

DecisionTrace::DecisionTrace(const std::string& path) {
  if (path.empty()) return;
  AtomicFile::CheckWritable(path);
  file_.emplace(path);
}

void DecisionTrace::Write(const tracker::BodyFrame& bodies) {
  if (!file_) return;
  ordered_json line = {{"frame", bodies.index},
                       {"time_s", bodies.time_s},
                       {"fresh_scene", bodies.decisions.fresh_scene},
                       {"candidates", ordered_json::array()},
                       {"tracks", ordered_json::array()}};
  for (const people::Decision& decision : bodies.decisions.candidates)
    line["candidates"].push_back(MakeCandidate(decision));
  for (const people::TrackSummary& track : bodies.decisions.tracks)
    line["tracks"].push_back(MakeTrack(track));
  try {
    file_->Append(line.dump() + '\n');
  } catch (const DiskFull& full) {
    full_ = full;
    throw;
  }
  ++frames_;
}

void DecisionTrace::Finish() {
  if (!file_) return;
  if (!full_) return file_->Finish();
  file_->FinishWithWhatFits();
  throw MakeKeptError(*full_, frames_, frames_ + 1);
}

}  // namespace ossa::commands
