#include "tools/experiments/papers/database_coverage.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "recon/database/nearest.h"
#include "recon/normalise.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

constexpr size_t kEveryNthFrame = 5;  // neighbouring frames have similar postures

std::string ParseExercise(const std::string& clip) {
  const size_t begin = clip.find('/') + 1;
  return clip.substr(begin, clip.find('_', begin) - begin);
}

/// Mean distance of the observed joints from the nearest posture; empty if there are too few.
std::optional<double> NearestDistance_cm(const recon::PostureDatabase& database,
                                         const recon::BodyRecord& body, double& yaw_rad) {
  constexpr double kFewest = 10.0;  // joints of 20, half of them; by hand
  recon::Posture seen = recon::ToTrackedPosture(body).posture;
  recon::JointWeights there{};
  double count = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (body.joints[j] && seen.position_m[j].allFinite()) {
      there[j] = 1.0;
      count += 1.0;
      continue;
    }
    // An absent joint is left out; its children are attached to its parent.
    if (j > 0) seen.position_m[j] = seen.position_m[recon::ParentOf(j)];
  }
  if (count < kFewest || there[0] == 0.0) return std::nullopt;
  const recon::Placement place = recon::EstimatePlacement(seen, there, yaw_rad);
  yaw_rad = place.yaw_rad;
  const recon::PostureVector query = recon::ToVector(
      recon::Retargeted(recon::Normalised(seen, place), recon::StandardBoneLengths()));
  const int nearest = recon::NearestPostures(database, query, there, 1).at(0).index;
  double sum_cm = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const auto off = query.segment<3>(recon::FirstCoordinate(j)) -
                     database.postures().col(nearest).segment<3>(recon::FirstCoordinate(j));
    sum_cm += 100.0 * there[j] * static_cast<double>(off.norm());
  }
  return sum_cm / count;
}

}  // namespace

Table CoverageTable(const recon::PostureDatabase& database,
                    const std::vector<RecordedPair>& clips) {
  struct Sum {
    double total_cm = 0.0;
    int postures = 0;
  };
  std::map<std::string, Sum> by_exercise;
  for (const RecordedPair& clip : clips) {
    double yaw_rad = std::numbers::pi;  // facing the sensor until seen otherwise
    for (size_t f = 0; f < clip.observed.frames.size(); f += kEveryNthFrame) {
      const auto& bodies = clip.observed.frames[f].bodies;
      if (bodies.empty()) continue;
      const auto distance_cm = NearestDistance_cm(database, bodies[0], yaw_rad);
      if (!distance_cm) continue;
      for (Sum* sum : {&by_exercise[ParseExercise(clip.clip)], &by_exercise["all"]}) {
        sum->total_cm += *distance_cm;
        ++sum->postures;
      }
    }
  }
  Table table;
  table.title = fmt::format("Coverage: from recorded postures to the nearest of {} in the database",
                            database.size());
  table.columns = {"exercise", "postures", "mean joint distance, cm"};
  for (const auto& [exercise, sum] : by_exercise) {
    table.rows.push_back({exercise, std::to_string(sum.postures),
                          fmt::format("{:.2f}", sum.total_cm / sum.postures)});
  }
  table.note =
      "Recorded: UI-PRMD's Kinect skeletons, every 13th clip and 5th frame; m01 deep squat, m02 "
      "hurdle step, m03 inline lunge, m04 side lunge, m05 sit to stand, m06 leg raise, m07 "
      "abduction, m08 extension, m09 rotation, m10 scaption of the shoulder. Where a sensor puts "
      "spine, hips and shoulders counts, too.";
  return table;
}

}  // namespace ossa::tools
