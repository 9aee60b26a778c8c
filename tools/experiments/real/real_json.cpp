// The figures of `ossa experiment real` as they are written to real.json.
#include <nlohmann/json.hpp>

#include "tools/experiments/real/real_tables_internal.h"

namespace ossa::tools {

using nlohmann::json;

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

json HeldToJson(const std::string& set, const HeldScore& score) {
  const auto counts_to_json = [&](const BodyCounts& counts) -> json {
    const auto images = static_cast<double>(score.images);
    return {{"one_body", static_cast<double>(counts.one) / images},
            {"nobody", static_cast<double>(counts.nobody) / images},
            {"bodies", counts.bodies}};
  };
  return {{"name", set},
          {"images", score.images},
          {"first_frame", counts_to_json(score.first)},
          {"last_frame", counts_to_json(score.last)}};
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

json StatesToJson(const RealSet& set, const StateScore& s) {
  return {{"name", set.name},
          {"tracked", s.tracked},
          {"tracked_within_10cm", s.tracked_within_10cm},
          {"offset_removed", s.offset_removed},
          {"others", s.others},
          {"others_within_10cm", s.others_within_10cm}};
}

}  // namespace ossa::tools
